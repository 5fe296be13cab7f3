#include "task/pose_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace marey {
namespace {

/// Mean over the joints of a frame, centimetres.
double distanceAt(const Clip& a, const Clip& b, int frame) {
  double sum = 0.0;
  for (int j = 0; j < a.jointCount(); ++j) sum += (a.at(frame, j) - b.at(frame, j)).norm();
  return 100.0 * sum / a.jointCount();
}

}  // namespace

PoseError poseError(std::span<const Clip> motions, const Clip& reference) {
  if (motions.empty()) throw InputError({.path = "pose error"}, "at least one motion", "none");
  int frames = reference.frameCount();
  for (const Clip& motion : motions) {
    if (motion.jointCount() != reference.jointCount())
      throwInput({.path = motion.name}, fmt::format("{} joints", reference.jointCount()), "{}",
                 motion.jointCount());
    frames = std::min(frames, motion.frameCount());
  }
  const auto count = static_cast<double>(motions.size());
  PoseError out{.bestCm = std::numeric_limits<double>::infinity(),
                .byFrameCm = std::vector<double>(static_cast<size_t>(frames), 0.0)};
  for (const Clip& motion : motions) {
    double sum = 0.0;
    for (int t = 0; t < frames; ++t) {
      const double d = distanceAt(motion, reference, t);
      sum += d;
      out.byFrameCm[static_cast<size_t>(t)] += d / count;
    }
    out.meanCm += sum / (frames * count);
    out.bestCm = std::min(out.bestCm, sum / frames);
  }
  return out;
}

std::vector<std::pair<int, double>> errorsAtHorizons(const PoseError& error, double fps) {
  std::vector<std::pair<int, double>> out;
  for (const int ms : kHorizonsMs) {
    const auto frame = static_cast<size_t>(std::max(0L, std::lround(ms * 1e-3 * fps) - 1));
    if (frame < error.byFrameCm.size()) out.emplace_back(ms, error.byFrameCm[frame]);
  }
  return out;
}

}  // namespace marey
