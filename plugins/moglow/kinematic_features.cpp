// What the kinematic base looks at: the past in the present root frame, and the numbers by which
// regimes, gates and nets see it.
#include <algorithm>

#include "moglow/base_constants.h"
#include "moglow/kinematic_base.h"

namespace marey::moglow {
namespace {

using torch::indexing::Slice;

/// Turns the floor coordinates of joints [N, K, J, 3] into a root frame that moved by (sideways,
/// forward) and then turned, control [N, 3].
torch::Tensor intoNextFrame(const torch::Tensor& joints, const torch::Tensor& control) {
  const auto at = [&](int64_t i) { return control.select(-1, i).view({-1, 1, 1}); };
  const auto x = joints.select(-1, 0) - at(0), z = joints.select(-1, 2) - at(1);
  const auto c = at(2).cos(), s = at(2).sin();
  return torch::stack({c * x - s * z, joints.select(-1, 1), s * x + c * z}, -1);
}

/// Keeps the direction of a movement and squeezes its size.
torch::Tensor squeezed(const torch::Tensor& movement, const torch::Tensor& scale) {
  const auto size = movement.norm(2, -1, true).clamp_min(1e-6);
  return movement * (torch::asinh(size / scale) / size);
}

}  // namespace

KinematicBase::Past KinematicBase::pastOf(const BaseInput& input) const {
  const auto n = input.history.size(0);
  const auto toCm = torch::tensor({100.0, 100.0, 1.0}, input.control.options());
  const auto control = (input.control.view({n, -1, 3}) * m_controlStd + m_controlMean) * toCm;
  const auto history =
      ((input.history.view({n, m_config.tau, -1}) * m_poseStd + m_poseMean) * 100.0)
          .view({n, m_config.tau, -1, 3});
  std::vector<torch::Tensor> controls;
  // Oldest first: each step moves everything gathered so far one frame on.
  torch::Tensor moved;
  for (int64_t lag = m_config.baseOrder; lag >= 1; --lag) {
    const auto pose = history.narrow(1, m_config.tau - lag, 1);
    moved = moved.defined() ? torch::cat({pose, moved}, 1) : pose;
    moved = intoNextFrame(moved, control.select(1, m_config.tau - lag + 1));
  }
  for (int64_t lag = 0; lag < m_config.baseOrder; ++lag)
    controls.push_back(control.select(1, m_config.tau - lag));
  return metBy(moved, torch::cat(controls, -1));
}

/// The lengths and the size of the body, and its past shrunk to the trained one.
KinematicBase::Past KinematicBase::metBy(const torch::Tensor& poses,
                                         const torch::Tensor& control) const {
  const auto n = poses.size(0);
  Past out{poses, control, m_lengths.expand({n, -1}), torch::ones({n, 1}, poses.options())};
  if (m_config.boneLengths != "history") return out;
  std::vector<int64_t> parents;
  for (const int64_t p : m_parents) parents.push_back(std::max<int64_t>(p, 0));
  const auto index = torch::tensor(parents, torch::kInt64).to(poses.device());
  const auto mean = (poses - poses.index_select(2, index)).norm(2, -1).mean(1);
  out.lengths = torch::where(m_lengths.lt(kShortest), mean, mean.clamp_min(kShortest));
  const auto trained = m_lengths.sum();
  if (trained.item<double>() < kShortest) return out;
  out.size = out.lengths.sum(1, true) / trained;
  out.poses = poses / out.size.view({n, 1, 1, 1});
  const auto ways = control.view({n, -1, 3}).narrow(2, 0, 2) / out.size.unsqueeze(-1),
             turns = control.view({n, -1, 3}).narrow(2, 2, 1);
  out.control = torch::cat({ways, turns}, -1).flatten(1);
  return out;
}

torch::Tensor KinematicBase::regressors(const Past& past) const {
  std::vector<torch::Tensor> parts{past.poses.select(1, 0).flatten(1)};
  for (int64_t k = 0; k + 1 < m_config.baseOrder; ++k)
    parts.push_back((past.poses.select(1, k) - past.poses.select(1, k + 1)).flatten(1));
  parts.push_back(past.control);
  return torch::cat(parts, -1);
}

torch::Tensor KinematicBase::footSpeeds(const Past& past) const {
  std::vector<torch::Tensor> parts;
  for (int64_t k = 0; k + 1 < m_config.baseOrder; ++k)
    for (const int64_t j : m_contacts) {
      const auto d = (past.poses.select(1, k) - past.poses.select(1, k + 1))
                         .select(1, j)
                         .index({Slice(), Slice(0, 3, 2)});
      const auto r = d.norm(2, -1, true).clamp_min(1e-6);
      parts.push_back(d * (torch::asinh(r / 0.2) + r / 2.0) / r);
    }
  return torch::cat(parts, -1);
}

torch::Tensor KinematicBase::richRegressors(const Past& past) const {
  return torch::cat({regressors(past), footSpeeds(past)}, -1);
}

torch::Tensor KinematicBase::footFeatures(const Past& past, size_t foot) const {
  const auto& p = past.poses;
  const auto side = torch::tensor({m_sides[foot], 1.f}).to(p.options());
  const auto floor = [](const torch::Tensor& v) { return v.index({Slice(), Slice(0, 3, 2)}); };
  const auto movement = [&](int64_t k, int64_t j) {
    return (p.select(1, k) - p.select(1, k + 1)).select(1, j);
  };
  const auto& slow = m_slowMovement;
  const auto now = p.select(1, 0), control = past.control;
  const int64_t ankle = m_feet[foot], toe = m_toes[foot],
                other = m_feet[std::min(foot ^ 1U, m_feet.size() - 1)];
  return torch::cat({squeezed(floor(movement(0, ankle)) * side, slow),
                     squeezed(floor(movement(1, ankle)) * side, slow),
                     squeezed(movement(0, ankle).narrow(1, 1, 1), slow) * 0.7,
                     now.select(1, ankle).narrow(1, 1, 1) * 0.4,
                     squeezed(floor(movement(0, toe)) * side, slow) * 0.7,
                     now.select(1, toe).narrow(1, 1, 1) * 0.25,
                     floor(now.select(1, ankle) - now.select(1, 0)) * side * 0.08,
                     squeezed(floor(movement(0, 0)) * side, slow) * 0.5,
                     // The other foot says when this one may leave, the control whether it has to.
                     squeezed(floor(movement(0, other)) * side, slow) * 0.5,
                     now.select(1, other).narrow(1, 1, 1) * 0.15,
                     squeezed(control.narrow(1, 0, 2) * side, slow) * 0.5,
                     torch::asinh(control.narrow(1, 2, 1) * m_sides[foot] / 0.02) * 0.3},
                    -1);
}

/// Lengths that a foot's radial quantiles are relative to, [N, feet] cm: small for a slow foot.
torch::Tensor KinematicBase::footScales(const Past& past) const {
  const auto track =
      past.poses.index_select(2, torch::tensor(m_feet, torch::kInt64).to(past.poses.device()))
          .index({Slice(), Slice(), Slice(), Slice(0, 3, 2)});
  const auto one = (track.select(1, 0) - track.select(1, 1)).norm(2, -1);
  const auto two = (track.select(1, 0) - track.select(1, 2)).norm(2, -1) / 2.0;
  const auto speed = torch::minimum(one, two);
  return torch::minimum(0.06 + 0.45 * speed, 0.9 + 0.02 * speed);
}

torch::Tensor KinematicBase::regimeFeatures(const Past& past) const {
  const auto now = past.poses.select(1, 0), movement = now - past.poses.select(1, 1);
  std::vector<torch::Tensor> parts;
  for (const int64_t j : m_contacts)
    parts.push_back(squeezed(movement.select(1, j), torch::full({}, 0.5, movement.options())));
  for (const int64_t j : m_contacts) parts.push_back(now.select(1, j).narrow(1, 1, 1) * 0.3);
  for (const int64_t j : m_feet)
    parts.push_back(now.select(1, j).index({Slice(), Slice(0, 3, 2)}) * 0.05);
  parts.push_back(torch::asinh(past.control.narrow(1, 0, 2) / 0.5) * 0.7);
  parts.push_back(torch::asinh(past.control.narrow(1, 2, 1) / 0.02) * 0.5);
  parts.push_back(torch::asinh(movement.norm(2, -1).mean(1, true) / 0.3));
  return torch::cat(parts, -1);
}

torch::Tensor KinematicBase::netFeatures(const Past& past, const torch::Tensor& rich) const {
  const auto centred = rich - m_netMean;
  const int64_t speeds = m_speedScale.size(0), controls = m_controlScale.size(0),
                width = rich.size(1);
  std::vector<torch::Tensor> heights;
  for (const int64_t j : m_contacts)
    heights.push_back((past.poses.select(1, 0).select(1, j).narrow(1, 1, 1) - 10.0) / 5.0);
  return torch::cat({centred.matmul(m_netProjection),
                     centred.narrow(1, width - speeds, speeds) / m_speedScale,
                     centred.narrow(1, width - speeds - controls, controls) / m_controlScale,
                     torch::cat(heights, -1)},
                    -1)
      .clamp(-6.0, 6.0);
}

}  // namespace marey::moglow
