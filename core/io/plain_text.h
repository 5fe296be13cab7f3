// Text files as the readers of this folder want them, whatever program and system wrote them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace marey::io {

/// The text of a file's bytes: UTF-16 becomes UTF-8, a byte-order mark goes, CR alone ends a line
/// as LF and CRLF do, NUL bytes are blanks. Other bytes stay as they are (names in old encodings).
/// Lines keep their numbers: one CR, one LF and one CRLF end one line each.
class PlainText {
 public:
  /// Copies only what it has to change: `bytes` must outlive the text.
  explicit PlainText(std::string_view bytes);
  PlainText(const PlainText&) = delete;
  PlainText& operator=(const PlainText&) = delete;

  std::string_view text() const { return m_text; }
  /// One sentence for everything that was not plain.
  const std::vector<std::string>& notes() const { return m_notes; }

 private:
  void decodeUtf16();
  void trimEnd();
  void dropNuls();
  void endLines();

  std::string_view m_text;
  std::string m_own;  ///< what m_text views where something was changed
  std::vector<std::string> m_notes;
};

}  // namespace marey::io
