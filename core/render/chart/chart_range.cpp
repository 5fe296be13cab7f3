#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "render/chart/chart_private.h"

namespace marey::render {

namespace {
void include(Range& range, double value) {
  if (!std::isfinite(value)) return;
  range.low = std::min(range.low, value);
  range.high = std::max(range.high, value);
}

void include(Range& range, const std::vector<double>& values) {
  for (const double v : values) include(range, v);
}

bool startsAtZero(SeriesKind kind) {
  return kind == SeriesKind::Bars || kind == SeriesKind::Density;
}

/// Does low..high of this series run along that axis?
bool extentAlong(const Series& series, char axis) {
  if (series.kind == SeriesKind::Intervals) return axis == 'x';
  if (series.kind == SeriesKind::Band) return axis == 'y';
  return series.kind == SeriesKind::Dots && series.errorAxis == axis;
}

void includeSeries(Range& range, const Series& series, char axis) {
  if (series.kind == SeriesKind::HorizontalRule && axis == 'x') return;
  if (series.kind == SeriesKind::VerticalRule && axis == 'y') return;
  if (axis == 'y' && startsAtZero(series.kind)) include(range, 0.0);
  const bool bars = axis == 'x' && series.kind == SeriesKind::Bars;
  for (const double v : axis == 'x' ? series.x : series.y) {
    include(range, bars ? v - series.width / 2 : v);
    include(range, bars ? v + series.width / 2 : v);
  }
  if (axis == 'y' && series.cloud) {
    include(range, series.cloud->low);
    include(range, series.cloud->high);
  }
  if (extentAlong(series, axis)) {
    include(range, series.low);
    include(range, series.high);
  }
}

Range padded(Range range, char axis, bool keepZero) {
  if (range.low > range.high) return {0.0, 1.0};
  if (range.high - range.low < 1e-12 * std::max(1.0, std::abs(range.high))) {
    return {range.low - 0.5, range.high + 0.5};
  }
  const double pad = (axis == 'y' ? 0.06 : 0.0) * (range.high - range.low);
  return {keepZero && range.low == 0.0 ? 0.0 : range.low - pad, range.high + pad};
}
}  // namespace

void checkChart(const Chart& chart) {
  for (const Series& s : chart.series) {
    const Place place{.path = "chart '" + chart.title + "'", .item = "series '" + s.name + "'"};
    const bool rule = s.kind == SeriesKind::HorizontalRule || s.kind == SeriesKind::VerticalRule;
    const size_t extent = s.low.size();
    if (s.kind == SeriesKind::Cloud) {
      const size_t values = s.cloud ? s.cloud->y.size() : 0;
      if (s.x.empty() ? values != 0 : values % s.x.size() != 0)
        throwInput(place, "rows of as many values as x", "{} values, {} places", values,
                   s.x.size());
      continue;
    }
    const bool needsExtent = s.kind == SeriesKind::Band || s.kind == SeriesKind::Intervals;
    const size_t points = s.kind == SeriesKind::Intervals ? s.y.size() : s.x.size();
    if (rule && s.x.size() + s.y.size() != 1)
      throwInput(place, "one value", "{}", s.x.size() + s.y.size());
    if (extent != s.high.size() || (needsExtent && extent != points) ||
        (extent != 0 && extent != points)) {
      throwInput(place, "low and high for every point", "{} low, {} high, {} points", extent,
                 s.high.size(), points);
    }
    if (!rule && !needsExtent && s.x.size() != s.y.size()) {
      throwInput(place, "as many x as y values", "{} and {}", s.x.size(), s.y.size());
    }
  }
}

Range rangeOf(const Chart& chart, char axis) {
  const Axis& a = axis == 'x' ? chart.x : chart.y;
  if (a.range) return {a.range->first, a.range->second};
  if (!a.categories.empty()) return {0.0, static_cast<double>(a.categories.size())};
  Range range{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
  bool keepZero = false;
  for (const Series& s : chart.series) {
    includeSeries(range, s, axis);
    keepZero = keepZero || (axis == 'y' && startsAtZero(s.kind));
  }
  // Quantities that come near zero are shown from zero; those never negative without a strip below.
  if (range.low > 0.0 && range.low < 0.35 * range.high) range.low = 0.0;
  return padded(range, axis, keepZero || range.low == 0.0);
}

Range joinedRange(const std::vector<Chart>& charts, char axis) {
  Range joined = rangeOf(charts.front(), axis);
  for (const Chart& chart : charts) {
    const Range range = rangeOf(chart, axis);
    joined = {std::min(joined.low, range.low), std::max(joined.high, range.high)};
  }
  return joined;
}

Point Mapping::operator()(double dataX, double dataY) const {
  const double u = (dataX - x.low) / (x.high - x.low);
  const double v = (dataY - y.low) / (y.high - y.low);
  return {plot.left + u * plot.width(),
          rowsFromTop ? plot.top + v * plot.height() : plot.bottom - v * plot.height()};
}

}  // namespace marey::render
