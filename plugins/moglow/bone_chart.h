// Local coordinates of a pose along its skeleton, from the root outwards: an exact, triangular
// change of variables in which constant bone lengths and planted feet are plain.
//
// A joint's bone is seen in a frame F whose third axis is the bone's foreseen direction:
// q = F' (x_j - x_parent), u = (q1, q2, q3 - sqrt(L^2 - q1^2 - q2^2)). A bone of constant length
// L has u3 = 0 whatever its direction; rotation and shift keep volumes (log-determinant 0).
// A foot's (q1, q2) are further taken relative to where the foot stood, divided by a scale that
// shrinks with its speed, and compressed radially, w(r) = asinh(r) + r/8: a planted foot is a
// sharp peak at 0 that a network need not learn.
#pragma once

#include <cstdint>
#include <vector>

#include "nn/torch.h"

namespace marey::moglow {

/// What the chart knows of the body. Lengths in centimetres.
struct BoneChart {
  std::vector<int64_t> parents;  ///< -1 for joint 0 alone, parents first
  std::vector<int64_t> feet;     ///< contact joints
  torch::Tensor lengths;         ///< [J]: reference bone lengths
  torch::Tensor axes;            ///< [J, 3]: mean bone directions, unit
  torch::Tensor sides;           ///< [J, 3]: unit vectors at right angles to `axes`
};

/// How firmly each foot is held to its last place: per frame and foot.
struct FootGate {
  torch::Tensor hold;   ///< [N, feet]: 0 (foreseen place) .. 1 (last place)
  torch::Tensor scale;  ///< [N, feet]: centimetres
};

struct Charted {
  torch::Tensor value;   ///< [N, J, 3]
  torch::Tensor logDet;  ///< [N]
};

/// pose, foreseen and last are joint positions [N, J, 3] in centimetres, in one frame.
Charted toChart(const BoneChart& chart, const torch::Tensor& pose, const torch::Tensor& foreseen,
                const torch::Tensor& last, const FootGate& gate);
torch::Tensor fromChart(const BoneChart& chart, const torch::Tensor& value,
                        const torch::Tensor& foreseen, const torch::Tensor& last,
                        const FootGate& gate);

/// Where feet [K] stand in their charts: their bones now (or of `place`) and the place that they
/// held before, both as (q1, q2) [N, K, 2], given the parents' positions now.
struct FootPlaces {
  torch::Tensor now, before;
};
FootPlaces footPlaces(const BoneChart& chart, const torch::Tensor& pose,
                      const torch::Tensor& foreseen, const torch::Tensor& last);

}  // namespace marey::moglow
