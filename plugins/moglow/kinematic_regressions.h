// The regressions of the kinematic base: one that says where the body goes, and one for each regime
// of movement in the coordinates of its chart, with a covariance of what is left. Internal
// (libtorch types).
#pragma once

#include "moglow/kinematic_features.h"

namespace marey::moglow {

/// Where the body goes if no foot is held: a ridge regression of the next step.
class StepRegression {
 public:
  StepRegression(const Config& config, const BufferMaker& buffer);
  /// [N, J, 3], cm, of a body of the trained size.
  torch::Tensor foreseen(const KinematicBody& body, const Past& past) const;
  /// `pose` [N, J, 3], cm.
  void fit(const KinematicBody& body, const torch::Tensor& pose, const Past& past);

 private:
  double m_ridge;
  torch::Tensor m_mean, m_weight, m_bias;
};

/// Clusters of the movement of feet and control, each with a regression of chart coordinates and a
/// covariance, shrunk towards the common ones.
class RegimeRegressions {
 public:
  RegimeRegressions(const Config& config, const KinematicBody& body, int64_t rich,
                    const BufferMaker& buffer);

  torch::Tensor regimeOf(const KinematicBody& body, const Past& past) const;  ///< int64 [N]
  /// Chart coordinates [N, D]; `rich`: richRegressors of the past.
  torch::Tensor predicted(const Past& past, const torch::Tensor& rich,
                          const torch::Tensor& regime) const;
  struct Whitened {
    torch::Tensor value;   ///< [N, D]
    torch::Tensor logDet;  ///< [N]
  };
  /// What chart coordinates [N, D] differ by from what was predicted <-> innovations.
  Whitened whitened(const torch::Tensor& residual, const torch::Tensor& regime) const;
  torch::Tensor residual(const torch::Tensor& innovation, const torch::Tensor& regime) const;

  /// `local` [N, D]: chart coordinates without gates.
  void fit(const KinematicBody& body, const torch::Tensor& local, const Past& past);
  /// The feet's gated values come first and are normal already: they stay as they are, and the rest
  /// of the body is whitened given them.
  void fitWhitening(const torch::Tensor& residual, const torch::Tensor& regime);

 private:
  torch::Tensor conditionalFactor(const torch::Tensor& covariance) const;

  int64_t m_regimes, m_gated;
  double m_ridge, m_shrinkage, m_floor;
  torch::Tensor m_order;  ///< [D]: feet's held coordinates first
  torch::Tensor m_orderBack;
  torch::Tensor m_centres, m_mean, m_weight, m_factor, m_factorInverse, m_factorLogDet;
};

}  // namespace marey::moglow
