#include <algorithm>

#include "render/chart/chart_private.h"

namespace marey::render {

namespace {
std::vector<Point> points(const Series& s, const std::vector<double>& y, const Mapping& map) {
  std::vector<Point> result;
  for (size_t i = 0; i < s.x.size(); ++i) result.push_back(map(s.x[i], y[i]));
  return result;
}

void drawBand(Drawing& drawing, const Series& s, const Mapping& map) {
  std::vector<Point> outline = points(s, s.low, map);
  const std::vector<Point> top = points(s, s.high, map);
  outline.insert(outline.end(), top.rbegin(), top.rend());
  drawing.polygon(outline, withOpacity(s.colour, s.opacity));
}

void drawDensity(Drawing& drawing, const Series& s, const Mapping& map) {
  if (s.x.empty()) return;
  const std::vector<Point> curve = points(s, s.y, map);
  std::vector<Point> outline = curve;
  outline.push_back(map(s.x.back(), 0.0));
  outline.push_back(map(s.x.front(), 0.0));
  drawing.polygon(outline, withOpacity(s.colour, s.opacity));
  drawing.polyline(curve, s.colour, s.width, s.dashed);
}

void drawBars(Drawing& drawing, const Series& s, const Mapping& map) {
  for (size_t i = 0; i < s.x.size(); ++i) {
    const Point a = map(s.x[i] - s.width / 2, 0.0), b = map(s.x[i] + s.width / 2, s.y[i]);
    drawing.fillBox({a.x, std::min(a.y, b.y), b.x, std::max(a.y, b.y)},
                    withOpacity(s.colour, s.opacity));
  }
}

void drawIntervals(Drawing& drawing, const Series& s, const Mapping& map) {
  for (size_t i = 0; i < s.y.size(); ++i) {
    const Point a = map(s.low[i], s.y[i] - s.width / 2), b = map(s.high[i], s.y[i] + s.width / 2);
    drawing.fillBox({a.x, std::min(a.y, b.y), b.x, std::max(a.y, b.y)},
                    withOpacity(s.colour, s.opacity));
  }
}

void drawDots(Drawing& drawing, const Series& s, const Mapping& map) {
  for (size_t i = 0; i < s.low.size(); ++i) {
    const bool alongX = s.errorAxis == 'x';
    const Point a = alongX ? map(s.low[i], s.y[i]) : map(s.x[i], s.low[i]);
    const Point b = alongX ? map(s.high[i], s.y[i]) : map(s.x[i], s.high[i]);
    drawing.line(a, b, s.colour, 2.0);
  }
  for (size_t i = 0; i < s.x.size(); ++i) {
    drawing.disc(map(s.x[i], s.y[i]), 5.5, {1, 1, 1, 1});
    drawing.disc(map(s.x[i], s.y[i]), 4.2, s.colour);
  }
}

void drawRule(Drawing& drawing, const Series& s, const Mapping& map) {
  if (s.kind == SeriesKind::HorizontalRule) {
    const double y = map(map.x.low, s.y.front()).y;
    drawing.line({map.plot.left, y}, {map.plot.right, y}, s.colour, s.width, s.dashed);
    return;
  }
  const double x = map(s.x.front(), map.y.low).x;
  drawing.line({x, map.plot.top}, {x, map.plot.bottom}, s.colour, s.width, s.dashed);
}

}  // namespace

void drawSeries(Drawing& drawing, const Series& s, const Mapping& map) {
  switch (s.kind) {
    case SeriesKind::Line:
      drawing.polyline(points(s, s.y, map), s.colour, s.width, s.dashed);
      break;
    case SeriesKind::Band:
      drawBand(drawing, s, map);
      break;
    case SeriesKind::Density:
      drawDensity(drawing, s, map);
      break;
    case SeriesKind::Bars:
      drawBars(drawing, s, map);
      break;
    case SeriesKind::Intervals:
      drawIntervals(drawing, s, map);
      break;
    case SeriesKind::Dots:
      drawDots(drawing, s, map);
      break;
    case SeriesKind::HorizontalRule:
    case SeriesKind::VerticalRule:
      drawRule(drawing, s, map);
      break;
    case SeriesKind::Cloud:
      drawCloud(drawing, s, map);
      break;
  }
}

}  // namespace marey::render
