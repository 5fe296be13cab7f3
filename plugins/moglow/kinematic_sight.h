// What the coupling nets see of the past: principal components of the regressors, speeds, control
// and heights of feet. Internal (libtorch types).
#pragma once

#include "moglow/kinematic_features.h"

namespace marey::moglow {

class KinematicSight {
 public:
  KinematicSight(const Config& config, const KinematicBody& body, int64_t rich,
                 const BufferMaker& buffer);
  /// `rich`: richRegressors of the past.
  torch::Tensor see(const KinematicBody& body, const Past& past, const torch::Tensor& rich) const;
  void fit(const torch::Tensor& richRegressors);

 private:
  int64_t m_features;
  torch::Tensor m_mean, m_projection, m_speedScale, m_controlScale;
};

}  // namespace marey::moglow
