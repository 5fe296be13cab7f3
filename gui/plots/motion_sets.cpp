#include "gui/plots/motion_sets.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/quantile.h"
#include "motion/main_body.h"
#include "stats/bones.h"
#include "stats/sample_distance.h"

namespace marey::gui {
namespace {

/// Samples that are cooler than the model say so wherever they are compared.
std::string labelOf(const MotionGroup& group) {
  if (!group.recipe) return group.name;
  const ExperimentSystem& system = group.recipe->system;
  std::string out = group.name;
  if (system.temperature != 1.0) out += fmt::format(", temperature {:g}", system.temperature);
  if (!system.options.empty()) out += ", " + textOf(system.options);
  return out;
}

/// The motions of a group that are used and have the joints of most of these.
void addUsed(MotionSet& set, const MotionGroup& group) {
  std::vector<int> used;
  std::vector<const Skeleton*> bodies;
  for (size_t i = 0; i < group.motions.size(); ++i) {
    if (!group.motions[i].used) continue;
    used.push_back(static_cast<int>(i));
    bodies.push_back(group.motions[i].clip->skeleton.get());
  }
  const int main = mainBody(bodies);
  for (size_t k = 0; k < used.size(); ++k) {
    if (!sameJoints(*bodies[k], *bodies[static_cast<size_t>(main)])) {
      ++set.otherBody;
      continue;
    }
    set.ids.push_back({group.id, used[k]});
    const Motion& motion = group.motions[static_cast<size_t>(used[k])];
    set.clips.push_back(motion.clip);
    if (!motion.wanted) continue;
    set.wantedEach.push_back(motion.wanted);
    set.follows.push_back(motion.follows);
  }
}

}  // namespace

std::vector<MotionSet> motionSets(const std::vector<MotionGroup>& groups, Comparison comparison) {
  std::vector<MotionSet> sets;
  const bool heldOut = comparison == Comparison::HeldOut;
  for (const MotionGroup& group : groups) {
    if (group.heldOut() != heldOut && !(heldOut && group.natural())) continue;
    // A motion that is still being steered grows at every frame: it is compared once it is kept.
    if (!group.complete && !group.recipe && !group.natural()) continue;
    MotionSet set{.group = group.id,
                  .name = labelOf(group),
                  .system = group.system,
                  .natural = group.natural(),
                  .colour = render::colourOf(group.colourIndex),
                  .wanted = group.wanted,
                  .all = static_cast<int>(group.motions.size())};
    addUsed(set, group);
    if (set.clips.empty()) continue;
    set.dashed = std::any_of(sets.begin(), sets.end(),
                             [&](const MotionSet& s) { return s.colour == set.colour; });
    sets.push_back(std::move(set));
  }
  std::stable_sort(sets.begin(), sets.end(),
                   [](const MotionSet& a, const MotionSet& b) { return a.natural > b.natural; });
  return sets;
}

std::string countedText(const std::vector<MotionSet>& sets) {
  std::string out;
  for (const MotionSet& set : sets) {
    out += fmt::format("{}{}: {} of {}", out.empty() ? "Counted: " : "; ", set.name,
                       set.clips.size(), set.all);
    if (set.otherBody > 0) out += fmt::format(" ({} of another skeleton)", set.otherBody);
  }
  return out;
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
    const auto& wanted = set.wantedEach.empty() ? set.wanted : *set.wantedEach[i];
    if (wanted.empty()) continue;
    const auto frames = static_cast<int>(wanted.size());
    const auto begin = wanted.begin();
    out.wanted.emplace_back(begin + std::min(span.first, frames),
                            begin + std::min(span.last, frames));
  }
  // A wanted path that ends before the range says nothing of it.
  if (std::any_of(out.wanted.begin(), out.wanted.end(), [](const auto& w) { return w.empty(); }))
    out.wanted.clear();
  return out;
}

void requireJointsOf(const Clip& clip, const Clip& first) {
  if (sameJoints(*clip.skeleton, *first.skeleton)) return;
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
    band.low.push_back(sortedQuantile(values, 0.05));
    band.median.push_back(sortedQuantile(values, 0.5));
    band.high.push_back(sortedQuantile(values, 0.95));
  }
  return band;
}

}  // namespace marey::gui
