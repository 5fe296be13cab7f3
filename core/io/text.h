// Text files of numbers: lines with their numbers, tokens, and a fast number parser that does
// not depend on the locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace marey::io {

/// Walks the lines of a text in memory; LF, CRLF and a missing last line end are accepted.
class LineReader {
 public:
  /// `before`: lines of the file that come before the text.
  LineReader(std::string_view text, std::string origin, int64_t before = 0)
      : m_rest(text), m_origin(std::move(origin)), m_line(before) {}

  /// The next line without its end, or nothing after the last.
  std::optional<std::string_view> next();
  /// The next line that holds more than blanks.
  std::optional<std::string_view> nextFilled();
  /// Hands the last line out again (once).
  void unread();
  /// Of the line handed out last, 1-based.
  int64_t line() const { return m_line; }
  size_t bytesLeft() const { return m_rest.size(); }
  std::string_view rest() const { return m_rest; }
  const std::string& origin() const { return m_origin; }
  Place place(std::string item = {}) const {
    return {.path = m_origin, .line = m_line, .item = std::move(item)};
  }

 private:
  std::string_view m_rest;
  std::string_view m_before;  ///< the rest before the last line was taken
  std::string m_origin;
  int64_t m_line = 0;
};

/// Walks the words of a text in memory, whatever lines they stand on, and knows the line of each.
/// Braces are words of their own; a word that begins with # or // starts a comment up to the end of
/// its line.
class WordReader {
 public:
  WordReader(std::string_view text, std::string origin, int64_t before = 0)
      : m_rest(text), m_origin(std::move(origin)), m_line(before + 1) {}

  /// The next word, or an empty one at the end.
  std::string_view next();
  std::string_view peek();
  /// A name of any bytes in front of an opening brace, which stays: what is left of the line, or of
  /// the next one that holds something, up to a brace that stands alone. Without such a brace the
  /// name is the whole line where the next one begins with a brace (bytes of old encodings may look
  /// like one), else it ends at the last of the first braces.
  std::string_view nameBeforeBrace();
  /// Of the word handed out last, 1-based.
  int64_t line() const { return m_line; }
  /// What comes after that word.
  std::string_view rest() const { return m_rest; }
  const std::string& origin() const { return m_origin; }
  int comments() const { return m_comments; }
  Place place(std::string item = {}) const {
    return {.path = m_origin, .line = m_line, .item = std::move(item)};
  }

 private:
  void skipBlanks();
  void drop(size_t bytes);

  std::string_view m_rest;
  std::string m_origin;
  int64_t m_line = 1;
  int m_comments = 0;
};

bool isBlank(char c);
/// Whether a line or word is a remark and nothing to read.
bool isComment(std::string_view text);
/// Removes the first word (separated by blanks) of `rest` and returns it; empty at the end.
std::string_view takeWord(std::string_view& rest);
std::vector<std::string_view> words(std::string_view line);
std::string_view trim(std::string_view text);
bool sameIgnoringCase(std::string_view a, std::string_view b);

enum class NumberResult { Number, End, Bad };
/// Removes the first number of `rest`; separators are blanks, or commas where `commas` says so.
/// Bad: what stands there is no finite number; `rest` then begins with it.
NumberResult takeNumber(std::string_view& rest, double& value, bool commas = false);
/// The whole of `text` as a number, or nothing (also for NaN and infinity).
std::optional<double> parseNumber(std::string_view text);
/// The first characters of a text for an error message, in quotes.
std::string excerpt(std::string_view text);

}  // namespace marey::io
