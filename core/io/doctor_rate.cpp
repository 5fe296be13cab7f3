#include <algorithm>
#include <cmath>

#include "io/doctor_checks.h"

namespace marey::io {
namespace {

/// One foot from the beginning of a swing to that of the next.
struct Stride {
  double lengthM = 0.0, seconds = 0.0;
};

double middle(std::vector<double> values) {
  const auto at = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Displacements over the floor from frame to frame.
std::vector<double> floorSteps(const Clip& clip, int joint) {
  std::vector<double> out;
  for (int t = 1; t < clip.frameCount(); ++t) {
    const Vec3 d = clip.at(t, joint) - clip.at(t - 1, joint);
    out.push_back(std::hypot(d.x(), d.z()));
  }
  return out;
}

struct Swing {
  size_t begin = 0, end = 0;  ///< frames between which the foot moves
};

/// Runs of steps that are not far shorter than the longest, with a rest before and after.
std::vector<Swing> swingsOf(const std::vector<double>& steps) {
  constexpr double kRestShare = 0.2;
  std::vector<double> sorted = steps;
  std::sort(sorted.begin(), sorted.end());
  const double limit = kRestShare * sorted[sorted.size() * 95 / 100];
  std::vector<Swing> out;
  for (size_t i = 0; i < steps.size();) {
    size_t end = i;
    while (end < steps.size() && steps[end] >= limit) ++end;
    if (end > i && i > 0 && end < steps.size()) out.push_back({i, end});
    i = std::max(end, i + 1);
  }
  return out;
}

void addStrides(const Clip& clip, int foot, double leastM, std::vector<Stride>& out) {
  std::vector<Swing> swings = swingsOf(floorSteps(clip, foot));
  const auto lengthOf = [&](const Swing& swing) {
    const Vec3 d =
        clip.at(static_cast<int>(swing.end), foot) - clip.at(static_cast<int>(swing.begin), foot);
    return std::hypot(d.x(), d.z());
  };
  std::erase_if(swings, [&](const Swing& swing) { return lengthOf(swing) < leastM; });
  for (size_t i = 0; i + 1 < swings.size(); ++i)
    out.push_back({lengthOf(swings[i]),
                   static_cast<double>(swings[i + 1].begin - swings[i].begin) / clip.fps});
}

}  // namespace

std::optional<Fault> doubtfulRate(const Clip& clip, const SkeletonRoles& roles) {
  constexpr double kUsual = 1.4, kTimesOff = 3.0;  // metre seconds
  constexpr double kLeastStrideM = 0.6;
  constexpr size_t kLeastStrides = 3;
  if (roles.feet.size() != 2 || clip.frameCount() < 3) return std::nullopt;
  std::vector<Stride> strides;
  for (const int foot : roles.feet) addStrides(clip, foot, kLeastStrideM, strides);
  if (strides.size() < kLeastStrides) return std::nullopt;
  std::vector<double> products, lengths, seconds;
  for (const Stride& s : strides) {
    products.push_back(s.lengthM * s.seconds);
    lengths.push_back(s.lengthM);
    seconds.push_back(s.seconds);
  }
  const double factor = middle(products) / kUsual;
  if (factor < kTimesOff && factor > 1.0 / kTimesOff) return std::nullopt;
  return Fault{
      "rate_doubtful", Severity::Warning,
      fmt::format("strides of {:.2f} m last {:.2f} s at {:g} frames per second: people move "
                  "about {:.1f} times {}; give the true rate with --source-fps",
                  middle(lengths), middle(seconds), clip.fps, factor > 1.0 ? factor : 1.0 / factor,
                  factor > 1.0 ? "quicker" : "slower"),
      std::nullopt};
}

}  // namespace marey::io
