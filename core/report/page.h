// The HTML page of a report.
#pragma once

#include <string>
#include <vector>

#include "render/base/recipe.h"
#include "report/figures.h"
#include "report/report_data.h"

namespace marey::report {

/// A figure as it stands in the page.
struct PageFigure {
  const Figure* figure = nullptr;
  std::string markup;  ///< an <svg> or <img> element
};

/// One self-contained file: style inside, no script, nothing loaded from elsewhere.
std::string pageHtml(const ReportData& data, const std::vector<PageFigure>& figures);

/// An <img> element with the PNG inside.
std::string imageMarkup(const std::string& png, const std::string& description);
/// An SVG file that holds a picture as PNG, for programs that place only SVG.
std::string sceneSvg(const std::string& png, int width, int height, const std::string& description,
                     const render::Recipe& recipe);
/// A drawn SVG file as an <svg> element of a page.
std::string svgMarkup(const std::string& svg, const std::string& description);

}  // namespace marey::report
