// Charts as files, each with its recipe.
#pragma once

#include <filesystem>
#include <string>

#include "render/chart/chart.h"

namespace marey::gui {

/// The data of every series, one line per point: chart,series,line,x,y,low,high. `line` counts the
/// lines of a cloud; columns that a kind does not have stay empty.
std::string chartCsv(const render::ChartGrid& grid);

/// Writes .svg, .pdf, .png (at twice the size) or .csv by the name's ending; the recipe is inside,
/// beside a CSV as NAME.csv.recipe.json. Throws UsageError for other endings, FileError.
void saveChart(const render::ChartGrid& grid, const render::ChartSize& size,
               const render::Recipe& recipe, const std::filesystem::path& file);

}  // namespace marey::gui
