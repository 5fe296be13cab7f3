// The body that the kinematic base speaks of, and its past as the base sees it: in the present root
// frame, in centimetres. Internal (libtorch types).
#pragma once

#include <functional>
#include <vector>

#include "moglow/bone_chart.h"
#include "moglow/pose_base.h"

namespace marey::moglow {

/// Keeps a tensor under a name, as a part of what is stored.
using BufferMaker = std::function<torch::Tensor(const char* name, const torch::Tensor& start)>;

/// Past frames of movement, newest first, in the present root frame, shrunk to the trained body.
struct Past {
  torch::Tensor poses;    ///< [N, order, J, 3], cm
  torch::Tensor control;  ///< [N, 3 * order], newest first; cm, cm, rad
  torch::Tensor lengths;  ///< [N, J], cm: that this frame's bones are foreseen with, not shrunk
  torch::Tensor size;     ///< [N, 1]: of the body, 1 for the trained one
};

class KinematicBody {
 public:
  /// Throws InputError without a skeleton that has feet, or with other than three controls.
  KinematicBody(const Config& config, const BodyFacts& facts, const BufferMaker& buffer);

  torch::Tensor toCentimetres(const torch::Tensor& pose) const;  ///< [N, D] -> [N, J, 3]
  torch::Tensor toStandard(const torch::Tensor& pose) const;     ///< [N, J, 3] -> [N, D]
  /// Of standardised poses by poses in centimetres.
  torch::Tensor logDeterminant() const;
  /// The smallest of noise [D], standardised, in centimetres.
  double leastNoise(const torch::Tensor& noise) const;
  Past pastOf(const BaseInput& input) const;
  BoneChart chart() const;
  /// Bones as they are on average in poses [N, J, 3].
  void fitChart(const torch::Tensor& pose);

  int64_t order() const { return m_order; }  ///< past frames
  int64_t poseDim() const { return m_poseDim; }
  const std::vector<int64_t>& parents() const { return m_parents; }
  const std::vector<int64_t>& feet() const { return m_feet; }
  const std::vector<int64_t>& toes() const { return m_toes; }
  const std::vector<int64_t>& hips() const { return m_hips; }  ///< of each foot
  const std::vector<int64_t>& contacts() const { return m_contacts; }
  std::vector<int64_t> knees() const;  ///< the joint above each foot
  float side(size_t foot) const { return m_sides[foot]; }
  /// [D]: 0 for the coordinates that gates take, 1 for the rest.
  const torch::Tensor& predictable() const { return m_predictable; }

 private:
  Past metBy(const torch::Tensor& poses, const torch::Tensor& control) const;

  int64_t m_order, m_poseDim, m_tau;
  bool m_lengthsOfHistory;
  std::vector<int64_t> m_parents, m_feet, m_toes, m_hips, m_contacts;
  std::vector<float> m_sides;  ///< +1 for a left foot, -1 for a right one
  torch::Tensor m_poseMean, m_poseStd, m_controlMean, m_controlStd;  ///< metres
  torch::Tensor m_lengths, m_axes, m_chartSides;
  torch::Tensor m_predictable;
};

torch::Tensor jointIndex(const std::vector<int64_t>& joints, const torch::Tensor& like);

}  // namespace marey::moglow
