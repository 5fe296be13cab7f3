// The motions that are looked at: natural clips and sample sets, which of them are shown and
// pinned.
#pragma once

#include <QObject>
#include <memory>
#include <set>
#include <vector>

#include "experiment/motions.h"

namespace marey::gui {

class MotionGroups : public QObject {
  Q_OBJECT
 public:
  using QObject::QObject;

  const std::vector<MotionGroup>& groups() const { return m_groups; }
  const MotionGroup* group(int id) const;  ///< null where there is none
  const Motion* motion(const MotionId& id) const;
  const MotionGroup* natural() const;  ///< null until natural clips are read
  /// Visible motions in the order of groups.
  std::vector<MotionId> visibleMotions() const;
  double duration() const;  ///< seconds of the longest visible motion; 0 without one
  /// That most motions of the first group have; null without motions.
  std::shared_ptr<const Skeleton> skeleton() const;

  void setVisible(int group, bool visible);
  void setVisible(const MotionId& id, bool visible);
  void setVisible(const std::vector<MotionId>& ids, bool visible);
  /// Hides all others.
  void showOnly(const std::set<MotionId>& shown);
  void setPinned(int group, bool pinned);
  /// Whether plots and statistics count samples, shown or hidden (natural clips: see Workspace).
  void setUsed(const std::vector<MotionId>& ids, bool used);

  /// A group that was made elsewhere (a steered motion); returns the id that it gets.
  int add(MotionGroup group);
  /// The natural clips in place of earlier ones; an empty group takes these away.
  void setNatural(MotionGroup group);
  /// Other motions in place of a group's; nothing where there is no such group.
  void setMotions(int group, std::vector<Motion> motions);
  void remove(int group);
  /// The same, but bringBack() has it again: samples are no part of the document's history.
  void setAside(int group);
  /// The last groups that were set aside in this document, the latest at the end.
  const std::vector<MotionGroup>& aside() const { return m_aside; }
  void bringBack();
  /// Forgets all, and tells nobody: changed() is due once the next document is there.
  void clear();

  /// For those that fill and mark groups, who then tell().
  MotionGroup* find(int group);
  std::vector<MotionGroup>& all() { return m_groups; }
  void tell();
  void tellVisibility();

 Q_SIGNALS:
  void changed();            ///< groups or their motions, or how the document measures them
  void visibilityChanged();  ///< after changed() too
  void settled();            ///< after visibilityChanged(), when all who show them have followed
  void pinsChanged();        ///< what a document keeps of sets
  void removing(int group);

 private:
  int m_nextId = 1;
  std::vector<MotionGroup> m_groups, m_aside;
};

/// A system of the document has the colour of its place there; other sets keep theirs unless a
/// system needs it. `systems` are the names of the document's. Returns whether any changed.
bool recolour(std::vector<MotionGroup>& groups, const std::vector<std::string>& systems);

}  // namespace marey::gui
