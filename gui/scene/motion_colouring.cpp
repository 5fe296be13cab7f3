#include "gui/scene/motion_colouring.h"

#include <QPointer>

namespace marey::gui {

MotionColouring::MotionColouring(Workspace& workspace, QObject* parent)
    : QObject(parent), m_workspace(workspace) {
  // New scores may lie where old ones did.
  connect(&workspace.natural(), &NaturalMotions::scoresChanged, this,
          [this] { m_sources.clear(); });
}

const MotionColours& MotionColouring::of(const std::vector<ColourSource>& sources, ColourBy by,
                                         double modelFps) {
  if (sources == m_sources && by == m_by) return m_colours;
  if (by != m_by) m_colours = {};
  m_sources = sources;
  m_by = by;
  const int version = ++m_version;
  m_workspace.jobs().cancel(m_job);
  std::vector<std::pair<ClipPtr, std::optional<ClipScore>>> from;
  for (const ColourSource& source : sources) {
    from.emplace_back(source.clip, std::nullopt);
    if (source.score && by == ColourBy::Likelihood) from.back().second = *source.score;
  }
  const auto result = std::make_shared<MotionColours>();
  const QPointer<MotionColouring> self(this);
  m_job = m_workspace.jobs().start(
      Lane::Previews, tr("Colouring motions"),
      [from = std::move(from), by, modelFps, result](Progress& progress) {
        *result = coloursByValue(from, by, modelFps, progress);
      },
      [self, result, version] {
        if (!self || self->m_version != version) return;
        self->m_colours = std::move(*result);
        Q_EMIT self->changed();
      });
  return m_colours;
}

}  // namespace marey::gui
