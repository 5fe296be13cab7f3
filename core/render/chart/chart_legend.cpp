#include <algorithm>
#include <cmath>

#include "render/chart/chart_private.h"

namespace marey::render {

namespace {
constexpr double swatchWidth = 20.0, swatchGap = 6.0, itemGap = 18.0, lineHeight = 19.0;

TextStyle legendStyle() {
  return {.size = 12.0, .colour = grey(0.2)};
}

bool isRule(const Series& series) {
  return series.kind == SeriesKind::HorizontalRule || series.kind == SeriesKind::VerticalRule;
}

void drawSwatch(Drawing& drawing, const Series& look, Point at) {
  const double middle = at.y - 4.2;
  switch (look.kind) {
    case SeriesKind::Line:
    case SeriesKind::Cloud:  // one line of many is too faint for a swatch
      drawing.line({at.x, middle}, {at.x + swatchWidth, middle}, look.colour,
                   std::max(2.0, look.width), look.dashed);
      break;
    case SeriesKind::Dots:
      drawing.disc({at.x + swatchWidth / 2, middle}, 4.5, look.colour);
      break;
    case SeriesKind::Density:
      drawing.fillBox({at.x, middle - 5, at.x + swatchWidth, middle + 5},
                      withOpacity(look.colour, look.opacity));
      drawing.line({at.x, middle - 5}, {at.x + swatchWidth, middle - 5}, look.colour, look.width);
      break;
    default:
      drawing.fillBox({at.x, middle - 5, at.x + swatchWidth, middle + 5},
                      withOpacity(look.colour, look.opacity));
  }
}

/// Visits (item, x, line number); returns the number of lines.
template <typename Visit>
int flow(Drawing& drawing, const std::vector<LegendItem>& items, double width, const Visit& visit) {
  double x = 0.0;
  int line = 0;
  for (const LegendItem& item : items) {
    const double itemWidth =
        std::min(width, swatchWidth + swatchGap + drawing.textWidth(item.name, legendStyle()));
    if (x > 0.0 && x + itemWidth > width) {
      x = 0.0;
      ++line;
    }
    visit(item, x, line);
    x += itemWidth + itemGap;
  }
  return items.empty() ? 0 : line + 1;
}
}  // namespace

std::vector<LegendItem> legendItems(const std::vector<Chart>& charts) {
  std::vector<LegendItem> items;
  for (const Chart& chart : charts) {
    if (chart.legend != LegendPlace::Top) continue;
    for (const Series& s : chart.series) {
      if (s.name.empty() || !s.inLegend || isRule(s)) continue;
      const bool known = std::any_of(items.begin(), items.end(),
                                     [&](const LegendItem& i) { return i.name == s.name; });
      if (!known) items.push_back({s.name, s});
    }
  }
  return items;
}

double legendHeight(Drawing& drawing, const std::vector<LegendItem>& items, double width) {
  const int lines = flow(drawing, items, width, [](const LegendItem&, double, int) {});
  return lines == 0 ? 0.0 : lines * lineHeight + 4.0;
}

double drawLegend(Drawing& drawing, const std::vector<LegendItem>& items, const Box& box) {
  flow(drawing, items, box.width(), [&](const LegendItem& item, double x, int line) {
    const Point at{box.left + x, box.top + 13.0 + line * lineHeight};
    drawSwatch(drawing, item.look, at);
    const double room = box.width() - swatchWidth - swatchGap;
    drawing.text(elided(drawing, item.name, legendStyle(), room),
                 {at.x + swatchWidth + swatchGap, at.y}, legendStyle());
  });
  return legendHeight(drawing, items, box.width());
}

double directLabelWidth(Drawing& drawing, const Chart& chart) {
  if (chart.legend != LegendPlace::Direct) return 0.0;
  double width = 0.0;
  for (const Series& s : chart.series) {
    if (s.kind != SeriesKind::Line || !s.inLegend) continue;
    width = std::max(width, drawing.textWidth(s.name, legendStyle()) + 10.0);
  }
  return width;
}

void drawDirectLabels(Drawing& drawing, const Chart& chart, const Mapping& map) {
  struct Label {
    const Series* series;
    double y;
  };
  std::vector<Label> labels;
  for (const Series& s : chart.series) {
    if (s.kind != SeriesKind::Line || !s.inLegend || s.name.empty() || s.x.empty()) continue;
    labels.push_back(
        {&s, std::clamp(map(s.x.back(), s.y.back()).y, map.plot.top, map.plot.bottom)});
  }
  std::stable_sort(labels.begin(), labels.end(),
                   [](const Label& a, const Label& b) { return a.y < b.y; });
  constexpr double apart = 15.0;
  for (size_t i = 1; i < labels.size(); ++i)
    labels[i].y = std::max(labels[i].y, labels[i - 1].y + apart);
  // Pushed past the lower edge: push back up from there.
  double limit = map.plot.bottom;
  for (auto label = labels.rbegin(); label != labels.rend(); ++label) {
    label->y = std::min(label->y, limit);
    limit = label->y - apart;
  }
  for (const Label& label : labels) {
    TextStyle style = legendStyle();
    style.colour = mix(label.series->colour, grey(0.0), 0.15);
    drawing.text(label.series->name, {map.plot.right + 7.0, label.y + 4.0}, style);
  }
}

}  // namespace marey::render
