// The chart of bone_chart.h and the gates of foot_gate.h for one pose, in double precision: what
// the engine's kinematic base runs. See there for the mathematics. Lengths are centimetres. No
// libtorch type appears here.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "moglow/engine_base.h"

namespace marey::moglow {

class EngineChart {
 public:
  /// What the chart knows of the body whatever the frame, per joint.
  struct Body {
    std::vector<int> parents;  ///< -1 for joint 0 alone, parents first
    std::vector<int> feet;
    std::vector<double> lengths;  ///< reference ones, which say what has a direction
    std::vector<Eigen::Vector3d> axes, sides;
  };
  explicit EngineChart(Body body);

  /// Chart coordinates [3 J] of a pose; the log-determinant.
  double toChart(const RowForesight& seen, std::span<const Eigen::Vector3d> pose,
                 std::span<double> value) const;
  void fromChart(const RowForesight& seen, std::span<const double> value,
                 std::span<Eigen::Vector3d> pose) const;

 private:
  /// What a joint is to a leg that bends; the foot's index, or -1.
  struct Limb {
    int foot = -1;
    bool knee = false;
  };
  Eigen::Matrix3d frameAt(const RowForesight& seen, int joint,
                          std::span<const Eigen::Vector3d> present) const;
  Eigen::Matrix3d kneeFrame(const RowForesight& seen, int knee, int foot,
                            const Eigen::Vector3d& hip, const Eigen::Vector3d& place,
                            const Eigen::Vector3d& thigh) const;
  Eigen::Matrix3d frameAlong(int joint, const Eigen::Vector3d& direction) const;
  double gateFoot(const RowForesight& seen, size_t foot, std::span<const Eigen::Vector3d> pose,
                  std::span<double> value) const;
  /// A joint's chart coordinates, freed from gates.
  Eigen::Vector3d released(const RowForesight& seen, int joint, std::span<const double> value,
                           const Eigen::Matrix3d& frame, const Eigen::Vector3d& parent) const;

  Body m_body;
  std::vector<int> m_knees;      ///< of each foot, or -1: kneesOf in bone_chart.h
  std::vector<Limb> m_limbs;     ///< of each joint
  std::vector<int> m_footIndex;  ///< of each joint, or -1
};

}  // namespace marey::moglow
