#include "moglow/bone_chart.h"

#include <algorithm>

namespace marey::moglow {
namespace {

constexpr double kTail = 8.0;  ///< beyond this many scales the warp is close to linear

torch::Tensor unit(const torch::Tensor& v) {
  return v / v.norm(2, -1, true).clamp_min(1e-6);
}

/// F' v for frames [N, 3, 3] and vectors [N, 3].
torch::Tensor intoFrame(const torch::Tensor& frame, const torch::Tensor& v) {
  return (frame * v.unsqueeze(-1)).sum(-2);
}
torch::Tensor outOfFrame(const torch::Tensor& frame, const torch::Tensor& v) {
  return (frame * v.unsqueeze(-2)).sum(-1);
}

torch::Tensor warp(const torch::Tensor& r) {
  return torch::asinh(r) + r / kTail;
}
torch::Tensor warpSlope(const torch::Tensor& r) {
  return (r.square() + 1.0).rsqrt() + 1.0 / kTail;
}

/// Newton's method from 0: the warp is increasing and concave, so it never overshoots.
torch::Tensor unwarp(const torch::Tensor& w) {
  const auto target = w.to(torch::kFloat64);
  auto r = torch::zeros_like(target);
  for (int i = 0; i < 40; ++i) r = r + (target - warp(r)) / warpSlope(r);
  return r.to(w.scalar_type());
}

/// Height of a bone of length L above the foot of its chart; 0 where (q1, q2) is too long.
torch::Tensor rise(const torch::Tensor& length, const torch::Tensor& q) {
  return (length.square() - q.square().sum(-1)).clamp_min(0.0).sqrt();
}

int64_t footIndex(const BoneChart& chart, int64_t joint) {
  const auto it = std::find(chart.feet.begin(), chart.feet.end(), joint);
  return it == chart.feet.end() ? -1 : it - chart.feet.begin();
}

/// Frame of a joint, and for a foot the place [N, 2] it is held to (before the gate's hold).
struct JointChart {
  torch::Tensor frame, place;
};
JointChart jointChart(const BoneChart& chart, int64_t joint, const torch::Tensor& parentNow,
                      const torch::Tensor& foreseen, const torch::Tensor& last, bool foot) {
  const int64_t parent = chart.parents[static_cast<size_t>(joint)];
  JointChart out{
      chartFrame(chart, joint, unit(foreseen.select(1, joint) - foreseen.select(1, parent))), {}};
  if (foot)
    out.place =
        chartPlace(out.frame, unit(last.select(1, joint) - parentNow), chart.lengths[joint]);
  return out;
}

}  // namespace

torch::Tensor chartFrame(const BoneChart& chart, int64_t joint, const torch::Tensor& n) {
  // The side axis carried from the mean direction m to n by the shortest arc, made orthonormal.
  const auto m = chart.axes[joint], side = chart.sides[joint];
  const auto cosine = (n * m).sum(-1, true), along = (n * side).sum(-1, true);
  auto p = side - along / (1.0 + cosine).clamp_min(1e-2) * (m + n);
  p = unit(p - (p * n).sum(-1, true) * n);
  return torch::stack({p, torch::cross(n, p, -1), n}, -1);
}

torch::Tensor chartPlace(const torch::Tensor& frame, const torch::Tensor& direction,
                         const torch::Tensor& length) {
  const auto local = intoFrame(frame, direction);
  const auto flat = local.narrow(-1, 0, 2);
  // A direction behind the chart is put on its rim.
  const auto behind = local.narrow(-1, 2, 1) < 0.0;
  return torch::where(behind, unit(flat), flat) * length;
}

Charted toChart(const BoneChart& chart, const torch::Tensor& pose, const torch::Tensor& foreseen,
                const torch::Tensor& last, const FootGate& gate) {
  std::vector<torch::Tensor> values;
  auto logDet = torch::zeros({pose.size(0)}, pose.options());
  for (int64_t j = 0; j < pose.size(1); ++j) {
    const int64_t parent = chart.parents[static_cast<size_t>(j)], foot = footIndex(chart, j);
    if (parent < 0) {
      values.push_back(pose.select(1, j) - foreseen.select(1, j));
      continue;
    }
    const auto joint = jointChart(chart, j, pose.select(1, parent), foreseen, last, foot >= 0);
    const auto q = intoFrame(joint.frame, pose.select(1, j) - pose.select(1, parent));
    auto flat = q.narrow(-1, 0, 2);
    const auto excess = q.select(-1, 2) - rise(chart.lengths[j], flat);
    if (foot >= 0) {
      const auto scale = gate.scale.narrow(1, foot, 1);
      const auto offset = (flat - gate.hold.narrow(1, foot, 1) * joint.place) / scale;
      const auto r = offset.norm(2, -1).clamp_min(1e-6), w = warp(r);
      flat = offset * (w / r).unsqueeze(-1);
      logDet = logDet - 2.0 * scale.squeeze(-1).log() + (w / r).log() + warpSlope(r).log();
    }
    values.push_back(torch::cat({flat, excess.unsqueeze(-1)}, -1));
  }
  return {torch::stack(values, 1), logDet};
}

torch::Tensor fromChart(const BoneChart& chart, const torch::Tensor& value,
                        const torch::Tensor& foreseen, const torch::Tensor& last,
                        const FootGate& gate) {
  std::vector<torch::Tensor> joints;
  for (int64_t j = 0; j < value.size(1); ++j) {
    const int64_t parent = chart.parents[static_cast<size_t>(j)], foot = footIndex(chart, j);
    if (parent < 0) {
      joints.push_back(value.select(1, j) + foreseen.select(1, j));
      continue;
    }
    const auto& parentNow = joints[static_cast<size_t>(parent)];
    const auto joint = jointChart(chart, j, parentNow, foreseen, last, foot >= 0);
    auto flat = value.select(1, j).narrow(-1, 0, 2);
    if (foot >= 0) {
      const auto w = flat.norm(2, -1).clamp_min(1e-6);
      flat = flat * (unwarp(w) / w).unsqueeze(-1) * gate.scale.narrow(1, foot, 1) +
             gate.hold.narrow(1, foot, 1) * joint.place;
    }
    const auto height = value.select(1, j).select(-1, 2) + rise(chart.lengths[j], flat);
    joints.push_back(parentNow +
                     outOfFrame(joint.frame, torch::cat({flat, height.unsqueeze(-1)}, -1)));
  }
  return torch::stack(joints, 1);
}

}  // namespace marey::moglow
