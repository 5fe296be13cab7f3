// How often intervals of distances hold the truth: sets are drawn again and again from known
// distributions, in clusters as motions along controls are.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.h"
#include "stats/controls.h"
#include "stats/interval.h"
#include "stats/sample_distance.h"

namespace marey::stats {

/// Values of a joint are normal with mean 0 and standard deviation 1 in natural motion, mean
/// `shift` and standard deviation `scale` in the other set. Half of the variance comes from the
/// control, a fifth from the clip, the rest from the frame; 0.3 of the control's part is that of
/// all joints.
struct CoverageCase {
  int controls = 30;   ///< on either side
  bool paired = true;  ///< both sides follow the same controls
  int joints = 8;      ///< the statistic is the mean of their distances
  int samples = 1;     ///< along every control, of the set that is compared
  int frames = 6;      ///< of a clip
  double shift = 0.5, scale = 1.0;
};

struct Coverage {
  double wasserstein = 0.0, kolmogorov = 0.0;  ///< shares of intervals that hold the truth
};

namespace coverage {

inline double normalShare(double x) {
  return 0.5 * std::erfc(-x / std::sqrt(2.0));
}

/// Distances of N(shift, scale) from N(0, 1), by sums over a fine grid of their distribution
/// functions: the area between them and the largest gap.
inline SampleDistance truth(const CoverageCase& c) {
  SampleDistance out;
  constexpr double kStep = 1e-3;
  for (double x = -12.0; x < 12.0; x += kStep) {
    const double gap = std::abs(normalShare((x - c.shift) / c.scale) - normalShare(x));
    out.wasserstein += kStep * gap;
    out.kolmogorov = std::max(out.kolmogorov, gap);
  }
  return out;
}

/// Draws numbers one after the other.
class Numbers {
 public:
  Numbers(uint64_t seed, uint32_t replication)
      : m_key{.seed = seed, .sample = replication, .stage = RandomStage::Test} {}
  double next() {
    if (m_at == m_values.size()) {
      m_values.resize(4096);
      fillNormal(m_key, m_values);
      ++m_key.frame;
      m_at = 0;
    }
    return m_values[m_at++];
  }

 private:
  RandomKey m_key;
  std::vector<float> m_values;
  size_t m_at = 0;
};

/// values[joint][clip][frame] of one side, whose controls have these effects by joint.
using Side = std::vector<std::vector<std::vector<double>>>;

inline std::vector<std::vector<double>> effects(const CoverageCase& c, Numbers& numbers) {
  std::vector<std::vector<double>> out(static_cast<size_t>(c.joints));
  std::vector<double> common;
  for (int i = 0; i < c.controls; ++i) common.push_back(numbers.next());
  for (auto& joint : out)
    for (const double all : common)
      joint.push_back(std::sqrt(0.5) * (std::sqrt(0.3) * all + std::sqrt(0.7) * numbers.next()));
  return out;
}

inline Side drawn(const CoverageCase& c, int samples, double shift, double scale,
                  const std::vector<std::vector<double>>& effects, Numbers& numbers) {
  Side out(effects.size());
  for (size_t j = 0; j < effects.size(); ++j)
    for (const double effect : effects[j])
      for (int s = 0; s < samples; ++s) {
        const double clip = effect + std::sqrt(0.2) * numbers.next();
        auto& values = out[j].emplace_back();
        for (int f = 0; f < c.frames; ++f)
          values.push_back(shift + scale * (clip + std::sqrt(0.3) * numbers.next()));
      }
  return out;
}

inline std::vector<int> controlsOf(const CoverageCase& c, int samples, int first) {
  std::vector<int> out;
  for (int i = 0; i < c.controls; ++i)
    out.insert(out.end(), static_cast<size_t>(samples), first + i);
  return out;
}

/// Mean distance over joints under weights.
inline SampleDistance meanDistance(const std::vector<PooledSamples>& pools, const Weights& w) {
  SampleDistance out;
  for (const PooledSamples& pool : pools) {
    const SampleDistance one = pool.distance(w.clips, w.natural);
    out.wasserstein += one.wasserstein / static_cast<double>(pools.size());
    out.kolmogorov += one.kolmogorov / static_cast<double>(pools.size());
  }
  return out;
}

}  // namespace coverage

inline Coverage coverageOf(const CoverageCase& c, int replications, int resamples, uint64_t seed) {
  using namespace coverage;
  const SampleDistance known = truth(c);
  const ControlSets sets(controlsOf(c, c.samples, 0), controlsOf(c, 1, c.paired ? 0 : c.controls));
  Coverage out;
  for (int r = 0; r < replications; ++r) {
    Numbers numbers(seed, static_cast<uint32_t>(r));
    const auto own = effects(c, numbers);
    const auto natural = c.paired ? own : effects(c, numbers);
    const Side a = drawn(c, c.samples, c.shift, c.scale, own, numbers);
    const Side b = drawn(c, 1, 0.0, 1.0, natural, numbers);
    std::vector<PooledSamples> pools;
    for (size_t j = 0; j < a.size(); ++j) pools.emplace_back(a[j], b[j]);
    const SampleDistance found = meanDistance(pools, sets.once());
    std::vector<double> wasserstein, kolmogorov;
    for (int i = 0; i < resamples; ++i) {
      const auto again = meanDistance(
          pools, sets.drawn(seed + static_cast<uint64_t>(r) + 1, static_cast<uint32_t>(i)));
      wasserstein.push_back(again.wasserstein);
      kolmogorov.push_back(again.kolmogorov);
    }
    const auto n = static_cast<size_t>(c.controls);
    const auto holds = [&](const Interval& i, double value) {
      return *i.low <= value && value <= *i.high ? 1.0 / replications : 0.0;
    };
    out.wasserstein +=
        holds(distanceInterval(found.wasserstein, wasserstein, n), known.wasserstein);
    out.kolmogorov += holds(distanceInterval(found.kolmogorov, kolmogorov, n), known.kolmogorov);
  }
  return out;
}

}  // namespace marey::stats
