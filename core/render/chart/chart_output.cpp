#include <cmath>
#include <regex>

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include "base/error.h"
#include "render/chart/chart_frame.h"
#include "render/chart/chart_private.h"

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
void drawOn(cairo_surface_t* surface, const ChartGrid& grid, const ChartSize& size,
            std::vector<TextRecord>* texts = nullptr) {
  cairo_t* context = cairo_create(surface);
  Drawing drawing(context, texts);
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
  static const std::regex id("(id=\"|\"#|url\\(#)([A-Za-z]+-?[0-9]+(-[0-9]+)?)");
  return std::regex_replace(std::regex_replace(svg, group, "id=\"page0\""), id,
                            "$1" + prefix + "-$2");
}
const char* anchorOf(Align align) {
  if (align == Align::Centre) return "middle";
  return align == Align::Right ? "end" : "start";
}

/// Verdana stands in for DejaVu Sans where that is missing: it is as wide.
std::string textElement(const TextRecord& record, const std::string& extra) {
  const TextStyle& style = record.style;
  std::string place = fmt::format("x=\"{:.2f}\" y=\"{:.2f}\"", record.at.x, record.at.y);
  if (style.turn != 0.0) {
    place += fmt::format(" transform=\"rotate({:.2f} {:.2f} {:.2f})\"", style.turn * 180.0 / M_PI,
                         record.at.x, record.at.y);
  }
  return fmt::format(
      "<text {} font-family=\"DejaVu Sans, Verdana, Geneva, sans-serif\" font-size=\"{:g}\"{} "
      "text-anchor=\"{}\" {}>{}</text>\n",
      place, style.size, style.bold ? " font-weight=\"bold\"" : "", anchorOf(style.align), extra,
      escapeXml(record.text));
}

std::string textElements(const std::vector<TextRecord>& records) {
  std::string elements;
  for (const TextRecord& record : records) {
    if (record.text.empty()) continue;
    if (record.style.halo) {
      elements +=
          textElement(record, fmt::format("fill=\"none\" stroke=\"{}\" stroke-opacity=\"0.85\" "
                                          "stroke-width=\"3.5\" stroke-linejoin=\"round\" "
                                          "aria-hidden=\"true\"",
                                          hexOf(record.halo)));
    }
    elements += textElement(record, fmt::format("fill=\"{}\"", hexOf(record.style.colour)));
  }
  return elements;
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
  std::vector<TextRecord> texts;
  drawOn(surface, grid, size, &texts);
  svg = withOwnIds(svg, idPrefix);
  svg.insert(svg.rfind("</svg>"), textElements(texts));
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

std::vector<ChartText> textsOf(const ChartGrid& grid, const ChartSize& size) {
  check(grid);
  Canvas canvas(1, 1);
  std::vector<TextRecord> records;
  Drawing drawing(canvas.context(), &records);
  drawGrid(drawing, grid, size);
  std::vector<ChartText> out;
  for (const TextRecord& record : records) {
    if (record.text.empty()) continue;
    const Box box = boxOf(drawing, record.text, record.at, record.style);
    out.push_back({record.text, box.left, box.top, box.right, box.bottom});
  }
  return out;
}

Image drawImage(const ChartGrid& grid, const ChartSize& size, double scale) {
  check(grid);
  Canvas canvas(static_cast<int>(size.width), static_cast<int>(size.height), scale);
  Drawing drawing(canvas.context());
  drawGrid(drawing, grid, size);
  return canvas.image();
}

}  // namespace marey::render
