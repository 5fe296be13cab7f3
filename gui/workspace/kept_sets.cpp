#include "gui/workspace/kept_sets.h"

#include <algorithm>
#include <set>
#include <utility>

#include "experiment/kept_sets.h"

namespace marey::gui {
namespace {

/// A flag of the motions from `first` on is on but for those of the given numbers.
void setFlag(MotionGroup& group, int first, bool Motion::*flag, const std::vector<int>& off) {
  const std::set<int> without(off.begin(), off.end());
  for (auto i = static_cast<size_t>(first); i < group.motions.size(); ++i)
    group.motions[i].*flag = !without.contains(static_cast<int>(i));
}

}  // namespace

KeptSets::KeptSets(Document& document, MotionGroups& motions, const NaturalMotions& natural,
                   Sampling& sampling, QObject* parent)
    : QObject(parent),
      m_document(document),
      m_motions(motions),
      m_natural(natural),
      m_sampling(sampling) {
  connect(&sampling, &Sampling::drawn, this, &KeptSets::mark);
  connect(&sampling, &Sampling::ended, this, [this](int group) { m_drawn.erase(group); });
}

void KeptSets::offer(std::vector<KeptSet> sets) {
  m_drawn.clear();
  m_offered = std::move(sets);
  m_offeredFolder = m_document.experiment().folder;
  setSaved();
}

void KeptSets::sampleOffered() {
  const std::vector<KeptSet> sets = std::exchange(m_offered, {});
  const Experiment& e = m_document.experiment();
  for (const KeptSet& set : sets) {
    if (set.heldOut && m_natural.used().empty()) {
      m_offered.push_back(set);
      continue;
    }
    const SampleRecipe recipe = inFolder(recipeOf(set, e.fps, m_offeredFolder), e.folder);
    const int group = m_sampling.sample(recipe, -1, set.colour);
    m_motions.find(group)->pinned = set.pinned;
    m_drawn[group] = set;
  }
  Q_EMIT offeredChanged();
  Q_EMIT m_document.changed();
  if (!m_offered.empty()) Q_EMIT noticed(tr("Held-out control needs natural clips that are read"));
}

void KeptSets::dismissOffered() {
  m_offered.clear();
  Q_EMIT offeredChanged();
  Q_EMIT m_document.changed();  // it may have been pinned
}

void KeptSets::mark(int id, int first) {
  const auto kept = m_drawn.find(id);
  if (kept == m_drawn.end()) return;
  MotionGroup& group = *m_motions.find(id);
  setFlag(group, first, &Motion::visible, kept->second.hidden);
  setFlag(group, first, &Motion::used, kept->second.leftOut);
}

std::vector<int> KeptSets::without(const MotionGroup& group, bool Motion::*flag,
                                   std::vector<int> KeptSet::*kept) const {
  std::vector<int> out;
  const auto count = static_cast<int>(group.motions.size());
  for (int i = 0; i < count; ++i)
    if (!(group.motions[static_cast<size_t>(i)].*flag)) out.push_back(i);
  // Those that are still to be drawn keep what the document says of them.
  if (const auto drawn = m_drawn.find(group.id); drawn != m_drawn.end())
    for (const int i : drawn->second.*kept)
      if (i >= count) out.push_back(i);
  return out;
}

KeptSet KeptSets::kept(const MotionGroup& group) const {
  KeptSet out = keptSetOf(inFolder(*group.recipe, m_document.experiment().folder));
  out.pinned = group.pinned;
  if (m_document.systemIndex(group.system) < 0) out.colour = group.colourIndex;
  out.hidden = without(group, &Motion::visible, &KeptSet::hidden);
  out.leftOut = without(group, &Motion::used, &KeptSet::leftOut);
  return out;
}

std::vector<KeptSet> KeptSets::toKeep() const {
  std::vector<KeptSet> out;
  for (const MotionGroup& group : m_motions.groups()) {
    if (!group.recipe) continue;
    if (KeptSet set = kept(group); canBeKept(set)) out.push_back(std::move(set));
  }
  // What was not drawn again is not given up by saving.
  for (const KeptSet& set : m_offered)
    out.push_back(inFolder(set, m_offeredFolder, m_document.experiment().folder));
  return out;
}

std::vector<std::string> KeptSets::pinned() const {
  std::vector<std::string> out;
  for (const MotionGroup& group : m_motions.groups()) {
    if (!group.pinned || !group.recipe) continue;
    KeptSet set = keptSetOf(*group.recipe);
    set.leftOut = without(group, &Motion::used, &KeptSet::leftOut);
    out.push_back(keyOf(set));
  }
  for (const KeptSet& set : m_offered)
    if (set.pinned) out.push_back(keyOf(set));
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace marey::gui
