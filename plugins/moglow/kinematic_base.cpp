#include "moglow/kinematic_base.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "moglow/base_constants.h"

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

torch::Tensor nearest(const torch::Tensor& features, const torch::Tensor& centres) {
  return std::get<1>(torch::cdist(features, centres).min(1));
}

/// Rows of `value` times the matrix of each row's regime (matrices [K, R, C]).
torch::Tensor byRegime(const torch::Tensor& value, const torch::Tensor& matrices,
                       const torch::Tensor& regime) {
  if (value.size(0) <= 64)
    return torch::bmm(value.unsqueeze(1), matrices.index_select(0, regime)).squeeze(1);
  auto out = torch::empty({value.size(0), matrices.size(2)}, value.options());
  const auto present = std::get<0>(torch::_unique(regime.to(torch::kCPU)));
  for (int64_t i = 0; i < present.size(0); ++i) {
    const int64_t k = present[i].item<int64_t>();
    const auto rows = regime.eq(k).nonzero().squeeze(1);
    out.index_copy_(0, rows, value.index_select(0, rows).matmul(matrices[k]));
  }
  return out;
}

/// The pose's coordinates with the first two of every foot in front.
torch::Tensor feetFirst(const std::vector<int64_t>& feet, int64_t poseDim) {
  std::vector<int64_t> order, rest(static_cast<size_t>(poseDim));
  std::iota(rest.begin(), rest.end(), 0);
  for (const int64_t foot : feet)
    for (int64_t i = 3 * foot; i < 3 * foot + 2; ++i) {
      order.push_back(i);
      std::erase(rest, i);
    }
  order.insert(order.end(), rest.begin(), rest.end());
  return torch::tensor(order, torch::kInt64);
}

/// Two bones above a foot, or as far up as the skeleton goes.
int64_t hipOf(const std::vector<int64_t>& parents, int64_t foot) {
  for (int bones = 0; bones < 2 && parents[static_cast<size_t>(foot)] >= 0; ++bones)
    foot = parents[static_cast<size_t>(foot)];
  return foot;
}

torch::Tensor jointIndex(const std::vector<int64_t>& joints, const torch::Tensor& like) {
  return torch::tensor(joints, torch::kInt64).to(like.device());
}

}  // namespace

KinematicBase::KinematicBase(const Config& c, const BodyFacts& body) : m_config(c) {
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
  m_order = feetFirst(m_feet, c.poseDim);
  m_orderBack = m_order.argsort();
  m_predictable = register_buffer("predictable", torch::ones({c.poseDim}));

  const int64_t d = c.poseDim, joints = d / 3, contacts = static_cast<int64_t>(m_contacts.size());
  const int64_t plain = d * c.baseOrder + 3 * c.baseOrder,
                rich = plain + 2 * contacts * (c.baseOrder - 1);
  const auto facts = [&](const char* name, const std::vector<float>& values, int64_t size,
                         float fallback) {
    return register_buffer(name,
                           values.empty() ? torch::full({size}, fallback) : torch::tensor(values));
  };
  const auto zeros = [&](const char* name, std::vector<int64_t> shape) {
    return register_buffer(name, torch::zeros(at::IntArrayRef(shape)));
  };
  m_poseMean = facts("pose_mean", body.poseMean, d, 0.f);
  m_poseStd = facts("pose_std", body.poseStd, d, 1.f);
  m_controlMean = facts("control_mean", body.controlMean, 3, 0.f);
  m_controlStd = facts("control_std", body.controlStd, 3, 1.f);
  m_lengths = zeros("bone_lengths", {joints});
  m_axes = zeros("bone_axes", {joints, 3});
  m_chartSides = zeros("bone_sides", {joints, 3});
  m_foreseenMean = zeros("foreseen_mean", {plain});
  m_foreseenWeight = zeros("foreseen_weight", {plain, d});
  m_foreseenBias = zeros("foreseen_bias", {d});
  m_footCentres = zeros("foot_centres", {c.footClusters, kFootFeatures});
  m_footHold = zeros("foot_hold", {c.footClusters});
  m_footSkew = zeros("foot_skew", {c.footClusters});
  m_footRadii = register_buffer(
      "foot_radii", torch::arange(1, kGateKnots + 1, torch::kFloat32).repeat({c.footClusters, 1}));
  m_kneeSlope = register_buffer("knee_slope", torch::ones({c.footClusters}));
  m_boneSlope = register_buffer("bone_slope", torch::ones({c.footClusters}));
  m_slack = register_buffer("slack", torch::ones({c.footClusters}));
  const auto feet = static_cast<int64_t>(m_feet.size());
  m_footFloor = register_buffer("foot_floor", torch::full({feet}, -1e3));
  m_slowMovement = register_buffer("slow_movement", torch::full({}, 0.3));
  m_reach = register_buffer("reach", torch::full({feet}, 1e3));
  m_regimeCentres =
      zeros("regime_centres",
            {c.regimes, 3 * contacts + contacts + 2 * static_cast<int64_t>(m_feet.size()) + 4});
  m_richMean = zeros("rich_mean", {rich});
  m_richWeight = zeros("rich_weight", {c.regimes, rich + 1, d});
  m_factor = register_buffer("factor", torch::eye(d).repeat({c.regimes, 1, 1}));
  m_factorInverse = register_buffer("factor_inverse", torch::eye(d).repeat({c.regimes, 1, 1}));
  m_factorLogDet = zeros("factor_log_det", {c.regimes});
  m_netMean = zeros("net_mean", {rich});
  m_netProjection = zeros("net_projection", {rich, c.netFeatures});
  m_speedScale = register_buffer("speed_scale", torch::ones({2 * contacts * (c.baseOrder - 1)}));
  m_controlScale = register_buffer("control_scale", torch::ones({3 * c.baseOrder}));
}

