// Many lines over each other: a thousand stroked paths take seconds, one picture of how many lines
// cross each pixel takes milliseconds.
#include <algorithm>
#include <cmath>
#include <limits>

#include "render/chart/chart_private.h"

namespace marey::render {

namespace {
/// Pixels per unit of the page where the surface is no image itself.
constexpr double vectorScale = 2.0;

double pixelScale(cairo_t* context) {
  if (cairo_surface_get_type(cairo_get_target(context)) != CAIRO_SURFACE_TYPE_IMAGE)
    return vectorScale;
  double x = 1.0, y = 0.0;
  cairo_user_to_device_distance(context, &x, &y);
  return std::hypot(x, y);
}

/// The left edge of a pixel column in the data: between places `before` and `before` + 1; places
/// [inner, next column's inner) lie inside the column.
struct ColumnEdge {
  size_t before = 0, inner = 0;
  double share = 0.0;
  bool inside = false;  ///< false left and right of all places
};

/// Coverage of pixels by spans, column by column. Spans are added as differences along the column:
/// the cost of one does not depend on its height.
class SpanCount {
 public:
  SpanCount(int width, int height)
      : m_height(height), m_differences(static_cast<size_t>(width) * (height + 2), 0.0F) {}

  void add(int column, double top, double bottom) {
    float* at = m_differences.data() + static_cast<size_t>(column) * (m_height + 2);
    edge(at, top, 1.0F);
    edge(at, bottom, -1.0F);
  }
  /// Lines over each pixel of a column from the top.
  std::vector<float> column(int index) const {
    const float* at = m_differences.data() + static_cast<size_t>(index) * (m_height + 2);
    std::vector<float> count(static_cast<size_t>(m_height));
    float sum = 0.0F;
    for (size_t y = 0; y < count.size(); ++y) count[y] = std::max(0.0F, sum += at[y]);
    return count;
  }

 private:
  void edge(float* at, double y, float sign) const {
    const double inside = std::clamp(y, 0.0, static_cast<double>(m_height));
    const int pixel = static_cast<int>(inside);
    const auto rest = static_cast<float>(inside - pixel);
    at[pixel] += sign * (1.0F - rest);
    at[pixel + 1] += sign * rest;
  }

