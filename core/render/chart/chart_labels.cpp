// Texts that have to find their place: cut to their room, kept apart from each other.
#include <algorithm>

#include "render/chart/chart_private.h"

namespace marey::render {

namespace {
/// Of DejaVu Sans, in sizes.
constexpr double ascent = 0.76, descent = 0.24;
constexpr double lineApart = 15.0;
constexpr int mostTries = 12;

bool inside(const Box& box, const Box& plot) {
  return box.left >= plot.left && box.right <= plot.right && box.top >= plot.top &&
         box.bottom <= plot.bottom;
}

/// Places for the name of a rule, the best first.
std::vector<PlacedText> placesFor(const Series& rule, const std::string& name, const Mapping& map) {
  std::vector<PlacedText> out;
  TextStyle style{.size = 12.0, .colour = mix(rule.colour, grey(0.0), 0.2), .halo = true};
  const auto add = [&](Align align, double x, double y) {
    style.align = align;
    out.push_back({name, {x, y}, style});
  };
  const Box& plot = map.plot;
  if (rule.kind == SeriesKind::HorizontalRule) {
    const double y = map(map.x.low, rule.y.front()).y;
    for (int k = 0; k < mostTries; ++k) {
      add(Align::Right, plot.right - 4.0, y - 5.0 - k * lineApart);
      add(Align::Right, plot.right - 4.0, y + 14.0 + k * lineApart);
      add(Align::Left, plot.left + 4.0, y - 5.0 - k * lineApart);
      add(Align::Left, plot.left + 4.0, y + 14.0 + k * lineApart);
    }
    return out;
  }
  const double x = map(rule.x.front(), map.y.low).x;
  const bool right = x > plot.left + 0.6 * plot.width();
  for (int k = 0; k < mostTries; ++k) {
    const double y = plot.top + 13.0 + k * lineApart;
    for (const bool before : {right, !right})
      add(before ? Align::Right : Align::Left, before ? x - 5.0 : x + 5.0, y);
  }
  return out;
}
}  // namespace

std::string elided(Drawing& drawing, const std::string& text, const TextStyle& style,
                   double width) {
  if (drawing.textWidth(text, style) <= width) return text;
  const std::string dots = "\u2026";
  std::string cut = text;
  while (!cut.empty()) {
    // A whole character of UTF-8: its further bytes begin with the bits 10.
    while (!cut.empty() && (static_cast<unsigned char>(cut.back()) & 0xC0U) == 0x80U)
      cut.pop_back();
    if (!cut.empty()) cut.pop_back();
    if (drawing.textWidth(cut + dots, style) <= width) return cut + dots;
  }
  return {};
}

Box boxOf(Drawing& drawing, const std::string& text, Point at, const TextStyle& style) {
  const double width = drawing.textWidth(text, style);
  const double before = style.align == Align::Left     ? 0.0
                        : style.align == Align::Centre ? width / 2
                                                       : width;
  if (style.turn != 0.0)
    return {at.x - ascent * style.size, at.y - width + before, at.x + descent * style.size,
            at.y + before};
  return {at.x - before, at.y - ascent * style.size, at.x - before + width,
          at.y + descent * style.size};
}

bool overlap(const Box& a, const Box& b) {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

std::vector<PlacedText> ruleLabels(Drawing& drawing, const Chart& chart, const Mapping& map) {
  std::vector<PlacedText> out;
  std::vector<Box> taken;
  for (const Series& s : chart.series) {
    const bool rule = s.kind == SeriesKind::HorizontalRule || s.kind == SeriesKind::VerticalRule;
    if (!rule || !s.inLegend || s.name.empty()) continue;
    const std::string name = elided(drawing, s.name, {.size = 12.0}, map.plot.width() - 8.0);
    for (const PlacedText& place : placesFor(s, name, map)) {
      const Box box = boxOf(drawing, place.text, place.at, place.style);
      const bool free = std::none_of(taken.begin(), taken.end(),
                                     [&](const Box& other) { return overlap(box, other); });
      if (!free || !inside(box, map.plot)) continue;
      taken.push_back(box);
      out.push_back(place);
      break;
    }
  }
  return out;
}

}  // namespace marey::render
