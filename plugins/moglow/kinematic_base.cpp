#include "moglow/kinematic_base.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "moglow/base_constants.h"

namespace marey::moglow {
namespace {

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

torch::Tensor KinematicBase::foreseenPose(const Past& past) const {
  const auto step = (regressors(past) - m_foreseenMean).matmul(m_foreseenWeight) + m_foreseenBias;
  return past.poses.select(1, 0) + step.view({step.size(0), -1, 3});
}

torch::Tensor KinematicBase::footClusters(const Past& past) const {
  std::vector<torch::Tensor> out;
  for (size_t f = 0; f < m_feet.size(); ++f)
    out.push_back(nearest(footFeatures(past, f), m_footCentres));
  return torch::stack(out, 1);
}

namespace {

/// What was foreseen for a body of the trained size, for one of another.
Foreseen resized(const Foreseen& trained, const KinematicBase::Past& past) {
  const auto size = past.size.unsqueeze(-1);
  return {.pose = trained.pose * size,
          .last = trained.last * size,
          .places = trained.places * size,
          .hold = trained.hold,
          .lengths = past.lengths};
}

}  // namespace

Foreseen KinematicBase::foreseenOn(const Past& past, const torch::Tensor& clusters) const {
  Foreseen out{.pose = foreseenPose(past),
               .last = past.poses.select(1, 0).index_select(1, jointIndex(m_feet, past.poses)),
               .places = {},
               .hold = {},
               .lengths = {}};
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
  return resized(out, past);
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

torch::Tensor KinematicBase::predictedChart(const Past& past, const torch::Tensor& rich,
                                            const torch::Tensor& regime) const {
  const auto ones = torch::ones({rich.size(0), 1}, rich.options());
  return byRegime(torch::cat({rich - m_richMean, ones}, 1), m_richWeight, regime) * past.size;
}

torch::Tensor KinematicBase::regimeOf(const Past& past) const {
  return nearest(regimeFeatures(past), m_regimeCentres);
}

Foresight KinematicBase::foresee(const BaseInput& input) const {
  const torch::NoGradGuard guard;  // nothing here is trained
  const Past past = pastOf(input);
  const auto rich = richRegressors(past);
  const auto regime = regimeOf(past);
  const auto predicted = predictedChart(past, rich, regime);
  const auto clusters = footClusters(past);
  const Foreseen foreseen = foreseenOn(past, clusters);
  const FootGate gate = gateOf(past, clusters, predicted);
  return {netFeatures(past, rich),
          {predicted * m_predictable, regime, foreseen.pose, foreseen.last, foreseen.places,
           foreseen.hold, gate.foreseen, gate.knee, gate.skew, gate.radii, gate.kneeSlope,
           gate.boneSlope, gate.slack, foreseen.lengths}};
}

Foreseen KinematicBase::foreseenIn(const Parts& parts) const {
  return {.pose = parts[2],
          .last = parts[3],
          .places = parts[4],
          .hold = parts[5],
          .lengths = parts[13]};
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
