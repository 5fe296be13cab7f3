#include "moglow/bone_chart.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "moglow/base_constants.h"

namespace marey::moglow {
namespace {

/// Present positions [N, 3] of joints that are known already.
using Present = std::function<torch::Tensor(int64_t)>;

torch::Tensor unit(const torch::Tensor& v) {
  return v / v.norm(2, -1, true).clamp_min(1e-6);
}

/// F' v and F v for frames [..., 3, 3] and vectors [..., 3].
torch::Tensor intoFrame(const torch::Tensor& frame, const torch::Tensor& v) {
  return (frame * v.unsqueeze(-1)).sum(-2);
}
torch::Tensor outOfFrame(const torch::Tensor& frame, const torch::Tensor& v) {
  return (frame * v.unsqueeze(-2)).sum(-1);
}

/// Height of a bone of length L above the foot of its chart; 0 where (q1, q2) is too long.
torch::Tensor rise(const torch::Tensor& length, const torch::Tensor& q) {
  return (length.square() - q.square().sum(-1)).clamp_min(0.0).sqrt();
}

torch::Tensor indexOf(const std::vector<int64_t>& joints, const torch::Tensor& like) {
  return torch::tensor(joints, torch::kInt64).to(like.device());
}

std::vector<int64_t> parentsOf(const BoneChart& chart, const std::vector<int64_t>& joints) {
  std::vector<int64_t> out;
  for (const int64_t j : joints) out.push_back(chart.parents[static_cast<size_t>(j)]);
  return out;
}

/// Frames (columns) for bones along unit vectors n [..., 3]: the side axis is carried from the
/// mean direction to n by the shortest arc and made orthonormal.
torch::Tensor framesOf(const torch::Tensor& axes, const torch::Tensor& sides,
                       const torch::Tensor& n) {
  const auto cosine = (n * axes).sum(-1, true), along = (n * sides).sum(-1, true);
  auto p = sides - along / (1.0 + cosine).clamp_min(1e-2) * (axes + n);
  p = unit(p - (p * n).sum(-1, true) * n);
  return torch::stack({p, torch::cross(n, p, -1), n}, -1);
}

/// The frame of a knee of a leg that is bent from a hip so that its foot reaches a place: across
/// the plane of the bend, in that plane, and along the thigh. A place out of reach is aimed at.
torch::Tensor kneeFrame(const BoneChart& chart, int64_t knee, int64_t foot,
                        const torch::Tensor& hip, const torch::Tensor& place,
                        const torch::Tensor& foreseenThigh, const torch::Tensor& lengths) {
  const auto thigh = lengths.narrow(1, knee, 1), shin = lengths.narrow(1, foot, 1);
  const auto far = (place - hip).norm(2, -1, true).clamp_min(1e-3);
  const auto axis = (place - hip) / far;
  const auto d =
      torch::minimum(torch::maximum(far, (thigh - shin).abs() + 1e-2), kStraight * (thigh + shin));
  const auto along = (thigh.square() - shin.square() + d.square()) / (2.0 * d);
  const auto across = (thigh.square() - along.square()).clamp_min(0.0).sqrt();
  // The side of a straight leg is that of the chart.
  const auto towards = foreseenThigh + 1e-3 * chart.sides[knee];
  const auto bend = unit(towards - (towards * axis).sum(-1, true) * axis);
  const auto n = unit(along * axis + across * bend), p = unit(torch::cross(axis, bend, -1));
  return torch::stack({p, torch::cross(n, p, -1), n}, -1);
}

struct Limb {
  int64_t foot = -1, knee = -1;  ///< index of the foot, its knee's joint
};

/// The limb that a joint is the foot or the knee of.
Limb limbOf(const BoneChart& chart, int64_t joint) {
  for (size_t f = 0; f < chart.feet.size(); ++f) {
    const int64_t knee = chart.knees[f];
    if (knee >= 0 && (joint == knee || joint == chart.feet[f]))
      return {static_cast<int64_t>(f), knee};
  }
  return {};
}

/// Frames [N, K, 3, 3] of joints, given where their parents are now.
torch::Tensor framesAt(const BoneChart& chart, const std::vector<int64_t>& joints,
                       const Foreseen& foreseen, const Present& present) {
  const auto& pose = foreseen.pose;
  const auto own = indexOf(joints, pose);
  const auto bones =
      pose.index_select(1, own) - pose.index_select(1, indexOf(parentsOf(chart, joints), pose));
  const auto axes = chart.axes.index_select(0, own), sides = chart.sides.index_select(0, own);
  const auto directionless = chart.lengths.index_select(0, own).lt(kShortest).view({1, -1, 1});
  auto frames = framesOf(axes, sides, torch::where(directionless, axes, unit(bones))).unbind(1);
  for (size_t k = 0; k < joints.size(); ++k) {
    const Limb limb = limbOf(chart, joints[k]);
    if (limb.foot < 0) continue;
    const auto place = foreseen.places.select(1, limb.foot);
    const auto from = present(chart.parents[static_cast<size_t>(joints[k])]);
    const auto column = static_cast<int64_t>(k);
    frames[k] = joints[k] == limb.knee
                    ? kneeFrame(chart, limb.knee, chart.feet[static_cast<size_t>(limb.foot)], from,
                                place, bones.select(1, column), foreseen.lengths)
                    : framesOf(axes[column], sides[column], unit(place - from));
  }
  return torch::stack(frames, 1);
}

/// Joints by distance from the root: a level's parents are all in earlier ones.
std::vector<std::vector<int64_t>> levelsOf(const BoneChart& chart) {
  std::vector<size_t> depth(chart.parents.size(), 0);
  for (size_t j = 0; j < depth.size(); ++j)
    if (chart.parents[j] >= 0) depth[j] = depth[static_cast<size_t>(chart.parents[j])] + 1;
  std::vector<std::vector<int64_t>> out(*std::max_element(depth.begin(), depth.end()));
  for (size_t j = 0; j < depth.size(); ++j)
    if (depth[j] > 0) out[depth[j] - 1].push_back(static_cast<int64_t>(j));
  return out;
}

Gate footGate(const FootGate& gate, int64_t foot, const torch::Tensor& way) {
  return {gate.radii.select(1, foot), gateShift(gate.skew.select(1, foot), way)};
}

torch::Tensor kneeCentre(const Foreseen& foreseen, const FootGate& gate, int64_t foot) {
  return (1.0 - firmness(foreseen.hold.select(1, foot))) * gate.knee.select(1, foot);
}

/// Distance of a foot from its gate's centre, for its gated value [N, 2].
torch::Tensor gateDistanceAt(const FootGate& gate, int64_t foot, const torch::Tensor& gated) {
  return gateRadius(gate.radii.select(1, foot), gated.norm(2, -1));
}

torch::Tensor scaleAt(const torch::Tensor& slope, const FootGate& gate, int64_t foot,
                      const torch::Tensor& distance) {
  return (slope.select(1, foot) * (distance + gate.slack.select(1, foot))).clamp_min(kFinest);
}

/// x / scale [N] up to kTail, logarithmic from there: what is far out, as in the frame in which a
/// foot leaves, is merely improbable.
Charted squeezed(const torch::Tensor& x, const torch::Tensor& scale) {
  const auto r = x / scale, far = r.abs().clamp_min(kTail) / kTail;
  return {torch::where(r.abs() < kTail, r, r.sign() * kTail * (1.0 + far.log())),
          -far.log() - scale.log()};
}

torch::Tensor unsqueezed(const torch::Tensor& w, const torch::Tensor& scale) {
  const auto far = kTail * (w.abs().clamp_min(kTail) / kTail - 1.0).exp();
  return torch::where(w.abs() < kTail, w, w.sign() * far) * scale;
}

/// How much of a foot's third coordinate is that of its last place.
torch::Tensor holdAlong(const torch::Tensor& hold, const torch::Tensor& distance) {
  return kBoneMemory * firmness(hold) / (1.0 + (distance / kResting).square());
}

/// A joint's chart coordinates [N, 3] with a knee or a foot freed from its gate; what is left of
/// the third is beyond `rise`.
torch::Tensor released(const BoneChart& chart, int64_t joint, const torch::Tensor& value,
                       const torch::Tensor& frame, const torch::Tensor& parent,
                       const Foreseen& foreseen, const torch::Tensor& ways, const FootGate& gate) {
  const auto own = value.select(1, joint);
  const auto it = std::find(chart.feet.begin(), chart.feet.end(), joint);
  if (it == chart.feet.end()) {
    const Limb limb = limbOf(chart, joint);
    if (limb.foot < 0) return own;
    const auto gated = value.select(1, chart.feet[static_cast<size_t>(limb.foot)]).narrow(-1, 0, 2);
    const auto scale =
        scaleAt(gate.kneeSlope, gate, limb.foot, gateDistanceAt(gate, limb.foot, gated));
    const auto inPlane =
        unsqueezed(own.select(-1, 1), scale) + kneeCentre(foreseen, gate, limb.foot);
    return torch::stack({own.select(-1, 0), inPlane, own.select(-1, 2)}, -1);
  }
  const int64_t foot = it - chart.feet.begin();
  const auto before = intoFrame(frame, foreseen.last.select(1, foot) - parent);
  const auto way = intoFrame(frame, ways.select(1, foot));
  const auto hold = foreseen.hold.select(1, foot);
  const auto flat = backThroughGate(footGate(gate, foot, way), own.narrow(-1, 0, 2)) +
                    gateCentre(hold, gate.foreseen.select(1, foot), before);
  const auto distance = gateDistanceAt(gate, foot, own.narrow(-1, 0, 2));
  const auto above = before.select(-1, 2) - rise(foreseen.lengths.select(1, joint), flat);
  const auto along = unsqueezed(own.select(-1, 2), scaleAt(gate.boneSlope, gate, foot, distance)) +
                     holdAlong(hold, distance) * above;
  return torch::cat({flat, along.unsqueeze(-1)}, -1);
}

}  // namespace

std::vector<int64_t> kneesOf(const std::vector<int64_t>& parents, const std::vector<int64_t>& feet,
                             const torch::Tensor& lengths) {
  const auto bends = [&](int64_t joint) { return lengths[joint].item<double>() >= kShortest; };
  std::vector<int64_t> out;
  for (const int64_t foot : feet) {
    const int64_t knee = parents[static_cast<size_t>(foot)];
    const bool leg = knee >= 0 && parents[static_cast<size_t>(knee)] >= 0 && bends(knee) &&
                     bends(foot) && std::find(out.begin(), out.end(), knee) == out.end();
    out.push_back(leg ? knee : -1);
  }
  return out;
}

torch::Tensor wayOf(const BoneChart& chart, const Foreseen& foreseen) {
  return foreseen.pose.index_select(1, indexOf(chart.feet, foreseen.pose)) - foreseen.last;
}

torch::Tensor firmness(const torch::Tensor& hold) {
  return hold.pow(4);
}

torch::Tensor gateCentre(const torch::Tensor& hold, const torch::Tensor& foreseen,
                         const torch::Tensor& before) {
  const auto h = hold.unsqueeze(-1);
  return h * before.narrow(-1, 0, 2) + (1.0 - h) * foreseen;
}

torch::Tensor gateShift(const torch::Tensor& skew, const torch::Tensor& way) {
  const auto flat = way.narrow(-1, 0, 2);
  // A way of no length has no direction.
  return skew.unsqueeze(-1) * flat / (flat.norm(2, -1, true) + 0.05);
}

torch::Tensor footExcess(const torch::Tensor& now, const torch::Tensor& before,
                         const torch::Tensor& length, const torch::Tensor& hold,
                         const torch::Tensor& distance) {
  const auto height = rise(length, now.narrow(-1, 0, 2));
  return now.select(-1, 2) - height - holdAlong(hold, distance) * (before.select(-1, 2) - height);
}

FootPlaces footPlaces(const BoneChart& chart, const torch::Tensor& pose, const Foreseen& foreseen) {
  const auto feet = indexOf(chart.feet, pose);
  const auto parents = pose.index_select(1, indexOf(parentsOf(chart, chart.feet), pose));
  const auto frames =
      framesAt(chart, chart.feet, foreseen, [&](int64_t j) { return pose.select(1, j); });
  return {intoFrame(frames, pose.index_select(1, feet) - parents),
          intoFrame(frames, foreseen.last - parents), intoFrame(frames, wayOf(chart, foreseen))};
}

torch::Tensor chartCoordinates(const BoneChart& chart, const torch::Tensor& pose,
                               const Foreseen& foreseen) {
  std::vector<int64_t> joints;
  for (int64_t j = 1; j < pose.size(1); ++j) joints.push_back(j);
  const auto own = indexOf(joints, pose), parents = indexOf(parentsOf(chart, joints), pose);
  const auto frames =
      framesAt(chart, joints, foreseen, [&](int64_t j) { return pose.select(1, j); });
  const auto q = intoFrame(frames, pose.index_select(1, own) - pose.index_select(1, parents));
  const auto flat = q.narrow(-1, 0, 2);
  const auto excess =
      q.narrow(-1, 2, 1) - rise(foreseen.lengths.index_select(1, own), flat).unsqueeze(-1);
  return torch::cat(
      {(pose.narrow(1, 0, 1) - foreseen.pose.narrow(1, 0, 1)), torch::cat({flat, excess}, -1)}, 1);
}

Charted toChart(const BoneChart& chart, const torch::Tensor& pose, const Foreseen& foreseen,
                const FootGate& gate) {
  auto joints = chartCoordinates(chart, pose, foreseen).unbind(1);
  const auto places = footPlaces(chart, pose, foreseen);
  auto logDet = torch::zeros({pose.size(0)}, pose.options());
  for (size_t f = 0; f < chart.feet.size(); ++f) {
    const auto foot = static_cast<int64_t>(f);
    const auto now = places.now.select(1, foot), before = places.before.select(1, foot);
    const auto hold = foreseen.hold.select(1, foot), flat = now.narrow(-1, 0, 2);
    const auto gated = throughGate(footGate(gate, foot, places.way.select(1, foot)),
                                   flat - gateCentre(hold, gate.foreseen.select(1, foot), before));
    const auto distance = gateDistanceAt(gate, foot, gated.value);
    const auto excess =
        footExcess(now, before, foreseen.lengths.select(1, chart.feet[f]), hold, distance);
    const auto along = squeezed(excess, scaleAt(gate.boneSlope, gate, foot, distance));
    joints[static_cast<size_t>(chart.feet[f])] =
        torch::cat({gated.value, along.value.unsqueeze(-1)}, -1);
    logDet = logDet + gated.logDet + along.logDet;
    const int64_t knee = chart.knees[f];
    if (knee < 0) continue;
    auto& bent = joints[static_cast<size_t>(knee)];
    const auto inPlane = squeezed(bent.select(-1, 1) - kneeCentre(foreseen, gate, foot),
                                  scaleAt(gate.kneeSlope, gate, foot, distance));
    bent = torch::stack({bent.select(-1, 0), inPlane.value, bent.select(-1, 2)}, -1);
    logDet = logDet + inPlane.logDet;
  }
  return {torch::stack(joints, 1), logDet};
}

torch::Tensor fromChart(const BoneChart& chart, const torch::Tensor& value,
                        const Foreseen& foreseen, const FootGate& gate) {
  std::vector<torch::Tensor> joints(static_cast<size_t>(value.size(1)));
  joints[0] = value.select(1, 0) + foreseen.pose.select(1, 0);
  const auto present = [&](int64_t j) { return joints[static_cast<size_t>(j)]; };
  const auto ways = wayOf(chart, foreseen);
  for (const auto& level : levelsOf(chart)) {
    const auto frames = framesAt(chart, level, foreseen, present);
    std::vector<torch::Tensor> parents, freed;
    for (size_t k = 0; k < level.size(); ++k) {
      parents.push_back(present(chart.parents[static_cast<size_t>(level[k])]));
      freed.push_back(released(chart, level[k], value, frames.select(1, static_cast<int64_t>(k)),
                               parents.back(), foreseen, ways, gate));
    }
    const auto local = torch::stack(freed, 1), flat = local.narrow(-1, 0, 2);
    const auto lengths = foreseen.lengths.index_select(1, indexOf(level, value));
    const auto height = local.narrow(-1, 2, 1) + rise(lengths, flat).unsqueeze(-1);
    const auto now =
        (torch::stack(parents, 1) + outOfFrame(frames, torch::cat({flat, height}, -1))).unbind(1);
    for (size_t k = 0; k < level.size(); ++k) joints[static_cast<size_t>(level[k])] = now[k];
  }
  return torch::stack(joints, 1);
}

}  // namespace marey::moglow
