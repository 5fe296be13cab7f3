#include "gui/plots/chart_files.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/json.h"

namespace marey::gui {
namespace {

std::string cell(const std::vector<double>& values, size_t index) {
  if (index >= values.size() || !std::isfinite(values[index])) return "";
  return fmt::format("{:.9g}", values[index]);
}

void addSeries(std::string& out, const std::string& chart, const render::Series& s) {
  auto add = std::back_inserter(out);
  const std::string start = csvField(chart) + "," + csvField(s.name) + ",";
  if (s.cloud) {
    for (size_t i = 0; i < s.cloud->y.size(); ++i) {
      const float y = s.cloud->y[i];
      if (std::isfinite(y))
        fmt::format_to(add, "{}{},{},{:.7g},,\n", start, i / s.x.size() + 1,
                       cell(s.x, i % s.x.size()), y);
    }
    return;
  }
  const size_t points = std::max(s.x.size(), s.y.size());
  for (size_t i = 0; i < points; ++i)
    fmt::format_to(add, "{},{},{},{},{}\n", start, cell(s.x, i), cell(s.y, i), cell(s.low, i),
                   cell(s.high, i));
}

std::string endingOf(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

}  // namespace

std::string chartCsv(const render::ChartGrid& grid) {
  std::string out = "chart,series,line,x,y,low,high\n";
  for (const render::Chart& chart : grid.charts)
    for (const render::Series& s : chart.series) addSeries(out, chart.title, s);
  return out;
}

void saveChart(const render::ChartGrid& grid, const render::ChartSize& size,
               const render::Recipe& recipe, const std::filesystem::path& file) {
  const std::string ending = endingOf(file);
  if (ending == ".svg") return writeFileAtomically(file, render::drawSvg(grid, size, recipe));
  if (ending == ".pdf") return writeFileAtomically(file, render::drawPdf(grid, size, recipe));
  if (ending == ".png") return render::writePng(file, render::drawImage(grid, size, 2.0), recipe);
  if (ending != ".csv")
    throw UsageError(file.string() + ": expected a name that ends in .svg, .pdf, .png or .csv");
  writeFileAtomically(file, chartCsv(grid));
  writeFileAtomically(file.string() + ".recipe.json", render::toJson(recipe).dump(2) + "\n");
}

}  // namespace marey::gui
