#include "io/text.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace marey::io {

bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

std::optional<std::string_view> LineReader::next() {
  if (m_rest.empty()) return std::nullopt;
  m_before = m_rest;
  const size_t end = m_rest.find('\n');
  std::string_view line = m_rest.substr(0, end);
  m_rest = end == std::string_view::npos ? std::string_view() : m_rest.substr(end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  ++m_line;
  return line;
}

std::optional<std::string_view> LineReader::nextFilled() {
  while (const auto line = next())
    if (!std::all_of(line->begin(), line->end(), isBlank)) return line;
  return std::nullopt;
}

void LineReader::unread() {
  m_rest = m_before;
  --m_line;
}

void WordReader::drop(size_t bytes) {
  m_line += std::count(m_rest.begin(), m_rest.begin() + static_cast<long>(bytes), '\n');
  m_rest.remove_prefix(bytes);
}

void WordReader::skipBlanks() {
  size_t at = 0;
  while (at < m_rest.size()) {
    if (isBlank(m_rest[at]) || m_rest[at] == '\n') {
      ++at;
    } else if (isComment(m_rest.substr(at, 2))) {
      ++m_comments;
      at = std::min(m_rest.find('\n', at), m_rest.size());
    } else {
      break;
    }
  }
  drop(at);
}

std::string_view WordReader::next() {
  skipBlanks();
  const auto isBrace = [](char c) { return c == '{' || c == '}'; };
  size_t end = m_rest.empty() ? 0 : 1;
  if (end > 0 && !isBrace(m_rest[0]))
    while (end < m_rest.size() && !isBlank(m_rest[end]) && m_rest[end] != '\n' &&
           !isBrace(m_rest[end]))
      ++end;
  const std::string_view word = m_rest.substr(0, end);
  m_rest.remove_prefix(end);
  return word;
}

std::string_view WordReader::peek() {
  WordReader ahead = *this;
  return ahead.next();
}

std::string_view WordReader::nameBeforeBrace() {
  const auto isGap = [](char c) { return isBlank(c) || c == '\n'; };
  const auto filled =
      static_cast<size_t>(std::find_if_not(m_rest.begin(), m_rest.end(), isGap) - m_rest.begin());
  drop(filled);
  const std::string_view line = m_rest.substr(0, m_rest.find('\n'));
  size_t end = line.starts_with('{') ? 0 : std::string_view::npos;
  for (size_t at = line.find('{'); at != std::string_view::npos && end != 0;
       at = line.find('{', at + 1))
    if (isBlank(line[at - 1])) {
      end = at;
      break;
    }
  if (end == std::string_view::npos) {
    WordReader after = *this;
    after.drop(line.size());
    end = after.peek() == "{" ? line.size() : line.find('{');
    while (end + 1 < line.size() && line[end + 1] == '{') ++end;
  }
  end = std::min(end, line.size());
  const std::string_view name = trim(line.substr(0, end));
  m_rest.remove_prefix(end);
  return name;
}

bool isComment(std::string_view text) {
  return text.starts_with('#') || text.starts_with("//");
}

std::string_view takeWord(std::string_view& rest) {
  size_t begin = 0;
  while (begin < rest.size() && isBlank(rest[begin])) ++begin;
  size_t end = begin;
  while (end < rest.size() && !isBlank(rest[end])) ++end;
  const std::string_view word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return word;
}

std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> out;
  for (std::string_view word = takeWord(line); !word.empty(); word = takeWord(line))
    out.push_back(word);
  return out;
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
  return text;
}

bool sameIgnoringCase(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) ==
           std::tolower(static_cast<unsigned char>(y));
  });
}

NumberResult takeNumber(std::string_view& rest, double& value, bool commas) {
  size_t begin = 0;
  while (begin < rest.size() && (isBlank(rest[begin]) || (commas && rest[begin] == ','))) ++begin;
  rest.remove_prefix(begin);
  if (rest.empty()) return NumberResult::End;
  const char* first = rest.data();
  const char* last = first + rest.size();
  if (*first == '+' && rest.size() > 1 && rest[1] != '-') ++first;
  const auto [stop, error] = std::from_chars(first, last, value);
  const bool separated = stop == last || isBlank(*stop) || (commas && *stop == ',');
  if (error == std::errc::result_out_of_range && separated) {
    // Too small is 0; too large is no finite number.
    const std::string_view text(first, static_cast<size_t>(stop - first));
    const bool tiny = text.find("e-") != text.npos || text.find("E-") != text.npos ||
                      text.find("0.") == 0 || text.find("-0.") == 0;
    if (!tiny) return NumberResult::Bad;
    value = 0.0;
  } else if (error != std::errc() || !separated || !std::isfinite(value)) {
    return NumberResult::Bad;
  }
  rest.remove_prefix(static_cast<size_t>(stop - rest.data()));
  return NumberResult::Number;
}

std::optional<double> parseNumber(std::string_view text) {
  double value = 0.0;
  if (takeNumber(text, value) != NumberResult::Number || !trim(text).empty()) return std::nullopt;
  return value;
}

std::string excerpt(std::string_view text) {
  constexpr size_t kMost = 40;
  std::string out = "'";
  for (const char c : text.substr(0, kMost))
    out += std::isprint(static_cast<unsigned char>(c)) != 0 ? c : '?';
  return out + (text.size() > kMost ? "...'" : "'");
}

}  // namespace marey::io
