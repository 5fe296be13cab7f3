// Numbers that the kinematic base of training and that of the engine share. No libtorch type
// appears here.
#pragma once

namespace marey::moglow {

// The chart (bone_chart.h).
constexpr double kShortest = 0.1;     ///< cm; a shorter bone has no direction of its own
constexpr double kStraight = 0.9999;  ///< of full reach: a straighter knee has no side
/// Share of its bone's error that a foot held fast keeps from one frame to the next.
constexpr double kBoneMemory = 0.98;
constexpr double kTail = 4.0;     ///< scales beyond which legs' errors are squeezed
constexpr double kFinest = 0.02;  ///< cm, smallest scale of those errors
constexpr double kResting = 0.2;  ///< cm: a foot that goes further from its gate's centre leaves

// The gates (foot_gate.h): radial quantiles are kept at rho = kGateStep, 2 kGateStep, ...,
// kGateKnots * kGateStep.
constexpr int kGateKnots = 9;
constexpr double kGateStep = 0.5;

// The base itself (kinematic_base.h).
constexpr int kFootFeatures = 19;
constexpr double kStretch = 3.0;  ///< cm out of reach that a held foot stands

}  // namespace marey::moglow
