#include "panels/natural_pace.h"

#include <QPointer>
#include <memory>

namespace marey::gui {

NaturalPace::NaturalPace(Workspace& workspace, QObject* parent)
    : QObject(parent), m_workspace(workspace) {
  connect(&workspace, &Workspace::motionsChanged, this, &NaturalPace::refresh);
  refresh();
}

void NaturalPace::refresh() {
  std::vector<ClipPtr> clips;
  for (const MotionGroup& group : m_workspace.groups()) {
    // While motions are being added, each addition would start the measurement anew.
    if (!group.natural() || !group.complete) continue;
    for (const Motion& motion : group.motions) clips.push_back(motion.clip);
  }
  if (clips == m_clips) return;
  m_clips = std::move(clips);
  const int version = ++m_version;
  m_range.reset();
  Q_EMIT changed();
  if (m_clips.empty()) return;
  const auto result = std::make_shared<std::optional<PaceRange>>();
  const QPointer<NaturalPace> self = this;
  m_workspace.jobs().start(
      Lane::Files, tr("Measure natural speeds and turns"),
      [clips = m_clips, result](Progress& progress) { *result = paceOf(clips, progress); },
      [self, result, version] {
        if (!self || self->m_version != version) return;
        self->m_range = *result;
        Q_EMIT self->changed();
      });
}

}  // namespace marey::gui
