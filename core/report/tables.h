// Tables of a report as files and as HTML.
#pragma once

#include <string>

#include "base/json.h"
#include "report/report_data.h"

namespace marey::report {

/// RFC 4180: header of names (with unit in brackets), then rows; numbers in full precision with a
/// decimal point, missing values empty.
std::string tableCsv(const Table& table);
/// {"title", "caption", "columns": [{"name", "unit", "note"}], "rows": [[...]], "recipe": {...}};
/// numbers as numbers, missing values null.
Json tableJson(const Table& table, const render::Recipe& recipe);
/// What a CSV cannot hold: columns with units and notes, and the recipe.
Json tableSidecar(const Table& table, const render::Recipe& recipe);
/// A <table> element; columns of numbers are right-aligned.
std::string tableHtml(const Table& table);

}  // namespace marey::report
