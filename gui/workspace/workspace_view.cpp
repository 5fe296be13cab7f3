// How the document is looked at: what is shown, ticked and pinned, kept in it and taken from it.
#include <algorithm>
#include <utility>

#include "gui/workspace/workspace.h"
#include <fmt/format.h>

#include "base/error.h"
#include "experiment/edits.h"

namespace marey::gui {
namespace {

/// Natural clips that are shown at first: a thousand over each other would show nothing.
constexpr size_t kNaturalShown = 3;

/// Whether a document that names the set can be opened.
bool canBeKept(const KeptSet& set) {
  try {
    viewStateFromJson({{"sets", Json::array({toJson(set)})}}, "view", {});
    return true;
  } catch (const InputError&) {
    return false;  // a steered motion of one frame has no path, for example
  }
}

/// A flag of the motions from `fresh` on is on but for those of the given numbers.
void setFlag(MotionGroup& group, size_t fresh, bool Motion::*flag, const std::vector<int>& off) {
  const std::set<int> without(off.begin(), off.end());
  for (size_t i = fresh; i < group.motions.size(); ++i)
    group.motions[i].*flag = !without.contains(static_cast<int>(i));
}

/// Saving in another folder names files from there.
KeptSet inFolder(KeptSet set, const std::filesystem::path& from, const std::filesystem::path& to) {
  if (from == to) return set;
  Experiment carrier;
  carrier.folder = from;
  carrier.view.sets = {std::move(set)};
  moveToFolder(carrier, to);
  return carrier.view.sets.front();
}

}  // namespace

Experiment Workspace::document() {
  Experiment out = experiment();
  ViewState& view = out.view;
  const auto path = static_cast<size_t>(m_currentPath);
  if (path > 0 && path < out.paths.size()) view.path = out.paths[path].name;
  view.notSampled.assign(m_leftOut.begin(), m_leftOut.end());
  view.comparison = m_comparison;
  // While they are being read, what the opened document said still holds.
  const bool read = std::any_of(m_groups.begin(), m_groups.end(),
                                [](const MotionGroup& group) { return group.natural(); });
  if (read)
    view.natural = shownClips();
  else
    view.natural = m_naturalShown;
  view.sets = keptSets();
  Q_EMIT viewAsked(view);
  return out;
}

void Workspace::takeView(ViewState view) {
  const auto& paths = experiment().paths;
  const auto path = std::find_if(paths.begin(), paths.end(),
                                 [&](const ExperimentPath& p) { return p.name == view.path; });
  if (path != paths.end()) setCurrentPath(static_cast<int>(path - paths.begin()));
  for (const std::string& system : view.notSampled)
    if (systemIndex(system) >= 0) m_leftOut.insert(system);
  m_naturalShown = view.natural;
  m_kept.clear();
  m_offered = view.sets;
  m_offeredFolder = experiment().folder;
  m_savedPins = pinnedSets();
  m_comparison = view.comparison;
  Q_EMIT documentChanged();  // ticks
  Q_EMIT comparisonChanged();
  Q_EMIT offeredChanged();
  Q_EMIT viewOpened(view);
}

std::vector<ShownClips> Workspace::shownClips() const {
  std::vector<ShownClips> out;
  for (const MotionGroup& group : m_groups) {
    if (!group.natural()) continue;
    int number = 0;
    for (size_t i = 0; i < group.motions.size(); ++i) {
      const Motion& motion = group.motions[i];
      const bool next = i == 0 || motion.source != group.motions[i - 1].source;
      number = next ? 0 : number + 1;
      if (next) out.push_back({motion.source, {}});
      if (motion.visible) out.back().clips.push_back(number);
    }
  }
  return out;
}

/// Natural clips by what the document calls their sources now; `shown` is as shownClips().
void Workspace::renameSources(const std::vector<ShownClips>& shown) {
  for (MotionGroup& group : m_groups) {
    if (!group.natural()) continue;
    size_t at = 0;
    std::string before;
    for (size_t i = 0; i < group.motions.size(); ++i) {
      std::string& source = group.motions[i].source;
      if (i > 0 && source != before) ++at;
      before = std::exchange(source, shown[at].source);
    }
  }
}

/// Clips of a source that was there keep their ticks; of new ones the first few are shown.
void Workspace::showNatural(MotionGroup& group) {
  const std::vector<ShownClips> before = m_naturalShown ? *m_naturalShown : shownClips();
  m_naturalShown.reset();
  std::vector<Motion*> fresh;
  size_t shown = 0;
  int number = 0;
  for (size_t i = 0; i < group.motions.size(); ++i) {
    Motion& motion = group.motions[i];
    number = i > 0 && motion.source == group.motions[i - 1].source ? number + 1 : 0;
    const auto known = std::find_if(before.begin(), before.end(), [&](const ShownClips& source) {
      return source.source == motion.source;
    });
    if (known == before.end()) {
      fresh.push_back(&motion);
      continue;
    }
    motion.visible =
        std::find(known->clips.begin(), known->clips.end(), number) != known->clips.end();
    shown += motion.visible ? 1 : 0;
  }
  for (Motion* motion : fresh) motion->visible = shown++ < kNaturalShown;
}

std::vector<KeptSet> Workspace::keptSets() const {
  std::vector<KeptSet> out;
  for (const MotionGroup& group : m_groups) {
    if (!group.recipe) continue;
    KeptSet set = keptSetOf(recipeHere(*group.recipe));
    set.pinned = group.pinned;
    if (systemIndex(group.system) < 0) set.colour = group.colourIndex;
    set.hidden = without(group, &Motion::visible, &KeptSet::hidden);
    set.leftOut = without(group, &Motion::used, &KeptSet::leftOut);
    if (canBeKept(set)) out.push_back(std::move(set));
  }
  // What was not drawn again is not given up by saving.
  for (const KeptSet& set : m_offered)
    out.push_back(inFolder(set, m_offeredFolder, experiment().folder));
  return out;
}

SampleRecipe Workspace::recipeHere(const SampleRecipe& recipe) const {
  const std::filesystem::path& here = experiment().folder;
  return recipeOf(inFolder(keptSetOf(recipe), recipe.folder, here), recipe.fps, here);
}

std::vector<std::string> Workspace::pinnedSets() const {
  std::vector<std::string> out;
  const auto add = [&](const ExperimentSystem& system, const ExperimentPath& path, int samples,
                       uint64_t seed, const std::vector<int>& leftOut) {
    out.push_back(fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}", system.name, system.temperature,
                              textOf(system.options), path.name, samples, seed,
                              fmt::join(leftOut, " ")));
  };
  for (const MotionGroup& group : m_groups)
    if (group.pinned && group.recipe)
      add(group.recipe->system, group.recipe->path, group.recipe->samples, group.recipe->seed,
          without(group, &Motion::used, &KeptSet::leftOut));
  for (const KeptSet& set : m_offered)
    if (set.pinned) add(set.system, set.path, set.samples, set.seed, set.leftOut);
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<int> Workspace::without(const MotionGroup& group, bool Motion::*flag,
                                    std::vector<int> KeptSet::*kept) const {
  std::vector<int> out;
  const auto count = static_cast<int>(group.motions.size());
  for (int i = 0; i < count; ++i)
    if (!(group.motions[static_cast<size_t>(i)].*flag)) out.push_back(i);
  // Those that are still to be drawn keep what the document says of them.
  if (const auto drawn = m_kept.find(group.id); drawn != m_kept.end())
    for (const int i : drawn->second.*kept)
      if (i >= count) out.push_back(i);
  return out;
}