  int m_height;
  std::vector<float> m_differences;
};

std::vector<ColumnEdge> columnEdges(const std::vector<double>& pixelX, int width) {
  std::vector<ColumnEdge> edges(static_cast<size_t>(width) + 1);
  size_t next = 0;  // first place at or right of the edge
  for (size_t c = 0; c < edges.size(); ++c) {
    while (next < pixelX.size() && pixelX[next] < static_cast<double>(c)) ++next;
    edges[c].inner = next;
    if (next == 0 || next == pixelX.size()) continue;
    edges[c].before = next - 1;
    edges[c].share =
        (static_cast<double>(c) - pixelX[next - 1]) / (pixelX[next] - pixelX[next - 1]);
    edges[c].inside = true;
  }
  return edges;
}

/// The picture's pixels on the page: whole device pixels around the plot.
struct Raster {
  double left = 0.0, top = 0.0, scale = 1.0;
  int width = 0, height = 0;
};

Raster rasterOf(const Box& plot, double scale) {
  Raster r{.left = std::floor(plot.left * scale) / scale,
           .top = std::floor(plot.top * scale) / scale,
           .scale = scale};
  r.width = static_cast<int>(std::ceil((plot.right - r.left) * scale));
  r.height = static_cast<int>(std::ceil((plot.bottom - r.top) * scale));
  return r;
}

void addRow(SpanCount& count, const float* y, const std::vector<ColumnEdge>& edges,
            double lineWidth) {
  const auto at = [&](const ColumnEdge& e) {
    return (1.0 - e.share) * static_cast<double>(y[e.before]) +
           e.share * static_cast<double>(y[e.before + 1]);
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (size_t c = 0; c + 1 < edges.size(); ++c) {
    double low = infinity, high = -infinity;
    // NaN fails both comparisons, so a broken line leaves a gap.
    const auto include = [&](double v) {
      if (v < low) low = v;
      if (v > high) high = v;
    };
    if (edges[c].inside) include(at(edges[c]));
    if (edges[c + 1].inside) include(at(edges[c + 1]));
    for (size_t i = edges[c].inner; i < edges[c + 1].inner; ++i) include(static_cast<double>(y[i]));
    if (low <= high) count.add(static_cast<int>(c), low - lineWidth / 2.0, high + lineWidth / 2.0);
  }
}

SpanCount counted(const Series& s, const Mapping& map, const Raster& raster) {
  const auto toPixelX = [&](double x) {
    return (map(x, map.y.low).x - raster.left) * raster.scale;
  };
  std::vector<double> pixelX;
  for (const double x : s.x) pixelX.push_back(toPixelX(x));
  const std::vector<ColumnEdge> edges = columnEdges(pixelX, raster.width);
  // y is an affine function of the value: two places give it.
  const double y0 = (map(map.x.low, 0.0).y - raster.top) * raster.scale;
  const double slope = (map(map.x.low, 1.0).y - raster.top) * raster.scale - y0;
  SpanCount count(raster.width, raster.height);
  std::vector<float> row(s.x.size());
  for (size_t first = 0; first < s.cloud->y.size(); first += row.size()) {
    for (size_t i = 0; i < row.size(); ++i)
      row[i] = static_cast<float>(y0 + slope * static_cast<double>(s.cloud->y[first + i]));
    addRow(count, row.data(), edges, std::max(1.0, s.width * raster.scale));
  }
  return count;
}

/// n lines of opacity a laid over each other have opacity 1 - (1 - a)^n.
cairo_surface_t* pictureOf(const SpanCount& count, const Raster& raster, const Colour& colour,
                           double opacity) {
  cairo_surface_t* surface =
      cairo_image_surface_create(CAIRO_FORMAT_ARGB32, raster.width, raster.height);
  cairo_surface_flush(surface);
  uint8_t* data = cairo_image_surface_get_data(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  const double decay = std::log1p(-std::clamp(opacity, 0.0, 0.999));
  for (int x = 0; x < raster.width; ++x) {
    const std::vector<float> lines = count.column(x);
    for (int y = 0; y < raster.height; ++y) {
      const float n = lines[static_cast<size_t>(y)];
      if (n < 1e-3F) continue;
      const double alpha = -std::expm1(decay * static_cast<double>(n));
      const auto byte = [&](double v) {
        return static_cast<uint32_t>(std::lround(255.0 * alpha * v));
      };
      const uint32_t pixel =
          byte(1.0) << 24U | byte(colour.r) << 16U | byte(colour.g) << 8U | byte(colour.b);
      reinterpret_cast<uint32_t*>(data + static_cast<size_t>(y) * stride)[x] = pixel;
    }
  }
  cairo_surface_mark_dirty(surface);
  return surface;
}
}  // namespace

CloudLines::CloudLines(std::vector<float> rows) : y(std::move(rows)) {
  float least = std::numeric_limits<float>::max(), most = std::numeric_limits<float>::lowest();
  for (const float v : y) {
    if (!std::isfinite(v)) continue;
    least = std::min(least, v);
    most = std::max(most, v);
  }
  if (least > most) return;
  low = static_cast<double>(least);
  high = static_cast<double>(most);
}

void drawCloud(Drawing& drawing, const Series& s, const Mapping& map) {
  if (!s.cloud || s.cloud->y.empty() || s.x.empty()) return;
  cairo_t* context = drawing.context();
  const Raster raster = rasterOf(map.plot, pixelScale(context));
  if (raster.width <= 0 || raster.height <= 0) return;
  cairo_surface_t* picture =
      pictureOf(counted(s, map, raster), raster, themed(s.colour, drawing.theme()), s.opacity);
  cairo_save(context);
  cairo_translate(context, raster.left, raster.top);
  cairo_scale(context, 1.0 / raster.scale, 1.0 / raster.scale);
  cairo_set_source_surface(context, picture, 0.0, 0.0);
  cairo_pattern_set_filter(cairo_get_source(context), CAIRO_FILTER_NEAREST);
  cairo_paint(context);
  cairo_restore(context);
  cairo_surface_destroy(picture);
}

}  // namespace marey::render
