#include "render/scene/floor.h"

#include <algorithm>
#include <cmath>

#include "render/base/drawing.h"

namespace marey::render {

namespace {
constexpr double fadeM = 2.2;  ///< width of the rim that fades into the background

/// Draws in metres on a floor picture.
struct FloorCanvas {
  FloorCanvas(const FloorArea& a, double perMetre)
      : area(a),
        canvas(std::max(1, static_cast<int>(std::ceil(a.width() * perMetre))),
               std::max(1, static_cast<int>(std::ceil(a.depth() * perMetre)))),
        drawing(canvas.context()) {
    cairo_scale(canvas.context(), perMetre, perMetre);
    cairo_translate(canvas.context(), -a.x0, -a.z0);
    cairo_set_line_cap(canvas.context(), CAIRO_LINE_CAP_ROUND);
  }
  FloorArea area;
  Canvas canvas;
  Drawing drawing;
};

double pixelsPerMetre(const FloorArea& area, double wanted, double most) {
  return std::min(wanted, most / std::max(area.width(), area.depth()));
}

void paintGrid(Drawing& drawing, const FloorArea& area, double gridM) {
  const auto lines = [&](double low, double high, auto&& draw) {
    const int last = static_cast<int>(std::floor(high / gridM));
    for (int k = static_cast<int>(std::ceil(low / gridM)); k <= last; ++k) {
      const double at = k * gridM;
      const bool metre = std::abs(at - std::round(at)) < 1e-6;
      draw(at, grey(metre ? 0.80 : 0.88), metre ? 0.011 : 0.008);
    }
  };
  lines(area.x0, area.x1, [&](double x, const Colour& colour, double width) {
    drawing.line({x, area.z0}, {x, area.z1}, colour, width);
  });
  lines(area.z0, area.z1, [&](double z, const Colour& colour, double width) {
    drawing.line({area.x0, z}, {area.x1, z}, colour, width);
  });
}

void paintArrow(Drawing& drawing, Point tip, Point direction, const Colour& colour) {
  constexpr double length = 0.17, half = 0.075;
  const Point side{-direction.y, direction.x};
  const Point back{tip.x - length * direction.x, tip.y - length * direction.y};
  drawing.polygon({tip,
                   {back.x + half * side.x, back.y + half * side.y},
                   {back.x + 0.3 * length * direction.x, back.y + 0.3 * length * direction.y},
                   {back.x - half * side.x, back.y - half * side.y}},
                  colour);
}

/// A line with an arrow head each metre and one at its end.
void paintPath(Drawing& drawing, const std::vector<std::pair<double, double>>& path) {
  const Colour colour = grey(0.55);
  std::vector<Point> points;
  points.reserve(path.size());
  for (const auto& [x, z] : path) points.push_back({x, z});
  double total = 0.0;
  for (size_t i = 1; i < points.size(); ++i) {
    total += std::hypot(points[i].x - points[i - 1].x, points[i].y - points[i - 1].y);
  }
  double length = 0.0;
  int nextArrow = 1;  // metres from the start
  Point direction{0, 0};
  for (size_t i = 1; i < points.size(); ++i) {
    const Point a = points[i - 1], b = points[i];
    const double step = std::hypot(b.x - a.x, b.y - a.y);
    if (step < 1e-9) continue;
    direction = {(b.x - a.x) / step, (b.y - a.y) / step};
    for (; nextArrow <= std::min(length + step, total - 0.5); ++nextArrow) {
      const double s = nextArrow - length;
      paintArrow(drawing, {a.x + s * direction.x, a.y + s * direction.y}, direction, colour);
    }
    length += step;
  }
  if (length < 0.05) return;
  drawing.polyline(points, colour, 0.022);
  drawing.disc(points.front(), 0.045, colour);
  paintArrow(drawing, {points.back().x + 0.1 * direction.x, points.back().y + 0.1 * direction.y},
             direction, colour);
}

void fadeRim(FloorImage& floor, const Colour& background) {
  Image& image = floor.image;
  const double perMetre = image.width / floor.area.width(), rim = fadeM * perMetre;
  const double ink[3] = {background.r * 255, background.g * 255, background.b * 255};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      // Distance into the rim, with round corners.
      const double dx = std::max({0.0, rim - x, x - (image.width - 1 - rim)});
      const double dy = std::max({0.0, rim - y, y - (image.height - 1 - rim)});
      if (dx == 0.0 && dy == 0.0) continue;
      const double t = std::min(1.0, std::hypot(dx, dy) / rim);
      const double share = t * t * (3.0 - 2.0 * t);
      for (int c = 0; c < 3; ++c) {
        uint8_t& v = image.at(x, y)[c];
        v = static_cast<uint8_t>(std::lround(v + (ink[c] - v) * share));
      }
    }
  }
}

/// Sum over a sliding window: one pass of a box blur along a row or column.
void boxBlurLine(const float* in, float* out, int count, int stride, int radius) {
  float sum = 0.0F;
  const auto value = [&](int i) {
    return i < 0 || i >= count ? 0.0F : in[static_cast<size_t>(i) * stride];
  };
  for (int i = -radius; i < radius; ++i) sum += value(i);
  for (int i = 0; i < count; ++i) {
    sum += value(i + radius);
    out[static_cast<size_t>(i) * stride] = sum / static_cast<float>(2 * radius + 1);
    sum -= value(i - radius);
  }
}

