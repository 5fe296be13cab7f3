// How different the motions along one control are from each other. Motions along different controls
// differ because their paths do: their distances say nothing of a model.
#pragma once

#include <vector>

#include "motion/clip.h"
#include "motion/features.h"

namespace marey::stats {

/// Motions along one control that pairs are made of: of more, these many, spread evenly.
inline constexpr int kDiversityMotions = 48;

/// Throws InputError on a clip without left and right hip.
Matrix rootFramePoses(const Clip& clip);

/// Distance of two poses in the root frame at frame t: the root mean square over joints, metres.
double poseDistance(const Matrix& a, const Matrix& b, Eigen::Index t);

/// Sums over the pairs of some motions, frame by frame (equal time from the start).
struct PairCurve {
  std::vector<double> sumM;   ///< of poseDistance over pairs of which both go on
  std::vector<double> pairs;  ///< such pairs
  std::vector<int> motions;   ///< motions that go on: what a point rests on

  /// Mean over pairs at a frame, metres; NaN where there is none.
  double meanM(size_t frame) const;
  /// Over all pairs and frames of [first, last): the diversity, metres; NaN where there is no pair.
  double meanM(size_t first, size_t last) const;
};
/// Frames end with the second longest motion. Poses as rootFramePoses gives them.
PairCurve pairCurve(const std::vector<Matrix>& poses);

/// Which of `count` things are taken where there are too many: evenly spread, at most `limit`.
std::vector<int> spreadIndices(int count, int limit);

}  // namespace marey::stats
