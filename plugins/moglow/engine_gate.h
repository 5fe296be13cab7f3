// The radial gate of foot_gate.h for one foot, in double precision.
#pragma once

#include <utility>

#include <Eigen/Core>

#include "moglow/engine_base.h"

namespace marey::moglow {

using GateRadii = std::array<double, kGateKnots>;

/// Offset from the gate's centre in cm -> normal values and log-determinant, and back.
std::pair<Eigen::Vector2d, double> throughGate(const GateRadii& radii, const Eigen::Vector2d& shift,
                                               const Eigen::Vector2d& offset);
Eigen::Vector2d backThroughGate(const GateRadii& radii, const Eigen::Vector2d& shift,
                                const Eigen::Vector2d& value);
/// Distance from the gate's centre of a radial value rho.
double gateRadius(const GateRadii& radii, double rho);

}  // namespace marey::moglow
