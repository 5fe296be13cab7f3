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

#include "moglow/kinematic_feet.h"
#include "moglow/kinematic_regressions.h"
#include "moglow/kinematic_sight.h"

namespace marey::moglow {

class KinematicBase : public PoseBase {
 public:
  /// Throws InputError without a skeleton that has feet, or with other than three controls.
  KinematicBase(const Config& config, const BodyFacts& body);
  Foresight foresee(const BaseInput& input) const override;
  Innovation toInnovation(const torch::Tensor& pose, const Foresight& foresight) const override;
  torch::Tensor toPose(const torch::Tensor& innovation, const Foresight& foresight) const override;
  void fit(const torch::Tensor& poses, const BaseInput& input, const torch::Tensor& noise) override;

 private:
  BufferMaker keeper();

  KinematicBody m_body;
  StepRegression m_step;
  KinematicFeet m_feet;
  RegimeRegressions m_regimes;
  KinematicSight m_sight;
};

}  // namespace marey::moglow
