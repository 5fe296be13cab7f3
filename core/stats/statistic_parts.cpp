#include "stats/statistic_parts.h"

#include <algorithm>
#include <cmath>

#include "base/packing.h"
#include "base/quantile.h"
#include "stats/bones.h"
#include "stats/controls.h"
#include "stats/footsteps.h"
#include "stats/sample_distance.h"

namespace marey::stats {
namespace {

int64_t stepOf(double height) {
  return std::llround(height / HeightCounts::kResolutionM);
}

template <typename T>
void addEach(std::vector<T>& to, const std::vector<T>& from) {
  if (to.empty()) to.resize(from.size());
  for (size_t i = 0; i < from.size(); ++i) {
    if constexpr (std::is_arithmetic_v<T>)
      to[i] += from[i];
    else
      to[i].add(from[i]);
  }
}

}  // namespace

void HeightCounts::coarsen() {
  for (const float height : m_exact) ++m_counts[stepOf(height)];
  m_exact = {};
}

void HeightCounts::add(float height) {
  if (!m_counts.empty()) {
    ++m_counts[stepOf(height)];
    return;
  }
  m_exact.push_back(height);
  if (m_exact.size() > kExact) coarsen();
}

void HeightCounts::add(const HeightCounts& other) {
  if (m_counts.empty() && other.m_counts.empty() &&
      m_exact.size() + other.m_exact.size() <= kExact) {
    m_exact.insert(m_exact.end(), other.m_exact.begin(), other.m_exact.end());
    return;
  }
  coarsen();
  for (const float height : other.m_exact) ++m_counts[stepOf(height)];
  for (const auto& [step, count] : other.m_counts) m_counts[step] += count;
}

double HeightCounts::quantile(double share) const {
  if (m_counts.empty()) {
    std::vector<double> sorted(m_exact.begin(), m_exact.end());
    std::sort(sorted.begin(), sorted.end());
    return sortedQuantile(sorted, share);
  }
  int64_t total = 0;
  for (const auto& [step, count] : m_counts) total += count;
  const double position = std::clamp(share, 0.0, 1.0) * static_cast<double>(total - 1);
  int64_t below = 0;
  for (const auto& [step, count] : m_counts)
    if (static_cast<double>(below += count) > position)
      return static_cast<double>(step) * kResolutionM;
  return static_cast<double>(m_counts.rbegin()->first) * kResolutionM;
}

void HeightCounts::pack(Packer& packer) const {
  std::vector<int64_t> steps, counts;
  for (const auto& [step, count] : m_counts) {
    steps.push_back(step);
    counts.push_back(count);
  }
  packer.add(m_exact).add(steps).add(counts);
}

HeightCounts HeightCounts::unpacked(Unpacker& bytes) {
  HeightCounts out;
  out.m_exact = bytes.list<float>();
  const auto steps = bytes.list<int64_t>(), counts = bytes.list<int64_t>();
  for (size_t i = 0; i < std::min(steps.size(), counts.size()); ++i)
    out.m_counts[steps[i]] = counts[i];
  return out;
}

void SetFacts::add(const SetFacts& other) {
  clips += other.clips;
  frames += other.frames;
  moves = moves || other.moves;
  addEach(boneLengthSums, other.boneLengthSums);
  addEach(footHeights, other.footHeights);
}

std::vector<double> SetFacts::meanBoneLengths() const {
  std::vector<double> out = boneLengthSums;
  for (double& sum : out) sum /= frames;
  return out;
}

std::vector<double> SetFacts::standingHeights() const {
  std::vector<double> out;
  for (const HeightCounts& heights : footHeights) out.push_back(heights.quantile(0.05));
  return out;
}

void SetFacts::pack(Packer& packer) const {
  packer.add(clips).add(frames).add(moves).add(boneLengthSums).add(footHeights.size());
  for (const HeightCounts& heights : footHeights) heights.pack(packer);
}

SetFacts SetFacts::unpacked(Unpacker& bytes) {
  SetFacts out;
  out.clips = bytes.number<size_t>();
  out.frames = bytes.number<double>();
  out.moves = bytes.number<bool>();
  out.boneLengthSums = bytes.list<double>();
  for (auto feet = bytes.number<size_t>(); feet > 0; --feet)
    out.footHeights.push_back(HeightCounts::unpacked(bytes));
  return out;
}

void StatisticSetting::completeReferences() {
  if (controls.empty()) controls = controlsEach(own.clips);
  if (natural && naturalControls.empty())
    naturalControls =
        controlsEach(natural->clips, 1 + *std::max_element(controls.begin(), controls.end()));
  if (toes.empty()) toes = toesOf(*skeleton, feet);
  const SetFacts& reference = natural ? *natural : own;
  standingHeights = reference.standingHeights();
  meanBoneLengths = reference.meanBoneLengths();
}

StatisticSetting StatisticSetting::ofNatural() const {
  StatisticSetting out = *this;
  out.own = *natural;
  out.controls = naturalControls;
  out.wanted = nullptr;
  return out;
}

SetFacts factsOf(const Clip& clip, const std::vector<int>& feet) {
  SetFacts out{.clips = 1,
               .frames = static_cast<double>(clip.frameCount()),
               .moves = clip.frameCount() > 1,
               .boneLengthSums = boneLengthSums(clip)};
  for (const int foot : feet) {
    HeightCounts heights;
    for (int t = 0; t < clip.frameCount(); ++t) heights.add(clip.at(t, foot).y());
    out.footHeights.push_back(std::move(heights));
  }
  return out;
}

}  // namespace marey::stats
