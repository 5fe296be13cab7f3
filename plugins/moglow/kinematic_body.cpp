#include "moglow/kinematic_body.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "moglow/base_constants.h"

namespace marey::moglow {
namespace {

/// Two bones above a foot, or as far up as the skeleton goes.
int64_t hipOf(const std::vector<int64_t>& parents, int64_t foot) {
  for (int bones = 0; bones < 2 && parents[static_cast<size_t>(foot)] >= 0; ++bones)
    foot = parents[static_cast<size_t>(foot)];
  return foot;
}

/// Turns the floor coordinates of joints [N, K, J, 3] into a root frame that moved by (sideways,
/// forward) and then turned, control [N, 3].
torch::Tensor intoNextFrame(const torch::Tensor& joints, const torch::Tensor& control) {
  const auto at = [&](int64_t i) { return control.select(-1, i).view({-1, 1, 1}); };
  const auto x = joints.select(-1, 0) - at(0), z = joints.select(-1, 2) - at(1);
  const auto c = at(2).cos(), s = at(2).sin();
  return torch::stack({c * x - s * z, joints.select(-1, 1), s * x + c * z}, -1);
}

}  // namespace

torch::Tensor jointIndex(const std::vector<int64_t>& joints, const torch::Tensor& like) {
  return torch::tensor(joints, torch::kInt64).to(like.device());
}

KinematicBody::KinematicBody(const Config& c, const BodyFacts& body, const BufferMaker& buffer)
    : m_order(c.baseOrder),
      m_poseDim(c.poseDim),
      m_tau(c.tau),
      m_lengthsOfHistory(c.boneLengths == "history") {
  const Place place{.path = "kinematic base"};
  if (body.parents.empty() || body.feet.empty())
    throw InputError(place, "a skeleton with feet", "none");
  if (static_cast<int>(body.parents.size()) * 3 != c.poseDim || c.controlDim != 3)
    throwInput(place, "joint positions and a path as control",
               "{} pose and {} control values for {} joints", c.poseDim, c.controlDim,
               body.parents.size());
  m_parents.assign(body.parents.begin(), body.parents.end());
  m_feet.assign(body.feet.begin(), body.feet.end());
  m_toes.assign(body.toes.begin(), body.toes.end());
  for (size_t f = 0; f < m_feet.size(); ++f) {
    m_contacts.push_back(m_feet[f]);
    m_contacts.push_back(m_toes[f]);
    m_hips.push_back(hipOf(m_parents, m_feet[f]));
    m_sides.push_back(f % 2 == 0 ? 1.f : -1.f);
  }
  const int64_t joints = m_poseDim / 3;
  const auto facts = [&](const char* name, const std::vector<float>& values, int64_t size,
                         float fallback) {
    return buffer(name, values.empty() ? torch::full({size}, fallback) : torch::tensor(values));
  };
  m_poseMean = facts("pose_mean", body.poseMean, m_poseDim, 0.f);
  m_poseStd = facts("pose_std", body.poseStd, m_poseDim, 1.f);
  m_controlMean = facts("control_mean", body.controlMean, 3, 0.f);
  m_controlStd = facts("control_std", body.controlStd, 3, 1.f);
  m_lengths = buffer("bone_lengths", torch::zeros({joints}));
  m_axes = buffer("bone_axes", torch::zeros({joints, 3}));
  m_chartSides = buffer("bone_sides", torch::zeros({joints, 3}));
  m_predictable = buffer("predictable", torch::ones({m_poseDim}));
}

torch::Tensor KinematicBody::toCentimetres(const torch::Tensor& pose) const {
  return ((pose * m_poseStd + m_poseMean) * 100.0).view({-1, m_poseDim / 3, 3});
}

torch::Tensor KinematicBody::toStandard(const torch::Tensor& pose) const {
  return (pose.flatten(1) / 100.0 - m_poseMean) / m_poseStd;
}

torch::Tensor KinematicBody::logDeterminant() const {
  return m_poseStd.log().sum() + static_cast<double>(m_poseDim) * std::log(100.0);
}

double KinematicBody::leastNoise(const torch::Tensor& noise) const {
  return 100.0 * (noise * m_poseStd).min().item<double>();
}

BoneChart KinematicBody::chart() const {
  return {m_parents, m_feet, kneesOf(m_parents, m_feet, m_lengths),
          m_lengths, m_axes, m_chartSides};
}

std::vector<int64_t> KinematicBody::knees() const {
  std::vector<int64_t> out;
  for (const int64_t foot : m_feet) out.push_back(m_parents[static_cast<size_t>(foot)]);
  return out;
}

Past KinematicBody::pastOf(const BaseInput& input) const {
  const auto n = input.history.size(0);
  const auto toCm = torch::tensor({100.0, 100.0, 1.0}, input.control.options());
  const auto control = (input.control.view({n, -1, 3}) * m_controlStd + m_controlMean) * toCm;
  const auto history = ((input.history.view({n, m_tau, -1}) * m_poseStd + m_poseMean) * 100.0)
                           .view({n, m_tau, -1, 3});
  std::vector<torch::Tensor> controls;
  // Oldest first: each step moves everything gathered so far one frame on.
  torch::Tensor moved;
  for (int64_t lag = m_order; lag >= 1; --lag) {
    const auto pose = history.narrow(1, m_tau - lag, 1);
    moved = moved.defined() ? torch::cat({pose, moved}, 1) : pose;
    moved = intoNextFrame(moved, control.select(1, m_tau - lag + 1));
  }
  for (int64_t lag = 0; lag < m_order; ++lag) controls.push_back(control.select(1, m_tau - lag));
  return metBy(moved, torch::cat(controls, -1));
}

/// The lengths and the size of the body, and its past shrunk to the trained one.
Past KinematicBody::metBy(const torch::Tensor& poses, const torch::Tensor& control) const {
  const auto n = poses.size(0);
  Past out{poses, control, m_lengths.expand({n, -1}), torch::ones({n, 1}, poses.options())};
  if (!m_lengthsOfHistory) return out;
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

void KinematicBody::fitChart(const torch::Tensor& pose) {
  std::vector<int64_t> parents;
  for (const int64_t p : m_parents) parents.push_back(std::max<int64_t>(p, 0));
  const auto bones = pose - pose.index_select(1, torch::tensor(parents).to(pose.device()));
  m_lengths.copy_(bones.norm(2, -1).mean(0));
  auto axes = bones.mean(0);
  axes[0] = torch::tensor({0.f, 1.f, 0.f}).to(axes.options());
  // A bone of no length, or one that points everywhere, has no direction of its own: take up.
  const auto size = axes.norm(2, -1, true);
  axes =
      torch::where(size > 1e-3, axes / size.clamp_min(1e-3), axes[0].unsqueeze(0).expand_as(axes));
  const auto alongX = axes.select(1, 0).abs().lt(0.9).unsqueeze(1);
  const auto fixed = torch::where(alongX, torch::tensor({{1.f, 0.f, 0.f}}).to(axes.options()),
                                  torch::tensor({{0.f, 1.f, 0.f}}).to(axes.options()));
  auto sides = fixed - (fixed * axes).sum(-1, true) * axes;
  m_axes.copy_(axes);
  m_chartSides.copy_(sides / sides.norm(2, -1, true));
  // A foot's coordinates and its knee's second leave their gates centred.
  m_predictable.fill_(1.0);
  for (const int64_t foot : m_feet) m_predictable.narrow(0, 3 * foot, 3).zero_();
  for (const int64_t knee : chart().knees)
    if (knee >= 0) m_predictable[3 * knee + 1] = 0.0;
}

}  // namespace marey::moglow
