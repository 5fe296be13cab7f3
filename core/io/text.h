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
  LineReader(std::string_view text, std::string origin)
      : m_rest(text), m_origin(std::move(origin)) {}

  /// The next line without its end, or nothing after the last.
  std::optional<std::string_view> next();
  /// The next line that holds more than blanks.
  std::optional<std::string_view> nextFilled();
  /// Hands the last line out again (once).
  void unread();
  /// Of the line handed out last, 1-based.
  int64_t line() const { return m_line; }
  size_t bytesLeft() const { return m_rest.size(); }
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

bool isBlank(char c);
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
