#include "gui/workspace/view.h"

#include <algorithm>
#include <utility>

namespace marey::gui {

View::View(const MotionGroups& motions, QObject* parent) : QObject(parent), m_motions(motions) {
  connect(&motions, &MotionGroups::removing, this, &View::dropSelectionOf);
  // Inside what is left.
  connect(&motions, &MotionGroups::settled, this, [this] { setTime(m_time); });
}

void View::dropSelectionOf(int group) {
  Selection next = m_selection;
  std::erase_if(next.motions, [group](const MotionId& id) { return id.group == group; });
  select(std::move(next));
}

void View::select(Selection selection) {
  if (selection == m_selection) return;
  m_selection = std::move(selection);
  Q_EMIT selectionChanged();
}

void View::setTime(double seconds) {
  const double next = std::clamp(seconds, 0.0, m_motions.duration());
  if (next == m_time) return;
  m_time = next;
  Q_EMIT timeChanged(next);
}

void View::setRange(std::optional<TimeRange> range) {
  if (range && !(range->endS > range->beginS)) range.reset();
  if (range == m_range) return;
  m_range = range;
  Q_EMIT rangeChanged();
}

void View::setComparison(Comparison comparison) {
  if (comparison == m_comparison) return;
  m_comparison = comparison;
  Q_EMIT comparisonChanged();
}

void View::setContactToleranceCmS(double cmS) {
  if (cmS == m_contactCmS) return;
  m_contactCmS = cmS;
  Q_EMIT contactToleranceChanged();
}

void View::clear() {
  m_selection = {};
  m_time = 0.0;
  m_range.reset();
}

void View::tell() {
  Q_EMIT selectionChanged();
  Q_EMIT rangeChanged();
  Q_EMIT timeChanged(m_time);
}

}  // namespace marey::gui