BoneChart KinematicBase::chart() const {
  return {m_parents, m_feet, kneesOf(m_parents, m_feet, m_lengths),
          m_lengths, m_axes, m_chartSides};
}

torch::Tensor KinematicBase::toCentimetres(const torch::Tensor& pose) const {
  return ((pose * m_poseStd + m_poseMean) * 100.0).view({-1, m_config.poseDim / 3, 3});
}

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
  return {moved, torch::cat(controls, -1)};
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

torch::Tensor KinematicBase::foreseenPose(const Past& past) const {
  const auto step = (regressors(past) - m_foreseenMean).matmul(m_foreseenWeight) + m_foreseenBias;
  return past.poses.select(1, 0) + step.view({step.size(0), -1, 3});
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
  const auto track = past.poses.index_select(2, jointIndex(m_feet, past.poses))
                         .index({Slice(), Slice(), Slice(), Slice(0, 3, 2)});
  const auto one = (track.select(1, 0) - track.select(1, 1)).norm(2, -1);
  const auto two = (track.select(1, 0) - track.select(1, 2)).norm(2, -1) / 2.0;
  const auto speed = torch::minimum(one, two);
  return torch::minimum(0.06 + 0.45 * speed, 0.9 + 0.02 * speed);
}

torch::Tensor KinematicBase::footClusters(const Past& past) const {
  std::vector<torch::Tensor> out;
  for (size_t f = 0; f < m_feet.size(); ++f)
    out.push_back(nearest(footFeatures(past, f), m_footCentres));
  return torch::stack(out, 1);
}

Foreseen KinematicBase::foreseenOn(const Past& past, const torch::Tensor& clusters) const {
  Foreseen out{.pose = foreseenPose(past),
               .last = past.poses.select(1, 0).index_select(1, jointIndex(m_feet, past.poses)),
               .places = {},
               .hold = {}};
  const auto feet = jointIndex(m_feet, out.pose);
  const auto hips = out.pose.index_select(1, jointIndex(m_hips, out.pose));
  const auto excess = ((out.last - hips).norm(2, -1) - m_reach).clamp_min(0.0);
  // A foot out of reach has to come along.
  out.hold = m_footHold.index({clusters}) * (-(excess / kStretch).square()).exp();
  const auto places =
      out.last + (1.0 - out.hold).unsqueeze(-1) * (out.pose.index_select(1, feet) - out.last);
  const auto height = torch::maximum(places.select(-1, 1), m_footFloor);
  out.places = torch::stack({places.select(-1, 0), height, places.select(-1, 2)}, -1);
  // A body that is about to go out of reach of the feet that it stands on stays with them.
  const auto way = out.places - hips;
  const auto pull = (excess.clamp_max(kStretch) * firmness(out.hold)).unsqueeze(-1) * way /
                    way.norm(2, -1, true).clamp_min(1e-3);
  out.pose = out.pose + pull.sum(1, true);
  return out;
}

