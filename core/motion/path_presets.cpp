#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/error.h"
#include "motion/path.h"

namespace marey {
namespace {

constexpr double kTurnRate = 40.0 * std::numbers::pi / 180.0;  ///< rad/s
constexpr double kTurnSpeed = 1.2;                             ///< m/s
constexpr double kCircleRadiusM = 3.0;

/// Root frame at a time, from the origin facing +Z, at human speed.
using Course = std::function<RootFrame(double timeS)>;

Course straight(double side, double forward) {
  return [=](double t) { return RootFrame{.x = side * t, .z = forward * t}; };
}

/// An arc walked at `speed` while turning at `rate` (positive: to the left, towards +X).
Course arc(double speed, double rate) {
  return [=](double t) {
    const double radius = speed / rate;
    return RootFrame{radius * (1.0 - std::cos(rate * t)), radius * std::sin(rate * t), rate * t};
  };
}

/// A figure eight (lemniscate of Gerono) walked at constant speed: the parameter is integrated
/// with the midpoint rule from the start, or from the latest time that was asked for.
Course figureEight(double speed) {
  constexpr double kLength = 3.0;
  constexpr double kWidth = 1.7;
  // Turned so that the walk starts along +Z.
  const double tilt = std::atan2(2.0 * kWidth, kLength);
  const auto derivative = [](double u) {
    return std::array<double, 2>{2.0 * kWidth * std::cos(2.0 * u), kLength * std::cos(u)};
  };
  const auto rate = [=](double u) {
    const auto d = derivative(u);
    return speed / std::hypot(d[0], d[1]);
  };
  return [=, u = 0.0, now = 0.0](double t) mutable {
    if (t < now) u = now = 0.0;
    const int steps = std::max(1, static_cast<int>(std::ceil((t - now) * 200.0)));
    const double h = (t - now) / steps;
    for (int i = 0; i < steps; ++i) u += h * rate(u + 0.5 * h * rate(u));
    now = t;
    const double x = kWidth * std::sin(2.0 * u);
    const double z = kLength * std::sin(u);
    const auto d = derivative(u);
    const double c = std::cos(tilt);
    const double s = std::sin(tilt);
    return RootFrame{c * x - s * z, s * x + c * z, std::atan2(d[0], d[1]) - tilt};
  };
}

struct Preset {
  PathPreset text;
  std::function<Course()> course;
};

const std::vector<Preset>& presets() {
  static const std::vector<Preset> list = {
      {{"still", "standing at the origin"}, [] { return straight(0.0, 0.0); }},
      {{"sideways", "0.6 m/s to the left, facing ahead"}, [] { return straight(0.6, 0.0); }},
      {{"slow", "straight ahead at 0.7 m/s"}, [] { return straight(0.0, 0.7); }},
      {{"fast", "straight ahead at 1.9 m/s"}, [] { return straight(0.0, 1.9); }},
      {{"backward", "straight back at 0.7 m/s, facing ahead"}, [] { return straight(0.0, -0.7); }},
      {{"turn-left", "1.2 m/s, turning left by 40 degrees per second"},
       [] { return arc(kTurnSpeed, kTurnRate); }},
      {{"turn-right", "1.2 m/s, turning right by 40 degrees per second"},
       [] { return arc(kTurnSpeed, -kTurnRate); }},
      {{"circle", "a circle of 3 m radius to the left at 1.2 m/s"},
       [] { return arc(kTurnSpeed, kTurnSpeed / kCircleRadiusM); }},
      {{"figure-eight", "a figure eight of 6 m length at 1.2 m/s"},
       [] { return figureEight(kTurnSpeed); }},
  };
  return list;
}

}  // namespace

const std::vector<PathPreset>& pathPresets() {
  static const std::vector<PathPreset> list = [] {
    std::vector<PathPreset> texts;
    for (const Preset& preset : presets()) texts.push_back(preset.text);
    return texts;
  }();
  return list;
}

std::vector<RootFrame> presetPath(const std::string& name, double seconds, double fps,
                                  double scale) {
  std::string known;
  for (const Preset& preset : presets()) {
    if (preset.text.name != name) {
      known += (known.empty() ? "" : ", ") + preset.text.name;
      continue;
    }
    if (!(seconds > 0.0 && fps > 0.0 && scale > 0.0))
      throw UsageError("a path needs a positive duration, frame rate and scale");
    Course course = preset.course();
    std::vector<RootFrame> out;
    const auto frames = std::max(1l, std::lround(seconds * fps));
    for (long i = 0; i < frames; ++i) {
      RootFrame frame = course(static_cast<double>(i) / fps);
      frame.x *= scale;
      frame.z *= scale;
      if (!out.empty())
        frame.heading = out.back().heading +
                        std::remainder(frame.heading - out.back().heading, 2.0 * std::numbers::pi);
      out.push_back(frame);
    }
    return out;
  }
  throw UsageError("there is no path '" + name + "'; known paths: " + known);
}

}  // namespace marey
