#include "stats/diversity.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace marey::stats {

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

double poseDistance(const Matrix& a, const Matrix& b, Eigen::Index t) {
  const double joints = static_cast<double>(a.cols()) / 3.0;
  return std::sqrt(static_cast<double>((a.row(t) - b.row(t)).squaredNorm()) / joints);
}

double PairCurve::meanM(size_t frame) const {
  return meanM(frame, frame + 1);
}

double PairCurve::meanM(size_t first, size_t last) const {
  double sum = 0.0;
  double count = 0.0;
  for (size_t t = first; t < std::min(last, pairs.size()); ++t) {
    sum += sumM[t];
    count += pairs[t];
  }
  return count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

PairCurve pairCurve(const std::vector<Matrix>& poses) {
  PairCurve out;
  std::vector<Eigen::Index> lengths;
  for (const Matrix& pose : poses) lengths.push_back(pose.rows());
  std::sort(lengths.rbegin(), lengths.rend());
  const auto frames = static_cast<size_t>(lengths.size() > 1 ? lengths[1] : 0);
  out.sumM.assign(frames, 0.0);
  out.pairs.assign(frames, 0.0);
  out.motions.assign(frames, 0);
  for (size_t i = 0; i < poses.size(); ++i) {
    const auto own = std::min(frames, static_cast<size_t>(poses[i].rows()));
    for (size_t t = 0; t < own; ++t) ++out.motions[t];
    for (size_t j = i + 1; j < poses.size(); ++j)
      for (size_t t = 0; t < std::min(own, static_cast<size_t>(poses[j].rows())); ++t) {
        out.sumM[t] += poseDistance(poses[i], poses[j], static_cast<Eigen::Index>(t));
        out.pairs[t] += 1.0;
      }
  }
  return out;
}

}  // namespace marey::stats
