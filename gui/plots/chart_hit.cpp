#include "gui/plots/chart_hit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace marey::gui {
namespace {
using render::ChartFrame;
using render::Series;
using render::SeriesKind;

/// Linear between places that rise; NaN outside them.
template <typename Value>
double valueAt(const std::vector<double>& x, const Value& value, double at) {
  const auto right = std::lower_bound(x.begin(), x.end(), at);
  if (right == x.end() || (right == x.begin() && *right != at))
    return std::numeric_limits<double>::quiet_NaN();
  const auto i = static_cast<size_t>(right - x.begin());
  if (i == 0 || *right == at) return value(i);
  const double share = (at - x[i - 1]) / (x[i] - x[i - 1]);
  return (1.0 - share) * value(i - 1) + share * value(i);
}

struct Nearest {
  double distance = std::numeric_limits<double>::max();  ///< pixels
  CurveRef curve;
  double y = 0.0;

  void offer(double d, const CurveRef& c, double value) {
    if (d < distance) *this = {d, c, value};
  }
};

struct Pointer {
  const ChartFrame& frame;
  double pixelX, pixelY, reach;
};

template <typename Value>
void offerLine(Nearest& nearest, const Pointer& p, const std::vector<double>& x, const Value& value,
               const CurveRef& curve) {
  const double here = valueAt(x, value, p.frame.dataX(p.pixelX));
  double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
  double distance = low;
  // A steep line may be near although its height right here is not.
  for (const double shift : {-4.0, -2.0, 0.0, 2.0, 4.0}) {
    const double v = valueAt(x, value, p.frame.dataX(p.pixelX + shift));
    if (!std::isfinite(v)) continue;
    const double y = p.frame.pixelY(v);
    distance = std::min(distance, std::hypot(shift, y - p.pixelY));
    low = std::min(low, y);
    high = std::max(high, y);
  }
  if (low <= p.pixelY && p.pixelY <= high) distance = std::min(distance, 2.0);
  if (distance <= p.reach) nearest.offer(distance, curve, std::isfinite(here) ? here : 0.0);
}

void offerCloud(Nearest& nearest, const Pointer& p, const Series& s, CurveRef curve) {
  if (!s.cloud || s.x.empty()) return;
  const size_t rows = s.cloud->y.size() / s.x.size();
  for (size_t r = 0; r < rows; ++r) {
    curve.row = static_cast<int>(r);
    const float* row = s.cloud->y.data() + r * s.x.size();
    offerLine(
        nearest, p, s.x, [row](size_t i) { return static_cast<double>(row[i]); }, curve);
  }
}

void offerBand(Nearest& nearest, const Pointer& p, const Series& s, const CurveRef& curve) {
  const double at = p.frame.dataX(p.pixelX), y = p.frame.dataY(p.pixelY);
  const double low = valueAt(
      s.x, [&](size_t i) { return s.low[i]; }, at);
  const double high = valueAt(
      s.x, [&](size_t i) { return s.high[i]; }, at);
  // Any line within reach is meant rather than the area behind it.
  if (low <= y && y <= high) nearest.offer(p.reach + 1.0, curve, y);
}

void offerSeries(Nearest& nearest, const Pointer& p, const Series& s, const CurveRef& curve) {
  switch (s.kind) {
    case SeriesKind::Line:
    case SeriesKind::Density:
      offerLine(
          nearest, p, s.x, [&](size_t i) { return s.y[i]; }, curve);
      break;
    case SeriesKind::Cloud:
      offerCloud(nearest, p, s, curve);
      break;
    case SeriesKind::Band:
      offerBand(nearest, p, s, curve);
      break;
    case SeriesKind::Dots:
      for (size_t i = 0; i < s.x.size(); ++i) {
        const double distance =
            std::hypot(p.frame.pixelX(s.x[i]) - p.pixelX, p.frame.pixelY(s.y[i]) - p.pixelY);
        // A dot covers the line that it lies on.
        if (distance <= p.reach) nearest.offer(0.5 * distance, curve, s.y[i]);
      }
      break;
    case SeriesKind::VerticalRule: {
      const double distance = std::abs(p.frame.pixelX(s.x[0]) - p.pixelX);
      // A line that crosses it is meant where both are near.
      if (distance <= 0.5 * p.reach) nearest.offer(p.reach, curve, p.frame.dataY(p.pixelY));
      break;
    }
    default:
      break;
  }
}
}  // namespace

std::optional<ChartHit> hitAt(const render::ChartGrid& grid, const std::vector<ChartFrame>& frames,
                              double pixelX, double pixelY, double reach) {
  for (size_t c = 0; c < frames.size() && c < grid.charts.size(); ++c) {
    const ChartFrame& frame = frames[c];
    if (!frame.contains(pixelX, pixelY)) continue;
    ChartHit hit{.chart = static_cast<int>(c), .x = frame.dataX(pixelX), .y = frame.dataY(pixelY)};
    Nearest nearest;
    const Pointer pointer{frame, pixelX, pixelY, reach};
    const auto& series = grid.charts[c].series;
    for (size_t s = 0; s < series.size(); ++s)
      offerSeries(nearest, pointer, series[s], {hit.chart, static_cast<int>(s), -1});
    if (nearest.curve.chart >= 0) {
      hit.curve = nearest.curve;
      hit.curveY = nearest.y;
    }
    return hit;
  }
  return std::nullopt;
}

CurvePoints pointsOf(const render::ChartGrid& grid, const CurveRef& curve) {
  const Series& s =
      grid.charts.at(static_cast<size_t>(curve.chart)).series.at(static_cast<size_t>(curve.series));
  if (s.kind != SeriesKind::Cloud || !s.cloud) return {s.x, s.y};
  const size_t first = static_cast<size_t>(curve.row) * s.x.size();
  if (curve.row < 0 || first + s.x.size() > s.cloud->y.size())
    throw std::out_of_range("a row that the cloud does not have");
  const auto begin = s.cloud->y.begin() + static_cast<std::ptrdiff_t>(first);
  return {s.x, std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(s.x.size()))};
}

}  // namespace marey::gui
