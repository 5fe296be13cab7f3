// Motions, selection and time.
#include <algorithm>

#include "gui/workspace/workspace.h"

#include "base/error.h"
#include "motion/main_body.h"
#include "stats/footsteps.h"

namespace marey::gui {

void Workspace::tellMotions() {
  Q_EMIT motionsChanged();
  tellVisibility();
}

void Workspace::tellVisibility() {
  Q_EMIT visibilityChanged();
  setTime(m_time);  // inside what is left
}

MotionGroup* Workspace::findGroup(int id) {
  const auto found = std::find_if(m_groups.begin(), m_groups.end(),
                                  [id](const MotionGroup& group) { return group.id == id; });
  return found == m_groups.end() ? nullptr : &*found;
}

const MotionGroup* Workspace::group(int id) const {
  return const_cast<Workspace*>(this)->findGroup(id);
}

const Motion* Workspace::motion(const MotionId& id) const {
  const MotionGroup* owner = group(id.group);
  if (owner == nullptr || id.index < 0 || id.index >= static_cast<int>(owner->motions.size()))
    return nullptr;
  return &owner->motions[static_cast<size_t>(id.index)];
}

/// A system of the document has the colour of its place there; others keep theirs unless a system
/// needs it. Returns whether any changed.
bool Workspace::recolour() {
  const int systems = static_cast<int>(experiment().systems.size());
  int free = systems;
  for (const MotionGroup& group : m_groups) free = std::max(free, group.colourIndex + 1);
  std::map<std::string, int> moved;  // sets of one system that is gone stay alike
  bool changed = false;
  for (MotionGroup& group : m_groups) {
    if (group.natural()) continue;
    int wanted = systemIndex(group.system);
    if (wanted < 0) wanted = group.colourIndex;
    if (systemIndex(group.system) < 0 && wanted < systems) {
      const auto [at, added] = moved.emplace(group.system, free);
      free += added ? 1 : 0;
      wanted = at->second;
    }
    changed = changed || wanted != group.colourIndex;
    group.colourIndex = wanted;
  }
  return changed;
}

void Workspace::setVisible(int id, bool visible) {
  MotionGroup* group = findGroup(id);
  if (group == nullptr) return;
  for (Motion& motion : group->motions) motion.visible = visible;
  tellVisibility();
}

void Workspace::setVisible(const MotionId& id, bool visible) {
  setVisible(std::vector<MotionId>{id}, visible);
}

void Workspace::setVisible(const std::vector<MotionId>& ids, bool visible) {
  bool changed = false;
  for (const MotionId& id : ids) {
    if (motion(id) == nullptr || motion(id)->visible == visible) continue;
    findGroup(id.group)->motions[static_cast<size_t>(id.index)].visible = visible;
    changed = true;
  }
  if (changed) tellVisibility();
}

void Workspace::setUsed(const std::vector<MotionId>& ids, bool used) {
  std::set<std::string> natural;
  bool changed = false;
  const std::vector<std::string> pinned = pinnedSets();
  for (const MotionId& id : ids) {
    if (motion(id) == nullptr || motion(id)->used == used) continue;
    MotionGroup& group = *findGroup(id.group);
    Motion& chosen = group.motions[static_cast<size_t>(id.index)];
    if (group.natural()) {
      natural.insert(chosen.clip->name);
      continue;
    }
    chosen.used = used;
    changed = true;
  }
  if (changed) tellMotions();
  if (pinnedSets() != pinned) Q_EMIT documentChanged();  // it keeps pinned sets
  if (natural.empty()) return;
  edit(used ? tr("Use clips") : tr("Leave clips out"), [&](Experiment& e) {
    std::erase_if(e.naturalLeftOut,
                  [&](const std::string& name) { return natural.contains(name); });
    if (!used) e.naturalLeftOut.insert(e.naturalLeftOut.end(), natural.begin(), natural.end());
  });
}

void Workspace::followUse() {
  const auto& names = experiment().naturalLeftOut;
  const std::set<std::string> leftOut(names.begin(), names.end());
  for (MotionGroup& group : m_groups)
    for (Motion& motion : group.motions)
      if (group.natural()) motion.used = !leftOut.contains(motion.clip->name);
}

void Workspace::showOnly(const std::set<MotionId>& shown) {
  for (MotionGroup& group : m_groups)
    for (size_t i = 0; i < group.motions.size(); ++i)
      group.motions[i].visible = shown.contains({group.id, static_cast<int>(i)});
  tellVisibility();
}

void Workspace::setPinned(int id, bool pinned) {
  if (MotionGroup* group = findGroup(id)) {
    group->pinned = pinned;
    Q_EMIT motionsChanged();
    Q_EMIT documentChanged();  // it keeps pinned sets
  }
}

void Workspace::removeGroup(int id) {
  const auto drawing = m_drawings.find(id);
  if (drawing != m_drawings.end()) {
    const int job = drawing->second.job;
    m_drawings.erase(drawing);
    m_jobs.cancel(job);
  }
  dropSelectionOf(id);
  const std::vector<std::string> pinned = pinnedSets();
  if (std::erase_if(m_groups, [id](const MotionGroup& group) { return group.id == id; }) == 0)
    return;
  tellMotions();
  if (pinnedSets() != pinned) Q_EMIT documentChanged();
}

void Workspace::setAside(int id) {
  constexpr size_t kMost = 10;
  const MotionGroup* found = group(id);
  if (found == nullptr) return;
  if (!found->motions.empty()) {
    m_aside.push_back(*found);
    // What was not drawn yet does not come any more.
    m_aside.back().complete = true;
    if (m_aside.size() > kMost) m_aside.erase(m_aside.begin());
  }
  removeGroup(id);
}

void Workspace::bringBack() {
  if (m_aside.empty()) return;
  MotionGroup group = std::move(m_aside.back());
  m_aside.pop_back();
  addGroup(std::move(group));
}

int Workspace::addGroup(MotionGroup group) {
  group.id = m_nextGroup++;
  const int id = group.id;
  const bool kept = group.pinned && group.recipe;
  m_groups.push_back(std::move(group));
  tellMotions();
  if (kept) Q_EMIT documentChanged();
  return id;
}

void Workspace::setMotions(int id, std::vector<Motion> motions) {
  MotionGroup* group = findGroup(id);
  if (group == nullptr) return;
  group->motions = std::move(motions);
  tellMotions();
}

std::vector<MotionId> Workspace::visibleMotions() const {
  std::vector<MotionId> out;
  for (const MotionGroup& group : m_groups)
    for (size_t i = 0; i < group.motions.size(); ++i)
      if (group.motions[i].visible) out.push_back({group.id, static_cast<int>(i)});
  return out;
}

std::shared_ptr<const Skeleton> Workspace::skeleton() const {
  for (const MotionGroup& group : m_groups) {
    std::vector<const Skeleton*> bodies;
    for (const Motion& motion : group.motions) bodies.push_back(motion.clip->skeleton.get());
    if (const int main = mainBody(bodies); main >= 0)
      return group.motions[static_cast<size_t>(main)].clip->skeleton;
  }
  return nullptr;
}

std::vector<int> Workspace::feet() const {
  const auto body = skeleton();
  if (!body) return {};
  try {
    return stats::feetOf(*body, experiment().feet);
  } catch (const InputError&) {
    return {};  // a skeleton without feet: nothing to count
  }
}

void Workspace::dropSelectionOf(int group) {
  Selection next = m_selection;
  std::erase_if(next.motions, [group](const MotionId& id) { return id.group == group; });
  select(std::move(next));
}

void Workspace::select(Selection selection) {
  if (selection == m_selection) return;
  m_selection = std::move(selection);
  Q_EMIT selectionChanged();
}

double Workspace::duration() const {
  double longest = 0.0;
  for (const MotionGroup& group : m_groups)
    for (const Motion& motion : group.motions)
      if (motion.visible)
        longest = std::max(longest, (motion.clip->frameCount() - 1) / motion.clip->fps);
  return longest;
}

void Workspace::setTime(double seconds) {
  const double next = std::clamp(seconds, 0.0, duration());
  if (next == m_time) return;
  m_time = next;
  Q_EMIT timeChanged(next);
}

void Workspace::setRange(std::optional<TimeRange> range) {
  if (range && !(range->endS > range->beginS)) range.reset();
  if (range == m_range) return;
  m_range = range;
  Q_EMIT rangeChanged();
}

}  // namespace marey::gui
