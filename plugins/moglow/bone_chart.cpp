#include "moglow/bone_chart.h"

#include <algorithm>

namespace marey::moglow {
namespace {

constexpr double kTail = 8.0;      ///< beyond this many scales the warp is close to linear
constexpr int kNewtonRounds = 14;  ///< from the tangent at 0; 1e-12 for any |w| < 1e3

torch::Tensor unit(const torch::Tensor& v) {
  return v / v.norm(2, -1, true).clamp_min(1e-6);
}

/// F' v and F v for frames [N, K, 3, 3] and vectors [N, K, 3].
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

/// Newton's method: the warp is increasing and concave, so it never overshoots.
torch::Tensor unwarp(const torch::Tensor& w) {
  const auto target = w.to(torch::kFloat64);
  auto r = target / (1.0 + 1.0 / kTail);
  for (int i = 0; i < kNewtonRounds; ++i) r = r + (target - warp(r)) / warpSlope(r);
  return r.to(w.scalar_type());
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

/// Frames [N, K, 3, 3] (columns) of joints for foreseen bones along unit vectors n [N, K, 3]: the
/// side axis is carried from the mean direction to n by the shortest arc and made orthonormal.
torch::Tensor framesOf(const BoneChart& chart, const torch::Tensor& joints,
                       const torch::Tensor& n) {
  const auto m = chart.axes.index_select(0, joints), side = chart.sides.index_select(0, joints);
  const auto cosine = (n * m).sum(-1, true), along = (n * side).sum(-1, true);
  auto p = side - along / (1.0 + cosine).clamp_min(1e-2) * (m + n);
  p = unit(p - (p * n).sum(-1, true) * n);
  return torch::stack({p, torch::cross(n, p, -1), n}, -1);
}

/// Chart coordinates of a unit direction, times length; a direction behind the chart is put on
/// its rim.
torch::Tensor placeOf(const torch::Tensor& frame, const torch::Tensor& direction,
                      const torch::Tensor& length) {
  const auto local = intoFrame(frame, direction);
  const auto flat = local.narrow(-1, 0, 2);
  return torch::where(local.narrow(-1, 2, 1) < 0.0, unit(flat), flat) * length.unsqueeze(-1);
}

torch::Tensor foreseenFrames(const BoneChart& chart, const std::vector<int64_t>& joints,
                             const torch::Tensor& foreseen) {
  const auto own = indexOf(joints, foreseen), parents = indexOf(parentsOf(chart, joints), foreseen);
  return framesOf(chart, own,
                  unit(foreseen.index_select(1, own) - foreseen.index_select(1, parents)));
}

/// Joints by distance from the root: a level's parents are all in earlier ones.
std::vector<std::vector<int64_t>> levelsOf(const BoneChart& chart) {
  std::vector<size_t> depth(chart.parents.size(), 0);
  std::vector<std::vector<int64_t>> out;
  for (size_t j = 0; j < depth.size(); ++j) {
    if (chart.parents[j] < 0) continue;
    depth[j] = depth[static_cast<size_t>(chart.parents[j])] + 1;
    if (out.size() < depth[j]) out.resize(depth[j]);
    out[depth[j] - 1].push_back(static_cast<int64_t>(j));
  }
  return out;
}

/// The flat coordinates of one level's joints with the feet among them freed from their gates.
torch::Tensor released(const BoneChart& chart, const std::vector<int64_t>& level,
                       torch::Tensor flat, const torch::Tensor& frames,
                       const torch::Tensor& parentsNow, const torch::Tensor& last,
                       const FootGate& gate) {
  std::vector<torch::Tensor> columns = flat.unbind(1);
  for (size_t k = 0; k < level.size(); ++k) {
    const auto it = std::find(chart.feet.begin(), chart.feet.end(), level[k]);
    if (it == chart.feet.end()) continue;
    const int64_t foot = it - chart.feet.begin(), column = static_cast<int64_t>(k);
    const auto place = placeOf(frames.select(1, column),
                               unit(last.select(1, level[k]) - parentsNow.select(1, column)),
                               chart.lengths[level[k]]);
    const auto w = columns[k].norm(2, -1).clamp_min(1e-6);
    columns[k] = columns[k] * (unwarp(w) / w).unsqueeze(-1) * gate.scale.narrow(1, foot, 1) +
                 gate.hold.narrow(1, foot, 1) * place;
  }
  return torch::stack(columns, 1);
}

}  // namespace

FootPlaces footPlaces(const BoneChart& chart, const torch::Tensor& pose,
                      const torch::Tensor& foreseen, const torch::Tensor& last) {
  const auto feet = indexOf(chart.feet, pose),
             parents = indexOf(parentsOf(chart, chart.feet), pose);
  const auto frames = foreseenFrames(chart, chart.feet, foreseen);
  const auto parentsNow = pose.index_select(1, parents);
  return {intoFrame(frames, pose.index_select(1, feet) - parentsNow).narrow(-1, 0, 2),
          placeOf(frames, unit(last.index_select(1, feet) - parentsNow),
                  chart.lengths.index_select(0, feet))};
}

Charted toChart(const BoneChart& chart, const torch::Tensor& pose, const torch::Tensor& foreseen,
                const torch::Tensor& last, const FootGate& gate) {
  std::vector<int64_t> joints;
  for (int64_t j = 1; j < pose.size(1); ++j) joints.push_back(j);
  const auto own = indexOf(joints, pose), parents = indexOf(parentsOf(chart, joints), pose);
  const auto q = intoFrame(foreseenFrames(chart, joints, foreseen),
                           pose.index_select(1, own) - pose.index_select(1, parents));
  const auto flat = q.narrow(-1, 0, 2);
  const auto excess =
      q.narrow(-1, 2, 1) - rise(chart.lengths.index_select(0, own), flat).unsqueeze(-1);
  auto value = torch::cat(
      {(pose.narrow(1, 0, 1) - foreseen.narrow(1, 0, 1)), torch::cat({flat, excess}, -1)}, 1);

  const auto places = footPlaces(chart, pose, foreseen, last);
  const auto offset =
      (places.now - gate.hold.unsqueeze(-1) * places.before) / gate.scale.unsqueeze(-1);
  const auto r = offset.norm(2, -1).clamp_min(1e-6), w = warp(r);
  const auto held = torch::cat({offset * (w / r).unsqueeze(-1),
                                value.index_select(1, indexOf(chart.feet, pose)).narrow(-1, 2, 1)},
                               -1);
  const auto logDet = ((w / r).log() + warpSlope(r).log() - 2.0 * gate.scale.log()).sum(-1);
  return {value.index_copy(1, indexOf(chart.feet, pose), held), logDet};
}

torch::Tensor fromChart(const BoneChart& chart, const torch::Tensor& value,
                        const torch::Tensor& foreseen, const torch::Tensor& last,
                        const FootGate& gate) {
  std::vector<torch::Tensor> joints(static_cast<size_t>(value.size(1)));
  joints[0] = value.select(1, 0) + foreseen.select(1, 0);
  for (const auto& level : levelsOf(chart)) {
    std::vector<torch::Tensor> parents;
    for (const int64_t j : parentsOf(chart, level))
      parents.push_back(joints[static_cast<size_t>(j)]);
    const auto parentsNow = torch::stack(parents, 1), own = indexOf(level, value);
    const auto frames = foreseenFrames(chart, level, foreseen);
    const auto local = value.index_select(1, own);
    const auto flat =
        released(chart, level, local.narrow(-1, 0, 2), frames, parentsNow, last, gate);
    const auto height =
        local.narrow(-1, 2, 1) + rise(chart.lengths.index_select(0, own), flat).unsqueeze(-1);
    const auto now = (parentsNow + outOfFrame(frames, torch::cat({flat, height}, -1))).unbind(1);
    for (size_t k = 0; k < level.size(); ++k) joints[static_cast<size_t>(level[k])] = now[k];
  }
  return torch::stack(joints, 1);
}

}  // namespace marey::moglow