FootGate KinematicBase::gateOf(const Past& past, const torch::Tensor& clusters,
                               const torch::Tensor& predicted) const {
  const auto joints = predicted.view({predicted.size(0), -1, 3});
  const auto places = joints.index_select(1, jointIndex(m_feet, predicted));
  std::vector<int64_t> knees;
  for (const int64_t foot : m_feet) knees.push_back(m_parents[static_cast<size_t>(foot)]);
  return {.foreseen = places.narrow(-1, 0, 2),
          .knee = joints.index_select(1, jointIndex(knees, predicted)).select(-1, 1),
          .skew = m_footSkew.index({clusters}),
          .radii = m_footRadii.index({clusters}) * footScales(past).unsqueeze(-1),
          .kneeSlope = m_kneeSlope.index({clusters}),
          .boneSlope = m_boneSlope.index({clusters}),
          .slack = m_slack.index({clusters})};
}

torch::Tensor KinematicBase::predictedChart(const torch::Tensor& rich,
                                            const torch::Tensor& regime) const {
  const auto ones = torch::ones({rich.size(0), 1}, rich.options());
  return byRegime(torch::cat({rich - m_richMean, ones}, 1), m_richWeight, regime);
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

torch::Tensor KinematicBase::regimeOf(const Past& past) const {
  return nearest(regimeFeatures(past), m_regimeCentres);
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

Foresight KinematicBase::foresee(const BaseInput& input) const {
  const torch::NoGradGuard guard;  // nothing here is trained
  const Past past = pastOf(input);
  const auto rich = richRegressors(past);
  const auto regime = regimeOf(past);
  const auto predicted = predictedChart(rich, regime);
  const auto clusters = footClusters(past);
  const Foreseen foreseen = foreseenOn(past, clusters);
  const FootGate gate = gateOf(past, clusters, predicted);
  return {netFeatures(past, rich),
          {predicted * m_predictable, regime, foreseen.pose, foreseen.last, foreseen.places,
           foreseen.hold, gate.foreseen, gate.knee, gate.skew, gate.radii, gate.kneeSlope,
           gate.boneSlope, gate.slack}};
}

Foreseen KinematicBase::foreseenIn(const Parts& parts) const {
  return {.pose = parts[2], .last = parts[3], .places = parts[4], .hold = parts[5]};
}

FootGate KinematicBase::gateIn(const Parts& parts) {
  return {parts[6], parts[7], parts[8], parts[9], parts[10], parts[11], parts[12]};
}

PoseBase::Innovation KinematicBase::toInnovation(const torch::Tensor& pose,
                                                 const Foresight& foresight) const {
  const auto& f = foresight.parts;
  const auto local = toChart(chart(), toCentimetres(pose), foreseenIn(f), gateIn(f));
  const auto residual = (local.value.flatten(1) - f[0]).index_select(1, m_order.to(pose.device()));
  // Density of standardised poses, not of centimetres.
  const auto units = m_poseStd.log().sum() + m_config.poseDim * std::log(100.0);
  return {byRegime(residual, m_factorInverse.transpose(1, 2), f[1]),
          local.logDet + m_factorLogDet.index_select(0, f[1]) + units};
}

torch::Tensor KinematicBase::toPose(const torch::Tensor& innovation,
                                    const Foresight& foresight) const {
  const auto& f = foresight.parts;
  const auto residual = byRegime(innovation, m_factor.transpose(1, 2), f[1])
                            .index_select(1, m_orderBack.to(innovation.device()));
  const auto local = (residual + f[0]).view({innovation.size(0), -1, 3});
  const auto pose = fromChart(chart(), local, foreseenIn(f), gateIn(f));
  return (pose.flatten(1) / 100.0 - m_poseMean) / m_poseStd;
}

}  // namespace marey::moglow
