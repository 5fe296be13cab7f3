#include <regex>

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include "base/error.h"
#include "render/chart_private.h"

namespace marey::render {

namespace {
cairo_status_t append(void* closure, const unsigned char* data, unsigned int size) {
  static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(data), size);
  return CAIRO_STATUS_SUCCESS;
}

void check(const ChartGrid& grid) {
  for (const Chart& chart : grid.charts) checkChart(chart);
}

/// Draws on a stream surface and closes it; the surface is destroyed.
void drawOn(cairo_surface_t* surface, const ChartGrid& grid, const ChartSize& size) {
  cairo_t* context = cairo_create(surface);
  Drawing drawing(context);
  drawGrid(drawing, grid, size);
  cairo_destroy(context);
  cairo_surface_finish(surface);
  const cairo_status_t status = cairo_surface_status(surface);
  cairo_surface_destroy(surface);
  if (status != CAIRO_STATUS_SUCCESS) {
    throw NumericError(std::string("a figure could not be drawn: ") +
                       cairo_status_to_string(status));
  }
}

/// cairo numbers its groups through the life of a process; ids here depend on the figure alone.
std::string withOwnIds(const std::string& svg, const std::string& prefix) {
  static const std::regex group("id=\"surface[0-9]+\"");
  static const std::regex id("(id=\"|\"#|url\\(#)([A-Za-z]+[0-9]+(-[0-9]+)?)");
  return std::regex_replace(std::regex_replace(svg, group, "id=\"page0\""), id,
                            "$1" + prefix + "-$2");
}
}  // namespace

ChartGrid single(Chart chart) {
  ChartGrid grid;
  grid.charts.push_back(std::move(chart));
  return grid;
}

std::string drawSvg(const ChartGrid& grid, const ChartSize& size, const Recipe& recipe,
                    const std::string& idPrefix) {
  check(grid);
  std::string svg;
  cairo_surface_t* surface =
      cairo_svg_surface_create_for_stream(append, &svg, size.width, size.height);
  cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_PX);
  drawOn(surface, grid, size);
  svg = withOwnIds(svg, idPrefix);
  const size_t afterTag = svg.find('>', svg.find("<svg")) + 1;
  if (!recipe.empty()) {
    svg.insert(afterTag, "\n<metadata>" + escapeXml(recipeText(recipe)) + "</metadata>");
  }
  return svg;
}

std::string drawPdf(const ChartGrid& grid, const ChartSize& size, const Recipe& recipe) {
  check(grid);
  constexpr double pointsPerPixel = 0.75;
  std::string pdf;
  cairo_surface_t* surface = cairo_pdf_surface_create_for_stream(
      append, &pdf, size.width * pointsPerPixel, size.height * pointsPerPixel);
  // A fixed date keeps the bytes equal from run to run.
  cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
  if (!recipe.empty()) {
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_SUBJECT, recipeText(recipe).c_str());
  }
  cairo_surface_set_device_scale(surface, pointsPerPixel, pointsPerPixel);
  drawOn(surface, grid, size);
  return pdf;
}

Image drawImage(const ChartGrid& grid, const ChartSize& size, double scale) {
  check(grid);
  Canvas canvas(static_cast<int>(size.width), static_cast<int>(size.height), scale);
  Drawing drawing(canvas.context());
  drawGrid(drawing, grid, size);
  return canvas.image();
}

}  // namespace marey::render