void Workspace::markAsKept(MotionGroup& group, size_t fresh) {
  const auto kept = m_kept.find(group.id);
  if (kept == m_kept.end()) return;
  setFlag(group, fresh, &Motion::visible, kept->second.hidden);
  setFlag(group, fresh, &Motion::used, kept->second.leftOut);
}

void Workspace::sampleOffered() {
  const std::vector<KeptSet> sets = std::exchange(m_offered, {});
  for (const KeptSet& set : sets) {
    if (set.heldOut && usedNatural().empty()) {
      m_offered.push_back(set);
      continue;
    }
    const SampleRecipe recipe = recipeHere(recipeOf(set, experiment().fps, m_offeredFolder));
    sample(recipe, -1, set.colour);
    MotionGroup& group = m_groups.back();
    group.pinned = set.pinned;
    m_kept[group.id] = set;
  }
  Q_EMIT offeredChanged();
  Q_EMIT documentChanged();
  if (!m_offered.empty()) Q_EMIT noticed(tr("Held-out control needs natural clips that are read"));
}

void Workspace::dismissOffered() {
  m_offered.clear();
  Q_EMIT offeredChanged();
  Q_EMIT documentChanged();  // it may have been pinned
}

void Workspace::setComparison(Comparison comparison) {
  if (comparison == m_comparison) return;
  m_comparison = comparison;
  Q_EMIT comparisonChanged();
}

}  // namespace marey::gui
