#include "motion/walker_noise.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"

namespace marey::walker {
namespace {

/// Standard deviation of a uniform cubic B-spline over independent unit normals, averaged over
/// the phase between two knots: the integral of the squared basis is 151/315.
const double kSplineDeviation = std::sqrt(151.0 / 315.0);

}  // namespace

SmoothNoise::SmoothNoise(uint64_t seed, uint32_t channel, double timeScaleS, double beginS,
                         double endS)
    : m_beginS(beginS), m_timeScaleS(timeScaleS) {
  const double spans = std::ceil(std::max(0.0, endS - beginS) / timeScaleS);
  m_knots.resize(static_cast<size_t>(spans) + 4);
  fillNormal({.seed = seed, .sample = channel, .stage = RandomStage::Walker}, m_knots);
}

double SmoothNoise::at(double timeS) const {
  const double position = std::max(0.0, (timeS - m_beginS) / m_timeScaleS);
  const size_t k = std::min(static_cast<size_t>(position), m_knots.size() - 4);
  const double u = std::min(1.0, position - static_cast<double>(k));
  const double v = 1.0 - u;
  const double w0 = v * v * v / 6.0;
  const double w1 = (3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0;
  const double w2 = (3.0 * v * v * v - 6.0 * v * v + 4.0) / 6.0;
  const double w3 = u * u * u / 6.0;
  const double sum =
      w0 * m_knots[k] + w1 * m_knots[k + 1] + w2 * m_knots[k + 2] + w3 * m_knots[k + 3];
  return sum / kSplineDeviation;
}

}  // namespace marey::walker
