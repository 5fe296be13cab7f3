#include "report/tables.h"

#include <algorithm>

#include "base/csv.h"

namespace marey::report {

using render::escapeXml;

namespace {
std::string heading(const Column& column) {
  return column.unit.empty() ? column.name : column.name + " [" + column.unit + "]";
}

bool isMissing(const Cell& cell) {
  return !cell.number && (cell.text.empty() || cell.text == "\u2013");
}

std::string csvCell(const Cell& cell) {
  if (cell.number) return fmt::format("{}", *cell.number);
  return isMissing(cell) ? "" : csvField(cell.text);
}

Json jsonCell(const Cell& cell) {
  if (cell.number) return *cell.number;
  return isMissing(cell) ? Json(nullptr) : Json(cell.text);
}

Json columnsJson(const Table& table) {
  Json columns = Json::array();
  for (const Column& c : table.columns) {
    columns.push_back({{"name", c.name}, {"unit", c.unit}, {"note", c.note}});
  }
  return columns;
}

bool isNumeric(const Table& table, size_t column) {
  const auto numeric = [&](const std::vector<Cell>& row) { return row[column].number.has_value(); };
  const auto other = [&](const std::vector<Cell>& row) {
    return !row[column].number && !isMissing(row[column]);
  };
  return std::any_of(table.rows.begin(), table.rows.end(), numeric) &&
         std::none_of(table.rows.begin(), table.rows.end(), other);
}

std::string cellHtml(const char* tag, bool numeric, const std::string& content) {
  return fmt::format("<{0}{1}>{2}</{0}>", tag, numeric ? " class=\"number\"" : "", content);
}
}  // namespace

std::string tableCsv(const Table& table) {
  std::string csv;
  for (size_t c = 0; c < table.columns.size(); ++c)
    csv += (c == 0 ? "" : ",") + csvField(heading(table.columns[c]));
  csv += "\r\n";
  for (const auto& row : table.rows) {
    for (size_t c = 0; c < row.size(); ++c) csv += (c == 0 ? "" : ",") + csvCell(row[c]);
    csv += "\r\n";
  }
  return csv;
}

Json tableJson(const Table& table, const render::Recipe& recipe) {
  Json rows = Json::array();
  for (const auto& row : table.rows) {
    Json cells = Json::array();
    for (const Cell& cell : row) cells.push_back(jsonCell(cell));
    rows.push_back(std::move(cells));
  }
  return {{"title", table.title},
          {"caption", table.caption},
          {"columns", columnsJson(table)},
          {"rows", std::move(rows)},
          {"recipe", render::toJson(recipe)}};
}

Json tableSidecar(const Table& table, const render::Recipe& recipe) {
  return {
      {"title", table.title}, {"columns", columnsJson(table)}, {"recipe", render::toJson(recipe)}};
}

std::string tableHtml(const Table& table) {
  std::string html = "<table>\n<thead><tr>";
  for (size_t c = 0; c < table.columns.size(); ++c) {
    const Column& column = table.columns[c];
    std::string content = escapeXml(column.name);
    if (!column.unit.empty())
      content += " <span class=\"unit\">" + escapeXml(column.unit) + "</span>";
    html += cellHtml("th", isNumeric(table, c), content);
  }
  html += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (size_t c = 0; c < row.size(); ++c)
      html += cellHtml("td", isNumeric(table, c), escapeXml(row[c].text));
    html += "</tr>\n";
  }
  return html + "</tbody>\n</table>";
}

}  // namespace marey::report
