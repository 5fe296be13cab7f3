#include "gui/workspace/motion_groups.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "motion/main_body.h"

namespace marey::gui {
namespace {

bool keptInDocument(const MotionGroup& group) {
  return group.pinned && group.recipe;
}

}  // namespace

void MotionGroups::tell() {
  Q_EMIT changed();
  tellVisibility();
}

void MotionGroups::tellVisibility() {
  Q_EMIT visibilityChanged();
  Q_EMIT settled();
}

MotionGroup* MotionGroups::find(int id) {
  const auto found = std::find_if(m_groups.begin(), m_groups.end(),
                                  [id](const MotionGroup& group) { return group.id == id; });
  return found == m_groups.end() ? nullptr : &*found;
}

const MotionGroup* MotionGroups::group(int id) const {
  const auto found = std::find_if(m_groups.begin(), m_groups.end(),
                                  [id](const MotionGroup& group) { return group.id == id; });
  return found == m_groups.end() ? nullptr : &*found;
}

const MotionGroup* MotionGroups::natural() const {
  const auto found = std::find_if(m_groups.begin(), m_groups.end(),
                                  [](const MotionGroup& group) { return group.natural(); });
  return found == m_groups.end() ? nullptr : &*found;
}

const Motion* MotionGroups::motion(const MotionId& id) const {
  const MotionGroup* owner = group(id.group);
  if (owner == nullptr || id.index < 0 || id.index >= static_cast<int>(owner->motions.size()))
    return nullptr;
  return &owner->motions[static_cast<size_t>(id.index)];
}

std::vector<MotionId> MotionGroups::visibleMotions() const {
  std::vector<MotionId> out;
  for (const MotionGroup& group : m_groups)
    for (size_t i = 0; i < group.motions.size(); ++i)
      if (group.motions[i].visible) out.push_back({group.id, static_cast<int>(i)});
  return out;
}

double MotionGroups::duration() const {
  double longest = 0.0;
  for (const MotionGroup& group : m_groups)
    for (const Motion& motion : group.motions)
      if (motion.visible)
        longest = std::max(longest, (motion.clip->frameCount() - 1) / motion.clip->fps);
  return longest;
}

std::shared_ptr<const Skeleton> MotionGroups::skeleton() const {
  for (const MotionGroup& group : m_groups) {
    std::vector<const Skeleton*> bodies;
    for (const Motion& motion : group.motions) bodies.push_back(motion.clip->skeleton.get());
    if (const int main = mainBody(bodies); main >= 0)
      return group.motions[static_cast<size_t>(main)].clip->skeleton;
  }
  return nullptr;
}

void MotionGroups::setVisible(int id, bool visible) {
  MotionGroup* group = find(id);
  if (group == nullptr) return;
  for (Motion& motion : group->motions) motion.visible = visible;
  tellVisibility();
}

void MotionGroups::setVisible(const MotionId& id, bool visible) {
  setVisible(std::vector<MotionId>{id}, visible);
}

void MotionGroups::setVisible(const std::vector<MotionId>& ids, bool visible) {
  bool changes = false;
  for (const MotionId& id : ids) {
    if (motion(id) == nullptr || motion(id)->visible == visible) continue;
    find(id.group)->motions[static_cast<size_t>(id.index)].visible = visible;
    changes = true;
  }
  if (changes) tellVisibility();
}

void MotionGroups::showOnly(const std::set<MotionId>& shown) {
  for (MotionGroup& group : m_groups)
    for (size_t i = 0; i < group.motions.size(); ++i)
      group.motions[i].visible = shown.contains({group.id, static_cast<int>(i)});
  tellVisibility();
}

void MotionGroups::setUsed(const std::vector<MotionId>& ids, bool used) {
  bool changes = false, kept = false;
  for (const MotionId& id : ids) {
    if (motion(id) == nullptr || motion(id)->used == used) continue;
    MotionGroup& group = *find(id.group);
    if (group.natural()) continue;
    group.motions[static_cast<size_t>(id.index)].used = used;
    changes = true;
    kept = kept || keptInDocument(group);
  }
  if (changes) tell();
  if (kept) Q_EMIT pinsChanged();
}

void MotionGroups::setPinned(int id, bool pinned) {
  MotionGroup* group = find(id);
  if (group == nullptr) return;
  group->pinned = pinned;
  Q_EMIT changed();
  Q_EMIT pinsChanged();
}

int MotionGroups::add(MotionGroup group) {
  group.id = m_nextId++;
  const int id = group.id;
  const bool kept = keptInDocument(group);
  m_groups.push_back(std::move(group));
  tell();
  if (kept) Q_EMIT pinsChanged();
  return id;
}

void MotionGroups::setNatural(MotionGroup group) {
  if (const MotionGroup* old = natural()) Q_EMIT removing(int{old->id});
  std::erase_if(m_groups, [](const MotionGroup& g) { return g.natural(); });
  group.id = m_nextId++;
  if (!group.motions.empty()) m_groups.insert(m_groups.begin(), std::move(group));
}

void MotionGroups::setMotions(int id, std::vector<Motion> motions) {
  MotionGroup* group = find(id);
  if (group == nullptr) return;
  group->motions = std::move(motions);
  tell();
}

void MotionGroups::remove(int id) {
  Q_EMIT removing(id);
  const MotionGroup* gone = group(id);
  if (gone == nullptr) return;
  const bool kept = keptInDocument(*gone);
  std::erase_if(m_groups, [id](const MotionGroup& group) { return group.id == id; });
  tell();
  if (kept) Q_EMIT pinsChanged();
}

void MotionGroups::setAside(int id) {
  constexpr size_t kMost = 10;
  const MotionGroup* found = group(id);
  if (found == nullptr) return;
  if (!found->motions.empty()) {
    m_aside.push_back(*found);
    // What was not drawn yet does not come any more.
    m_aside.back().complete = true;
    if (m_aside.size() > kMost) m_aside.erase(m_aside.begin());
  }
  remove(id);
}

void MotionGroups::bringBack() {
  if (m_aside.empty()) return;
  MotionGroup group = std::move(m_aside.back());
  m_aside.pop_back();
  add(std::move(group));
}

void MotionGroups::clear() {
  m_groups.clear();
  m_aside.clear();
}

bool recolour(std::vector<MotionGroup>& groups, const std::vector<std::string>& systems) {
  const int count = static_cast<int>(systems.size());
  int free = count;
  for (const MotionGroup& group : groups) free = std::max(free, group.colourIndex + 1);
  std::map<std::string, int> moved;  // sets of one system that is gone stay alike
  bool changed = false;
  for (MotionGroup& group : groups) {
    if (group.natural()) continue;
    const auto known = std::find(systems.begin(), systems.end(), group.system);
    int wanted = group.colourIndex;
    if (known != systems.end()) {
      wanted = static_cast<int>(known - systems.begin());
    } else if (wanted < count) {
      const auto [at, added] = moved.emplace(group.system, free);
      free += added ? 1 : 0;
      wanted = at->second;
    }
    changed = changed || wanted != group.colourIndex;
    group.colourIndex = wanted;
  }
  return changed;
}

}  // namespace marey::gui
