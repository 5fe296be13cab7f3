// Where and when the walker steps: footfalls planned on the path ahead of it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "motion/features.h"
#include "motion/walker.h"

namespace marey::walker {

constexpr int kLeft = 0;
constexpr int kRight = 1;
/// How far the path is continued beyond its ends, so that a clip begins and ends in mid-gait.
constexpr double kMarginS = 3.0;

/// Velocity of the root in its own frame: metres per second and radians per second.
struct BodyVelocity {
  double side = 0.0, forward = 0.0, turn = 0.0;
  double speed() const;
};

/// The path as a function of time; beyond its ends it goes on at its end velocities.
class PathCurve {
 public:
  PathCurve(const std::vector<RootFrame>& frames, double fps);

  RootFrame at(double timeS) const;
  /// Mean velocity over [fromS, toS], in the frame at fromS.
  BodyVelocity velocity(double fromS, double toS) const;
  double endS() const { return m_endS; }  ///< time of the last given frame

 private:
  std::vector<RootFrame> m_frames;
  double m_fps;
  double m_beginS;
  double m_endS;
};

/// Where a foot stands: its ankle on the floor and its direction.
struct Placement {
  double x = 0.0, z = 0.0, yaw = 0.0;
};

/// One step of one foot. The heel leaves the floor at liftS while the toe stays until toeOffS;
/// the ankle stands again from landS, the toe from flatS.
struct Step {
  int foot = kLeft;
  double liftS = 0.0, toeOffS = 0.0, landS = 0.0, flatS = 0.0;
  Placement from, to;
  double pushPitch = 0.0;  ///< radians at toe-off, heel up
  double landPitch = 0.0;  ///< radians at landing, negative: toes up
  double heightM = 0.0;    ///< extra clearance in mid-swing
  bool continued = false;  ///< follows the other foot's step without a rest between
};

struct StepPlan {
  std::array<Placement, 2> start;          ///< where the feet stand before their first step
  std::array<std::vector<Step>, 2> steps;  ///< of the left and right foot, in time order
};

/// A style with the variation of one clip drawn.
struct Gait {
  WalkerStyle style;
  double toeOut = 0.1;   ///< radians
  double elbow = 0.28;   ///< radians, resting flexion
  double armOut = 0.12;  ///< radians, abduction
  double tempo = 1.0;    ///< scales swing asymmetry of timing between clips
};
Gait drawGait(const WalkerStyle& style, uint64_t seed);

StepPlan planSteps(const PathCurve& path, const Gait& gait, uint64_t seed);

}  // namespace marey::walker
