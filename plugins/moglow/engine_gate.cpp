#include "moglow/engine_gate.h"

#include <algorithm>
#include <cmath>

namespace marey::moglow {
namespace {

/// The segment of a piecewise linear function through the origin; the last one goes on for ever.
struct Segment {
  double start, slope, rho;
};

Segment segmentAt(const GateRadii& radii, int index) {
  const int at = std::clamp(index, 0, kGateKnots - 1);
  const double start = at == 0 ? 0.0 : radii[static_cast<size_t>(at) - 1];
  return {start, (radii[static_cast<size_t>(at)] - start) / kGateStep, at * kGateStep};
}

double gateDistance(const Eigen::Vector2d& offset, const Eigen::Vector2d& shift) {
  const double along = offset.dot(shift), rest = 1.0 - shift.squaredNorm(),
               square = offset.squaredNorm(),
               root = std::sqrt(std::max(along * along + rest * square, 1e-24));
  // Of the two equal forms of the root, the one that does not cancel.
  return along > 0.0 ? square / std::max(root + along, 1e-12) : (root - along) / rest;
}

}  // namespace

std::pair<Eigen::Vector2d, double> throughGate(const GateRadii& radii, const Eigen::Vector2d& shift,
                                               const Eigen::Vector2d& offset) {
  const double s = std::max(gateDistance(offset, shift), 1e-9);
  const Eigen::Vector2d towards = offset / s - shift,
                        direction = towards / std::max(towards.norm(), 1e-9);
  const auto below = std::count_if(radii.begin(), radii.end(), [&](double r) { return r <= s; });
  const Segment segment = segmentAt(radii, static_cast<int>(below));
  const double rho = segment.rho + (s - segment.start) / segment.slope;
  const double logDet = std::log(rho / s) - std::log(segment.slope) -
                        std::log(std::max(1.0 + direction.dot(shift), 1e-6));
  return {direction * rho, logDet};
}

double gateRadius(const GateRadii& radii, double rho) {
  // Capped before it becomes whole: what is far out is beyond the last knot.
  const double index = std::min(std::floor(rho / kGateStep), static_cast<double>(kGateKnots));
  const Segment segment = segmentAt(radii, static_cast<int>(index));
  return segment.start + (rho - segment.rho) * segment.slope;
}

Eigen::Vector2d backThroughGate(const GateRadii& radii, const Eigen::Vector2d& shift,
                                const Eigen::Vector2d& value) {
  const double rho = std::max(value.norm(), 1e-9);
  return gateRadius(radii, rho) * (value / rho + shift);
}

}  // namespace marey::moglow
