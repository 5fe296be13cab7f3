// How different the motions of a set are from each other.
#pragma once

#include <vector>

#include "motion/clip.h"
#include "motion/features.h"

namespace marey::stats {

/// Distances between all pairs of clips: entry (i, j) is the mean over common frames (equal time
/// from the start) of the root mean square joint distance in the root frame, metres. Row-major,
/// clips x clips, zero on the diagonal. At most `maxFrames` frames, evenly spread, are compared.
/// Throws InputError on clips of different joints or rates, or without left and right hip.
std::vector<double> pairDistances(const std::vector<Clip>& clips, int maxFrames = 100);

/// The same of root-frame poses, [frame, 3 joints], as rootFramePoses gives them.
std::vector<double> pairDistances(const std::vector<Matrix>& poses, int maxFrames = 100);
/// Throws InputError on a clip without left and right hip.
Matrix rootFramePoses(const Clip& clip);

/// Mean of the pair distances with clip i counted weights[i] times (a clip and its own copy are no
/// pair), metres; NaN where there is no pair.
double meanPairDistance(const std::vector<double>& distances, const std::vector<int>& weights);

/// Clips that pairs are made of where there are too many: every k-th, at most `limit`.
std::vector<int> spreadIndices(int count, int limit);

}  // namespace marey::stats
