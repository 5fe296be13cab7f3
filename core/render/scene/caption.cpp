#include "render/scene/caption.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/base/drawing.h"

namespace marey::render {

namespace {
/// Text grows with the picture, but stays readable in small ones.
double textScale(int height) {
  return std::clamp(height / 480.0, 0.75, 2.4);
}

std::vector<std::pair<std::string, Colour>> systemsOf(const Shot& shot) {
  std::vector<std::pair<std::string, Colour>> systems;
  if (!shot.caption.legend) return systems;
  for (const SceneMotion& motion : shot.motions) {
    const bool known = std::any_of(systems.begin(), systems.end(),
                                   [&](const auto& s) { return s.first == motion.label; });
    if (!known && !motion.label.empty()) systems.emplace_back(motion.label, motion.colour);
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

ScaleBar scaleBarFor(const Camera& camera, std::span<const Vec3> points) {
  Vec3 right = camera.right();
  right.y() = 0.0F;
  right.normalize();
  const Vec3 toViewer = right.cross(Vec3::UnitY());
  float start = std::numeric_limits<float>::max(), front = std::numeric_limits<float>::lowest();
  for (const Vec3& p : points) {
    start = std::min(start, p.dot(right));
    front = std::max(front, p.dot(toViewer));
  }
  const Vec3 from = start * right + (front + 0.25F) * toViewer;
  return {from, from + right};
}

double captionHeight(const Shot& shot, int height) {
  const double scale = textScale(height);
  return (shot.caption.title.empty() ? 0.0 : 26.0 * scale) +
         (systemsOf(shot).empty() ? 0.0 : 24.0 * scale);
}

Image withCaption(const Image& image, const Shot& shot, const Camera& camera,
                  const std::optional<ScaleBar>& bar) {
  Canvas canvas(image);
  Drawing drawing(canvas.context());
  const double scale = textScale(image.height), left = 18.0 * scale;
  double y = 26.0 * scale;
  if (!shot.caption.title.empty()) {
    drawing.text(shot.caption.title, {left, y},
                 {.size = 16.0 * scale, .colour = grey(0.1), .bold = true, .halo = true});
    y += 24.0 * scale;
  }
  double x = left;
  const TextStyle style{.size = 13.0 * scale, .colour = grey(0.2), .halo = true};
  for (const auto& [name, colour] : systemsOf(shot)) {
    drawing.disc({x + 5.5 * scale, y - 4.5 * scale}, 5.5 * scale, withOpacity(colour, 1.0));
    drawing.text(name, {x + 16.0 * scale, y}, style);
    x += 16.0 * scale + drawing.textWidth(name, style) + 18.0 * scale;
  }
  if (bar) drawScaleBar(drawing, *bar, camera, image);
  return canvas.image();
}

}  // namespace marey::render
