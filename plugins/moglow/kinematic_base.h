// The kinematic base. Against the linear one it adds three things that a linear-Gaussian model
// cannot express and that a network learns slowly:
//
//   1. The history is moved into the present root frame (the control says how), so that a planted
//      foot has not moved.
//   2. The pose is expressed in the coordinates of bone_chart.h: constant bones and planted feet
//      are plain there. How firmly a foot is held, and how far it goes otherwise, are looked up by
//      clusters of its recent movement and its place under the body.
//   3. The rest is a ridge regression with a covariance per regime (clusters of the movement of
//      feet and control), shrunk towards the common one.
//
// Of which body it speaks is a property of the base (Config::boneLengths). With lengths from the
// history, every bone is foreseen as long as it was on average in the frames of the past, the past
// is shrunk to the size of the trained body (the sum of its bones), and what is foreseen of that
// one is made as large as the body at hand. How far a pose strays from what is foreseen stays in
// centimetres: the observation floor is that of a camera, not of a body.
//
// Everything depends on history and control alone, so the layer is exactly invertible and its
// log-determinant is known. Inside, lengths are centimetres.
#pragma once

#include "moglow/bone_chart.h"
#include "moglow/pose_base.h"

namespace marey::moglow {

class KinematicBase : public PoseBase {
 public:
  /// Throws InputError without a skeleton that has feet, or with other than three controls.
  KinematicBase(const Config& config, const BodyFacts& body);
  Foresight foresee(const BaseInput& input) const override;
  Innovation toInnovation(const torch::Tensor& pose, const Foresight& foresight) const override;
  torch::Tensor toPose(const torch::Tensor& innovation, const Foresight& foresight) const override;
  void fit(const torch::Tensor& poses, const BaseInput& input, const torch::Tensor& noise) override;

  /// Past frames of movement, newest first, in the present root frame, shrunk to the trained body.
  struct Past {
    torch::Tensor poses;    ///< [N, order, J, 3], cm
    torch::Tensor control;  ///< [N, 3 * order], newest first; cm, cm, rad
    torch::Tensor lengths;  ///< [N, J], cm: that this frame's bones are foreseen with, not shrunk
    torch::Tensor size;     ///< [N, 1]: of the body, 1 for the trained one
  };

 private:
  Past pastOf(const BaseInput& input) const;
  Past metBy(const torch::Tensor& poses, const torch::Tensor& control) const;
  torch::Tensor toCentimetres(const torch::Tensor& pose) const;  ///< [N, D] -> [N, J, 3]
  torch::Tensor regressors(const Past& past) const;
  torch::Tensor richRegressors(const Past& past) const;
  torch::Tensor footSpeeds(const Past& past) const;
  torch::Tensor footFeatures(const Past& past, size_t foot) const;
  torch::Tensor regimeFeatures(const Past& past) const;
  torch::Tensor regimeOf(const Past& past) const;
  torch::Tensor netFeatures(const Past& past, const torch::Tensor& rich) const;
  torch::Tensor foreseenPose(const Past& past) const;
  torch::Tensor footClusters(const Past& past) const;
  Foreseen foreseenOn(const Past& past, const torch::Tensor& clusters) const;
  FootGate gateOf(const Past& past, const torch::Tensor& clusters,
                  const torch::Tensor& predicted) const;
  torch::Tensor predictedChart(const Past& past, const torch::Tensor& rich,
                               const torch::Tensor& regime) const;
  torch::Tensor footScales(const Past& past) const;
  BoneChart chart() const;
  using Parts = std::vector<torch::Tensor>;  ///< of a Foresight
  Foreseen foreseenIn(const Parts& parts) const;
  static FootGate gateIn(const Parts& parts);

  void fitChart(const torch::Tensor& pose);
  void fitForeseen(const torch::Tensor& pose, const Past& past);
  void fitHold(const torch::Tensor& pose, const Past& past);
  struct Footing;
  /// `floor`: smallest standard deviation of a joint's coordinate, cm; 0: none.
  void fitGate(const Footing& footing, double floor);
  void fitLimits(const torch::Tensor& pose, const Past& past);
  void fitLegs(const torch::Tensor& pose, const Footing& footing, double floor);
  void fitRegimes(const torch::Tensor& local, const Past& past);
  void fitWhitening(const torch::Tensor& residual, const torch::Tensor& regime);
  void fitNetFeatures(const Past& past);

  Config m_config;
  std::vector<int64_t> m_parents, m_feet, m_toes, m_hips, m_contacts;
  std::vector<float> m_sides;  ///< +1 for a left foot, -1 for a right one
  torch::Tensor m_order;       ///< [D]: feet's held coordinates first
  torch::Tensor m_orderBack;
  torch::Tensor m_predictable;  ///< [D]: 0 for those, 1 for the rest
  // Standardiser, in metres.
  torch::Tensor m_poseMean, m_poseStd, m_controlMean, m_controlStd;
  // Chart.
  torch::Tensor m_lengths, m_axes, m_chartSides;
  // Foreseen pose.
  torch::Tensor m_foreseenMean, m_foreseenWeight, m_foreseenBias;
  // Gate: clusters of a foot's movement.
  torch::Tensor m_footCentres, m_footHold, m_footSkew, m_footRadii, m_kneeSlope, m_boneSlope,
      m_slack;
  torch::Tensor m_footFloor, m_reach;  ///< [feet], cm: lowest height, longest way to the hip
  torch::Tensor m_slowMovement;        ///< cm: what counts as slow for a foot in a frame
  // Regimes.
  torch::Tensor m_regimeCentres, m_richMean, m_richWeight, m_factor, m_factorInverse,
      m_factorLogDet;
  // What the nets see.
  torch::Tensor m_netMean, m_netProjection, m_speedScale, m_controlScale;
};

}  // namespace marey::moglow
