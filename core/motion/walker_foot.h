// The path of one foot through stance, push-off, swing and landing.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "motion/walker_plan.h"

namespace marey::walker {

/// Ankle and toe joints of a flat foot: heights above the floor and distance apart, metres.
constexpr double kAnkleHeightM = 0.085;
constexpr double kToeHeightM = 0.020;
constexpr double kFootLengthM = 0.150;

struct FootPose {
  Eigen::Vector3d ankle, toe;  ///< world, metres
  double yaw = 0.0;            ///< heading of the foot
  double pitch = 0.0;          ///< about its left axis; positive: heel up
};

/// One foot as a function of time. While it stands, ankle and toe are the same bits.
class FootTrack {
 public:
  FootTrack(const Placement& start, const std::vector<Step>& steps);

  FootPose at(double timeS) const;
  /// Times at which the ankle stands, within [0, endS].
  std::vector<Contact> contacts(int ankleJoint, double endS) const;

 private:
  Placement m_start;
  std::vector<Step> m_steps;
};

}  // namespace marey::walker
