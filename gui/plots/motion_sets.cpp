#include "plots/motion_sets.h"

#include <algorithm>
#include <cmath>

#include "stats/bones.h"
#include "stats/sample_distance.h"

namespace marey::gui {

std::vector<MotionSet> motionSets(const std::vector<MotionGroup>& groups) {
  std::vector<MotionSet> sets;
  for (const MotionGroup& group : groups) {
    const bool shown = std::any_of(group.motions.begin(), group.motions.end(),
                                   [](const Motion& m) { return m.visible; });
    // A motion that is still being steered grows at every frame: it is compared once it is kept.
    const bool steered = !group.complete && !group.recipe && !group.natural();
    if (!shown || steered) continue;
    MotionSet set{.group = group.id,
                  .name = group.name,
                  .system = group.system,
                  .natural = group.natural(),
                  .colour = group.colour(),
                  .wanted = group.wanted};
    for (size_t i = 0; i < group.motions.size(); ++i) {
      if (!set.natural && !group.motions[i].visible) continue;
      set.ids.push_back({group.id, static_cast<int>(i)});
      set.clips.push_back(group.motions[i].clip);
    }
    set.dashed = std::any_of(sets.begin(), sets.end(),
                             [&](const MotionSet& s) { return s.colour == set.colour; });
    sets.push_back(std::move(set));
  }
  std::stable_sort(sets.begin(), sets.end(),
                   [](const MotionSet& a, const MotionSet& b) { return a.natural > b.natural; });
  return sets;
}

const MotionSet* naturalSet(const std::vector<MotionSet>& sets) {
  return !sets.empty() && sets.front().natural ? &sets.front() : nullptr;
}

ClipsInRange clipsIn(const MotionSet& set, const std::optional<TimeRange>& range) {
  ClipsInRange out;
  for (size_t i = 0; i < set.clips.size(); ++i) {
    const ClipPtr& clip = set.clips[i];
    const FrameSpan span = framesIn(*clip, range);
    if (span.empty()) continue;
    out.ids.push_back(set.ids[i]);
    out.clips.push_back(range ? sliceFrames(*clip, span.first, span.last) : *clip);
    if (!set.follows.empty()) out.follows.push_back(set.follows[i]);
    if (set.wanted.empty()) continue;
    const auto frames = static_cast<int>(set.wanted.size());
    const auto begin = set.wanted.begin();
    out.wanted.emplace_back(begin + std::min(span.first, frames),
                            begin + std::min(span.last, frames));
  }
  // A wanted path that ends before the range says nothing of it.
  if (std::any_of(out.wanted.begin(), out.wanted.end(), [](const auto& w) { return w.empty(); }))
    out.wanted.clear();
  return out;
}

void requireJointsOf(const Clip& clip, const Clip& first) {
  const Skeleton &a = *clip.skeleton, &b = *first.skeleton;
  if (&a == &b || (a.names == b.names && a.parents == b.parents)) return;
  stats::requireSameJoints({sliceFrames(first, 0, 1), sliceFrames(clip, 0, 1)});
}

std::vector<double> framesInSeconds(size_t frames, double fps) {
  std::vector<double> out;
  for (size_t t = 0; t < frames; ++t) out.push_back(static_cast<double>(t) / fps);
  return out;
}

Band bandOf(const std::vector<std::vector<double>>& runs) {
  size_t steps = 0;
  for (const auto& run : runs) steps = std::max(steps, run.size());
  Band band;
  std::vector<double> values;
  for (size_t t = 0; t < steps; ++t) {
    values.clear();
    for (const auto& run : runs)
      if (t < run.size() && std::isfinite(run[t])) values.push_back(run[t]);
    if (values.empty()) continue;
    std::sort(values.begin(), values.end());
    band.step.push_back(static_cast<double>(t));
    band.low.push_back(stats::sortedQuantile(values, 0.05));
    band.median.push_back(stats::sortedQuantile(values, 0.5));
    band.high.push_back(stats::sortedQuantile(values, 0.95));
  }
  return band;
}

}  // namespace marey::gui
