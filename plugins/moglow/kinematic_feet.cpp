#include "moglow/kinematic_feet.h"

#include "moglow/base_constants.h"
#include "moglow/clusters.h"

namespace marey::moglow {

KinematicFeet::KinematicFeet(const Config& c, const KinematicBody& body, const BufferMaker& buffer)
    : m_clusters(c.footClusters) {
  m_centres = buffer("foot_centres", torch::zeros({m_clusters, kFootFeatures}));
  m_hold = buffer("foot_hold", torch::zeros({m_clusters}));
  m_skew = buffer("foot_skew", torch::zeros({m_clusters}));
  m_radii = buffer("foot_radii",
                   torch::arange(1, kGateKnots + 1, torch::kFloat32).repeat({m_clusters, 1}));
  m_kneeSlope = buffer("knee_slope", torch::ones({m_clusters}));
  m_boneSlope = buffer("bone_slope", torch::ones({m_clusters}));
  m_slack = buffer("slack", torch::ones({m_clusters}));
  const auto feet = static_cast<int64_t>(body.feet().size());
  m_floor = buffer("foot_floor", torch::full({feet}, -1e3));
  m_slowMovement = buffer("slow_movement", torch::full({}, 0.3));
  m_reach = buffer("reach", torch::full({feet}, 1e3));
}

torch::Tensor KinematicFeet::clustersOf(const KinematicBody& body, const Past& past) const {
  std::vector<torch::Tensor> out;
  for (size_t f = 0; f < body.feet().size(); ++f)
    out.push_back(nearest(footFeatures(body, past, f, m_slowMovement), m_centres));
  return torch::stack(out, 1);
}

namespace {

/// What was foreseen for a body of the trained size, for one of another.
Foreseen resized(const Foreseen& trained, const Past& past) {
  const auto size = past.size.unsqueeze(-1);
  return {.pose = trained.pose * size,
          .last = trained.last * size,
          .places = trained.places * size,
          .hold = trained.hold,
          .lengths = past.lengths};
}

}  // namespace

Foreseen KinematicFeet::foreseen(const KinematicBody& body, const Past& past,
                                 const torch::Tensor& pose, const torch::Tensor& clusters) const {
  Foreseen out{.pose = pose,
               .last = past.poses.select(1, 0).index_select(1, jointIndex(body.feet(), past.poses)),
               .places = {},
               .hold = {},
               .lengths = {}};
  const auto feet = jointIndex(body.feet(), out.pose);
  const auto hips = out.pose.index_select(1, jointIndex(body.hips(), out.pose));
  const auto excess = ((out.last - hips).norm(2, -1) - m_reach).clamp_min(0.0);
  // A foot out of reach has to come along.
  out.hold = m_hold.index({clusters}) * (-(excess / kStretch).square()).exp();
  const auto places =
      out.last + (1.0 - out.hold).unsqueeze(-1) * (out.pose.index_select(1, feet) - out.last);
  const auto height = torch::maximum(places.select(-1, 1), m_floor);
  out.places = torch::stack({places.select(-1, 0), height, places.select(-1, 2)}, -1);
  // A body that is about to go out of reach of the feet that it stands on stays with them.
  const auto way = out.places - hips;
  const auto pull = (excess.clamp_max(kStretch) * firmness(out.hold)).unsqueeze(-1) * way /
                    way.norm(2, -1, true).clamp_min(1e-3);
  out.pose = out.pose + pull.sum(1, true);
  return resized(out, past);
}

FootGate KinematicFeet::gate(const KinematicBody& body, const Past& past,
                             const torch::Tensor& clusters, const torch::Tensor& predicted) const {
  const auto joints = predicted.view({predicted.size(0), -1, 3});
  const auto places = joints.index_select(1, jointIndex(body.feet(), predicted));
  return {.foreseen = places.narrow(-1, 0, 2),
          .knee = joints.index_select(1, jointIndex(body.knees(), predicted)).select(-1, 1),
          .skew = m_skew.index({clusters}),
          .radii = m_radii.index({clusters}) * footScales(body, past).unsqueeze(-1),
          .kneeSlope = m_kneeSlope.index({clusters}),
          .boneSlope = m_boneSlope.index({clusters}),
          .slack = m_slack.index({clusters})};
}

}  // namespace marey::moglow
