// What every view of the motions has in common: what is lit up, when, and how it is measured.
#pragma once

#include <QObject>
#include <optional>

#include "gui/workspace/motion_groups.h"

#include "experiment/view_state.h"
#include "stats/footsteps.h"

namespace marey::gui {

class View : public QObject {
  Q_OBJECT
 public:
  explicit View(const MotionGroups& motions, QObject* parent = nullptr);

  const Selection& selection() const { return m_selection; }
  void select(Selection selection);
  bool selected(const MotionId& id) const { return m_selection.motions.contains(id); }
  double time() const { return m_time; }
  void setTime(double seconds);  ///< kept inside 0 to the motions' duration
  const std::optional<TimeRange>& range() const { return m_range; }
  void setRange(std::optional<TimeRange> range);
  /// What plots compare: motions along a path, or those along held-out control.
  Comparison comparison() const { return m_comparison; }
  void setComparison(Comparison comparison);
  /// The one speed below which a foot counts as resting, for the timeline and the 3D view alike.
  double contactToleranceCmS() const { return m_contactCmS; }
  void setContactToleranceCmS(double cmS);
  /// Of another document: nothing is lit up, time starts anew. Tells nobody.
  void clear();
  /// Tells all, as if all had changed.
  void tell();

 Q_SIGNALS:
  void selectionChanged();
  void timeChanged(double seconds);
  void rangeChanged();
  void comparisonChanged();
  void contactToleranceChanged();

 private:
  void dropSelectionOf(int group);

  const MotionGroups& m_motions;
  Selection m_selection;
  double m_time = 0.0;
  std::optional<TimeRange> m_range;
  Comparison m_comparison = Comparison::ThisPath;
  double m_contactCmS = stats::ContactRule{}.toleranceCmS;
};

}  // namespace marey::gui
