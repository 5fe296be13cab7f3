#include "stats/controls.h"

#include <algorithm>
#include <numeric>

#include "base/random.h"

namespace marey::stats {
namespace {

/// Streams of one resample: what is drawn among what.
enum Stream : uint32_t { kOwn = 0, kShared = 2, kNatural = 3, kFirst = 4, kSecond = 5 };

std::map<int, std::vector<size_t>> byControl(const std::vector<int>& controls) {
  std::map<int, std::vector<size_t>> out;
  for (size_t i = 0; i < controls.size(); ++i) out[controls[i]].push_back(i);
  return out;
}

/// Counts a control `times`: each of its clips by its share.
void count(const std::vector<size_t>& clips, double times, std::vector<double>& weights) {
  for (const size_t clip : clips) weights[clip] += times / static_cast<double>(clips.size());
}

/// Every group as often as it was drawn in `draws` draws among all of them.
std::vector<double> drawnGroups(const std::map<int, std::vector<size_t>>& groups, size_t clips,
                                size_t draws, const RandomKey& key) {
  std::vector<double> weights(clips, 0.0);
  std::vector<const std::vector<size_t>*> list;
  for (const auto& [control, members] : groups) list.push_back(&members);
  for (size_t i = 0; i < draws && !list.empty(); ++i) {
    const auto at = static_cast<size_t>(uniformAt(key, static_cast<uint32_t>(i)) *
                                        static_cast<double>(list.size()));
    count(*list[std::min(at, list.size() - 1)], 1.0, weights);
  }
  return weights;
}

}  // namespace

std::vector<int> resampleWeights(int count, uint64_t seed, uint32_t index, uint32_t stream) {
  std::vector<int> weights(static_cast<size_t>(count), 0);
  const RandomKey key{
      .seed = seed, .sample = index, .frame = stream, .stage = RandomStage::Bootstrap};
  for (int i = 0; i < count; ++i) {
    const int drawn = static_cast<int>(uniformAt(key, static_cast<uint32_t>(i)) * count);
    ++weights[static_cast<size_t>(std::min(drawn, count - 1))];
  }
  return weights;
}

ControlSets::ControlSets(const std::vector<int>& own, const std::vector<int>& natural)
    : m_own(byControl(own)),
      m_natural(byControl(natural)),
      m_clips(own.size()),
      m_naturalClips(natural.size()) {}

Weights ControlSets::once() const {
  Weights out{std::vector<double>(m_clips, 0.0), std::vector<double>(m_naturalClips, 0.0)};
  for (const auto& [control, clips] : m_own) count(clips, 1.0, out.clips);
  for (const auto& [control, clips] : m_natural) count(clips, 1.0, out.natural);
  return out;
}

Weights ControlSets::drawn(uint64_t seed, uint32_t index) const {
  Weights out{std::vector<double>(m_clips, 0.0), std::vector<double>(m_naturalClips, 0.0)};
  std::vector<int> shared, own, natural;
  for (const auto& [control, clips] : m_own)
    (m_natural.contains(control) ? shared : own).push_back(control);
  for (const auto& [control, clips] : m_natural)
    if (!m_own.contains(control)) natural.push_back(control);
  const auto draw = [&](const std::vector<int>& controls, uint32_t stream, const auto& add) {
    const auto times = resampleWeights(static_cast<int>(controls.size()), seed, index, stream);
    for (size_t i = 0; i < controls.size(); ++i)
      if (times[i] > 0) add(controls[i], times[i]);
  };
  draw(own, kOwn, [&](int c, double times) { count(m_own.at(c), times, out.clips); });
  draw(natural, kNatural, [&](int c, double times) { count(m_natural.at(c), times, out.natural); });
  draw(shared, kShared, [&](int c, double times) {
    count(m_own.at(c), times, out.clips);
    count(m_natural.at(c), times, out.natural);
  });
  return out;
}

Weights ControlSets::bothNatural(uint64_t seed, uint32_t index) const {
  const auto side = [&](size_t draws, uint32_t stream) {
    return drawnGroups(
        m_natural, m_naturalClips, draws,
        {.seed = seed, .sample = index, .frame = stream, .stage = RandomStage::Bootstrap});
  };
  return {side(m_own.size(), kFirst), side(m_natural.size(), kSecond)};
}

std::vector<int> controlsEach(size_t clips, int first) {
  std::vector<int> out(clips);
  std::iota(out.begin(), out.end(), first);
  return out;
}

}  // namespace marey::stats
