#include "stats/diversity.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "motion/features.h"
#include "stats/bones.h"

namespace marey::stats {
namespace {

double poseDistance(const Matrix& a, const Matrix& b, int maxFrames) {
  const auto frames = std::min(a.rows(), b.rows());
  const auto compared = std::min<Eigen::Index>(frames, maxFrames);
  const double joints = static_cast<double>(a.cols()) / 3.0;
  double sum = 0.0;
  for (Eigen::Index k = 0; k < compared; ++k) {
    const Eigen::Index t = compared > 1 ? k * (frames - 1) / (compared - 1) : 0;
    sum += std::sqrt(static_cast<double>((a.row(t) - b.row(t)).squaredNorm()) / joints);
  }
  return compared > 0 ? sum / static_cast<double>(compared) : 0.0;
}

}  // namespace

Matrix rootFramePoses(const Clip& clip) {
  FeatureSpec spec;
  spec.fps = clip.fps;
  return extractFeatures(clip, spec).pose;
}

std::vector<int> spreadIndices(int count, int limit) {
  std::vector<int> out;
  const int kept = std::min(count, std::max(1, limit));
  out.reserve(static_cast<size_t>(kept));
  for (int i = 0; i < kept; ++i)
    out.push_back(static_cast<int>(static_cast<int64_t>(i) * count / kept));
  return out;
}

std::vector<double> pairDistances(const std::vector<Clip>& clips, int maxFrames) {
  requireSameJoints(clips);
  std::vector<Matrix> poses;
  poses.reserve(clips.size());
  for (const Clip& clip : clips) {
    if (clip.fps != clips.front().fps)
      throwInput({.path = clip.name}, fmt::format("{} fps as the other clips", clips.front().fps),
                 "{}", clip.fps);
    poses.push_back(rootFramePoses(clip));
  }
  return pairDistances(poses, maxFrames);
}

std::vector<double> pairDistances(const std::vector<Matrix>& poses, int maxFrames) {
  const size_t n = poses.size();
  std::vector<double> out(n * n, 0.0);
  for (size_t i = 0; i < n; ++i)
    for (size_t j = i + 1; j < n; ++j)
      out[i * n + j] = out[j * n + i] = poseDistance(poses[i], poses[j], maxFrames);
  return out;
}

double meanPairDistance(const std::vector<double>& distances, const std::vector<int>& weights) {
  const size_t n = weights.size();
  double sum = 0.0;
  double pairs = 0.0;
  for (size_t i = 0; i < n; ++i)
    for (size_t j = i + 1; j < n; ++j) {
      const double weight = static_cast<double>(weights[i]) * weights[j];
      sum += weight * distances[i * n + j];
      pairs += weight;
    }
  return pairs > 0.0 ? sum / pairs : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace marey::stats
