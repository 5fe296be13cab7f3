#include "gui/time/gait_rows.h"

#include <set>

#include "gui/workspace/motion_labels.h"

#include "base/error.h"

namespace marey::gui {
namespace {
constexpr size_t kMostMotions = 24;
}  // namespace

std::vector<MotionId> GaitRows::shownMotions() const {
  std::vector<MotionId> selected;
  std::vector<MotionId> first;
  std::set<int> groups;
  for (const MotionId& id : m_workspace.motions().visibleMotions()) {
    if (m_workspace.view().selected(id)) selected.push_back(id);
    if (groups.insert(id.group).second) first.push_back(id);
  }
  return selected.empty() ? first : selected;
}

const GaitRows::Entry& GaitRows::entryOf(const ClipPtr& clip) {
  Entry& entry = m_entries[clip.get()];
  if (entry.clip) return entry;
  entry.clip = clip;
  try {
    entry.feet = stats::feetOf(*clip->skeleton, m_rule.feet);
    entry.contacts = stats::contactIntervals(*clip, entry.feet, m_rule.toleranceCmS);
  } catch (const Error&) {
    // A skeleton without feet of these names has no rows.
    entry.feet.clear();
  }
  return entry;
}

std::vector<GaitRow> GaitRows::rows(const stats::ContactRule& rule) {
  if (rule != m_rule) m_entries.clear();
  m_rule = rule;
  std::vector<MotionId> shown = shownMotions();
  m_leftOut = shown.size() > kMostMotions ? static_cast<int>(shown.size() - kMostMotions) : 0;
  shown.resize(std::min(shown.size(), kMostMotions));
  std::vector<GaitRow> out;
  std::set<const Clip*> used;
  for (const MotionId& id : shown) {
    const MotionGroup& group = *m_workspace.motions().group(id.group);
    const ClipPtr& clip = group.motions[static_cast<size_t>(id.index)].clip;
    const Entry& entry = entryOf(clip);
    used.insert(clip.get());
    for (size_t f = 0; f < entry.feet.size(); ++f) {
      const int joint = entry.feet[f];
      GaitRow row{.motion = motionLabel(group, id.index),
                  .foot = QString::fromStdString(clip->skeleton->names[static_cast<size_t>(joint)]),
                  .colour = render::colourOf(group.colourIndex),
                  .contacts = {},
                  .seconds = (clip->frameCount() - 1) / clip->fps,
                  .first = f == 0};
      for (const auto& contact : entry.contacts)
        if (contact.joint == joint)
          row.contacts.push_back({contact.beginS(clip->fps), contact.endS(clip->fps)});
      out.push_back(std::move(row));
    }
  }
  // Clips that are not shown any more are not held back.
  std::erase_if(m_entries, [&](const auto& entry) { return !used.contains(entry.first); });
  return out;
}

}  // namespace marey::gui