/// Three box blurs are close to a Gaussian of sigma = radius.
void blur(std::vector<float>& values, int width, int height, int radius) {
  if (radius < 1) return;
  std::vector<float> other(values.size());
  for (int pass = 0; pass < 3; ++pass) {
    for (int y = 0; y < height; ++y) {
      const size_t row = static_cast<size_t>(y) * width;
      boxBlurLine(&values[row], &other[row], width, 1, radius);
    }
    for (int x = 0; x < width; ++x) boxBlurLine(&other[x], &values[x], height, width, radius);
  }
}

Point shaded(const Vec3& p, const Eigen::Vector2f& slant) {
  return {p.x() + p.y() * slant.x(), p.z() + p.y() * slant.y()};
}

/// Silhouettes of the parts of all casters whose middle is in [low, high) metres.
std::vector<float> silhouettes(const std::vector<Caster>& casters, const Eigen::Vector2f& slant,
                               const FloorArea& area, double perMetre, float low, float high) {
  FloorCanvas canvas(area, perMetre);
  const auto part = [&](const Vec3& a, const Vec3& b, double radius, double opacity) {
    const float middle = 0.5F * (a.y() + b.y());
    if (middle < low || middle >= high) return;
    canvas.drawing.line(shaded(a, slant), shaded(b, slant), {0, 0, 0, opacity}, 2.0 * radius);
  };
  for (const Caster& caster : casters) {
    for (const Capsule& c : caster.shape->capsules) {
      part(caster.pose[static_cast<size_t>(c.from)], caster.pose[static_cast<size_t>(c.to)],
           0.5 * (c.radiusFrom + c.radiusTo), caster.opacity);
    }
    if (caster.shape->head < 0) continue;
    const Vec3 head = headCentre(*caster.shape, caster.pose);
    part(head, head, caster.shape->headRadiusM, caster.opacity);
  }
  const Image image = canvas.canvas.image();
  std::vector<float> values(image.pixels.size() / 4);
  for (size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<float>(image.pixels[4 * i + 3]);
  return values;
}
}  // namespace

void FloorArea::include(double x, double z) {
  x0 = std::min(x0, x);
  x1 = std::max(x1, x);
  z0 = std::min(z0, z);
  z1 = std::max(z1, z);
}

FloorImage paintFloor(const FloorSpec& spec) {
  FloorImage floor;
  floor.area = spec.area.grown(0.4 + fadeM);
  FloorCanvas canvas(floor.area, pixelsPerMetre(floor.area, 220.0, 2600.0));
  canvas.drawing.fillBox({floor.area.x0, floor.area.z0, floor.area.x1, floor.area.z1},
                         {0.962, 0.965, 0.972, 1});
  paintGrid(canvas.drawing, floor.area, spec.gridM);
  if (spec.path.size() > 1) paintPath(canvas.drawing, spec.path);
  for (const FloorMark& mark : spec.marks) {
    canvas.drawing.disc({mark.x, mark.z}, mark.radiusM,
                        withOpacity(mark.colour, 0.22 * mark.colour.a));
    canvas.drawing.ring({mark.x, mark.z}, mark.radiusM,
                        withOpacity(mark.colour, 0.8 * mark.colour.a), 0.012);
  }
  floor.image = canvas.canvas.image();
  fadeRim(floor, spec.background);
  return floor;
}

FloorImage paintShadows(const std::vector<Caster>& casters, const Eigen::Vector2f& slant) {
  FloorImage shadows;
  bool first = true;
  for (const Caster& caster : casters) {
    for (const Vec3& p : caster.pose) {
      const Point at = shaded(p, slant);
      if (first) shadows.area = {at.x, at.y, at.x, at.y};
      first = false;
      shadows.area.include(at.x, at.y);
    }
  }
  shadows.area = shadows.area.grown(0.4);
  const double perMetre = pixelsPerMetre(shadows.area, 110.0, 1500.0);
  constexpr float kneeM = 0.35F, highest = 1e9F;
  std::vector<float> low = silhouettes(casters, slant, shadows.area, perMetre, -highest, kneeM);
  std::vector<float> high = silhouettes(casters, slant, shadows.area, perMetre, kneeM, highest);
  const int width = std::max(1, static_cast<int>(std::ceil(shadows.area.width() * perMetre)));
  const int height = static_cast<int>(low.size()) / width;
  blur(low, width, height, static_cast<int>(std::lround(0.010 * perMetre)));
  blur(high, width, height, static_cast<int>(std::lround(0.030 * perMetre)));
  shadows.image = Image(width, height, {0, 0, 0, 0});
  for (size_t i = 0; i < low.size(); ++i) {
    const float shade = 1.0F - (1.0F - 0.34F * low[i] / 255.0F) * (1.0F - 0.20F * high[i] / 255.0F);
    shadows.image.pixels[4 * i + 3] = static_cast<uint8_t>(std::lround(255.0F * shade));
  }
  return shadows;
}

}  // namespace marey::render
