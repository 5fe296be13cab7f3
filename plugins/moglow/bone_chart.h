// Local coordinates of a pose along its skeleton, from the root outwards: an exact, triangular
// change of variables in which constant bone lengths and planted feet are plain.
//
// A joint's bone is seen in a frame F whose third axis is the bone's foreseen direction:
// q = F' (x_j - x_parent), u = (q1, q2, q3 - sqrt(L^2 - q1^2 - q2^2)). A bone of the foreseen
// length L has u3 = 0 whatever its direction; rotation and shift keep volumes (log-determinant 0).
//
// Legs stand. A knee's frame comes from bending the leg, from where the hip is now, so that the
// foot reaches the place where it is held; q2 lies in the plane of that bend and is 0 for a planted
// foot. A foot's (q1, q2) go through its gate (foot_gate.h), centred between where it stood and
// where it is foreseen. If it stays, its third coordinate is held too, so that it rests when the
// knee errs: the bone takes up the error and gives it back within some frames.
#pragma once

#include <cstdint>
#include <vector>

#include "moglow/foot_gate.h"

namespace marey::moglow {

/// What the chart knows of the body whatever the frame. Lengths in centimetres.
struct BoneChart {
  std::vector<int64_t> parents;  ///< -1 for joint 0 alone, parents first
  std::vector<int64_t> feet;     ///< contact joints
  std::vector<int64_t> knees;    ///< of each foot, as kneesOf says
  torch::Tensor lengths;         ///< [J]: reference bone lengths, which say what has a direction
  torch::Tensor axes;            ///< [J, 3]: mean bone directions, unit
  torch::Tensor sides;           ///< [J, 3]: unit vectors at right angles to `axes`
};

/// The joint between each foot and its hip, or -1 where the skeleton has none: bones shorter than a
/// millimetre bend no leg, and of two feet on one knee the first bends it.
std::vector<int64_t> kneesOf(const std::vector<int64_t>& parents, const std::vector<int64_t>& feet,
                             const torch::Tensor& lengths);

/// Where a frame is foreseen, from history and control alone; centimetres, one frame of reference.
struct Foreseen {
  torch::Tensor pose;     ///< [N, J, 3]: where the body goes if no foot is held
  torch::Tensor last;     ///< [N, feet, 3]: where the feet stood
  torch::Tensor places;   ///< [N, feet, 3]: where the held feet stand now
  torch::Tensor hold;     ///< [N, feet]: 0 (foreseen place) .. 1 (last place)
  torch::Tensor lengths;  ///< [N, J]: of the bones that end in the joints
};

/// From where feet stood to where they are foreseen without hold, [N, feet, 3].
torch::Tensor wayOf(const BoneChart& chart, const Foreseen& foreseen);

/// What is foreseen of each foot in a frame, beside its place.
struct FootGate {
  torch::Tensor foreseen;  ///< [N, feet, 2]: cm, the foot's (q1, q2) without hold
  torch::Tensor knee;      ///< [N, feet]: cm, the knee's q2 without hold
  torch::Tensor skew;      ///< [N, feet]: -1 .. 1, how much far movements go the foreseen way
  torch::Tensor radii;     ///< [N, feet, kGateKnots]: cm
  /// The knee's q2 and the foot's u3 are divided by the scale, squeezed where large; the scale is
  /// slope * (distance of the foot from its gate's centre + slack).
  torch::Tensor kneeSlope, boneSlope;  ///< [N, feet]
  torch::Tensor slack;                 ///< [N, feet]: cm
};

struct Charted {
  torch::Tensor value;   ///< [N, J, 3]
  torch::Tensor logDet;  ///< [N]
};

/// Chart coordinates without gates [N, J, 3] of poses [N, J, 3]; feet as any other joint.
torch::Tensor chartCoordinates(const BoneChart& chart, const torch::Tensor& pose,
                               const Foreseen& foreseen);

/// The same with feet and knees through their gates, and back.
Charted toChart(const BoneChart& chart, const torch::Tensor& pose, const Foreseen& foreseen,
                const FootGate& gate);
torch::Tensor fromChart(const BoneChart& chart, const torch::Tensor& value,
                        const Foreseen& foreseen, const FootGate& gate);

/// Feet in their charts, [N, feet, 3]: where they are, where they would be had they stayed, and
/// the ways of their gates.
struct FootPlaces {
  torch::Tensor now, before, way;
};
/// What is left of feet's third coordinates [..., 3] beyond their bones and their hold, for feet at
/// a distance from their gates' centres.
torch::Tensor footExcess(const torch::Tensor& now, const torch::Tensor& before,
                         const torch::Tensor& length, const torch::Tensor& hold,
                         const torch::Tensor& distance);

FootPlaces footPlaces(const BoneChart& chart, const torch::Tensor& pose, const Foreseen& foreseen);

/// The centres of feet's gates [..., 2] for feet that had stood at `before` [..., 3] in their
/// charts, and the shifts of their circles [..., 2] for a way in the chart [..., 3].
torch::Tensor gateCentre(const torch::Tensor& hold, const torch::Tensor& foreseen,
                         const torch::Tensor& before);
torch::Tensor gateShift(const torch::Tensor& skew, const torch::Tensor& way);

/// 0 .. 1: hardly anything unless a foot is held firmly.
torch::Tensor firmness(const torch::Tensor& hold);

}  // namespace marey::moglow
