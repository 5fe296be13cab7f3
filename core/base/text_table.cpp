#include "base/text_table.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "base/file_kind.h"

namespace marey {
namespace {

/// Rows with line ends of any system, without a byte-order mark.
std::vector<std::string> linesOf(std::string text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  std::vector<std::string> out(1);
  for (size_t i = 0; i < text.size(); ++i) {
    const bool end = text[i] == '\n' || text[i] == '\r';
    if (text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n') ++i;
    if (end)
      out.emplace_back();
    else
      out.back() += text[i];
  }
  return out;
}

std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t\"");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\"") - first + 1);
}

bool isRemark(const std::string& line) {
  const std::string text = trimmed(line);
  return text.empty() || text.starts_with('#');
}

char separatorOf(const std::string& line) {
  for (const char separator : {',', ';', '\t'})
    if (line.find(separator) != std::string::npos) return separator;
  return ',';
}

std::vector<std::string> fieldsOf(const std::string& line, char separator) {
  std::vector<std::string> out;
  for (size_t begin = 0; begin <= line.size();) {
    const size_t end = std::min(line.find(separator, begin), line.size());
    out.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return out;
}

/// "Time_s" -> "time".
std::string columnName(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const char* unit : {"_s", "_m", " (s)", " (m)", "[s]", "[m]"})
    if (name.ends_with(unit)) name.resize(name.size() - std::string_view(unit).size());
  name = trimmed(name);
  return name == "t" || name == "seconds" ? "time" : name;
}

std::optional<double> numberOf(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

bool allNumbers(const std::vector<std::string>& fields) {
  return std::all_of(fields.begin(), fields.end(),
                     [](const std::string& f) { return numberOf(f).has_value(); });
}

}  // namespace

TextTable::TextTable(const std::string& text, std::string origin, const std::string& expected)
    : m_origin(std::move(origin)) {
  const auto lines = linesOf(text);
  char separator = ',';
  for (size_t at = 0; at < lines.size(); ++at) {
    if (isRemark(lines[at])) continue;
    const auto line = static_cast<int64_t>(at) + 1;
    const bool first = m_width == 0;
    if (first) separator = separatorOf(lines[at]);
    auto fields = fieldsOf(lines[at], separator);
    if (first) {
      m_width = fields.size();
      m_firstLine = line;
      if (!allNumbers(fields)) {
        for (const std::string& field : fields) m_columns.push_back(columnName(field));
        m_titles = std::move(fields);
        continue;
      }
    }
    if (fields.size() != m_width)
      throwInput({.path = m_origin, .line = line}, fmt::format("{} columns", m_width), "{}",
                 fields.size());
    m_rows.push_back({line, std::move(fields)});
  }
  if (m_width == 0) throw InputError({.path = m_origin}, expected, "an empty file");
}

std::optional<size_t> TextTable::find(const std::string& column) const {
  const auto found = std::find(m_columns.begin(), m_columns.end(), column);
  if (found == m_columns.end()) return std::nullopt;
  return static_cast<size_t>(found - m_columns.begin());
}

Place TextTable::place(const Row& row, const std::string& item) const {
  return {.path = m_origin, .line = row.line, .item = item};
}

std::optional<double> TextTable::number(const Row& row, size_t column) const {
  const std::string& text = row.fields[column];
  if (text.empty()) return std::nullopt;
  if (const auto value = numberOf(text)) return value;
  const std::string name =
      m_columns.empty() ? std::to_string(column + 1) : "'" + m_columns[column] + "'";
  throw InputError(place(row, "column " + name), "a finite number", quotedStart(text));
}

}  // namespace marey
