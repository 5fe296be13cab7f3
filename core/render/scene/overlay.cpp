#include "render/scene/overlay.h"

#include <algorithm>
#include <cmath>

#include "render/base/drawing.h"

namespace marey::render {

namespace {
/// Text grows with the picture, but stays readable in small ones.
double textScale(int height) {
  return std::clamp(height / 480.0, 0.75, 2.4);
}

std::vector<std::pair<std::string, Colour>> systemsOf(const SceneSpec& spec) {
  std::vector<std::pair<std::string, Colour>> systems;
  if (!spec.legend) return systems;
  for (const SceneMotion& motion : spec.motions) {
    const bool known = std::any_of(systems.begin(), systems.end(),
                                   [&](const auto& s) { return s.first == motion.system; });
    if (!known && !motion.system.empty()) systems.emplace_back(motion.system, motion.colour);
  }
  return systems;
}

void drawScaleBar(Drawing& drawing, const ScaleBar& bar, const Camera& camera, const Image& image) {
  const double scale = textScale(image.height);
  const ScreenPoint a = project(camera, bar.from, image.width, image.height);
  const ScreenPoint b = project(camera, bar.to, image.width, image.height);
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  if (length < 4.0) return;
  // End ticks stand across the bar.
  const double tx = -(b.y - a.y) / length * 4.0 * scale, ty = (b.x - a.x) / length * 4.0 * scale;
  const auto stroke = [&](const Colour& colour, double width) {
    drawing.line({a.x, a.y}, {b.x, b.y}, colour, width);
    drawing.line({a.x - tx, a.y - ty}, {a.x + tx, a.y + ty}, colour, width);
    drawing.line({b.x - tx, b.y - ty}, {b.x + tx, b.y + ty}, colour, width);
  };
  stroke({1, 1, 1, 0.8}, 4.5 * scale);
  stroke(grey(0.2), 1.6 * scale);
  drawing.text("1 m", {(a.x + b.x) / 2, (a.y + b.y) / 2 + 17.0 * scale},
               {.size = 12.0 * scale, .colour = grey(0.2), .align = Align::Centre, .halo = true});
}
}  // namespace

double overlayHeight(const SceneSpec& spec, int height) {
  const double scale = textScale(height);
  return (spec.title.empty() ? 0.0 : 26.0 * scale) + (systemsOf(spec).empty() ? 0.0 : 24.0 * scale);
}

Image withOverlay(const Image& image, const SceneSpec& spec, const Camera& camera,
                  const std::optional<ScaleBar>& bar) {
  Canvas canvas(image);
  Drawing drawing(canvas.context());
  const double scale = textScale(image.height), left = 18.0 * scale;
  double y = 26.0 * scale;
  if (!spec.title.empty()) {
    drawing.text(spec.title, {left, y},
                 {.size = 16.0 * scale, .colour = grey(0.1), .bold = true, .halo = true});
    y += 24.0 * scale;
  }
  double x = left;
  const TextStyle style{.size = 13.0 * scale, .colour = grey(0.2), .halo = true};
  for (const auto& [name, colour] : systemsOf(spec)) {
    drawing.disc({x + 5.5 * scale, y - 4.5 * scale}, 5.5 * scale, withOpacity(colour, 1.0));
    drawing.text(name, {x + 16.0 * scale, y}, style);
    x += 16.0 * scale + drawing.textWidth(name, style) + 18.0 * scale;
  }
  if (bar) drawScaleBar(drawing, *bar, camera, image);
  return canvas.image();
}

}  // namespace marey::render
