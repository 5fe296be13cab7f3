// Smooth random signals of the walker: independent of the frame rate.
#pragma once

#include <cstdint>
#include <vector>

namespace marey::walker {

/// A stationary normal signal of unit variance and one correlation time: normal values on knots
/// `timeScaleS` apart, joined by a uniform cubic B-spline (twice differentiable).
class SmoothNoise {
 public:
  /// `channel` keeps the signals of one seed apart. Covers [beginS, endS].
  SmoothNoise(uint64_t seed, uint32_t channel, double timeScaleS, double beginS, double endS);
  double at(double timeS) const;

 private:
  double m_beginS;
  double m_timeScaleS;
  std::vector<float> m_knots;
};

}  // namespace marey::walker
