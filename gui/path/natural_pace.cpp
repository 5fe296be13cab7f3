#include "gui/path/natural_pace.h"

#include <memory>

#include "gui/plots/motion_sets.h"

#include "experiment/natural_pace.h"
#include "model/model_cache.h"

namespace marey::gui {

NaturalPace::NaturalPace(Workspace& workspace, QObject* parent)
    : QObject(parent), m_workspace(workspace) {
  connect(&workspace.motions(), &MotionGroups::changed, this, &NaturalPace::refresh);
  connect(&workspace.document(), &Document::changed, this, &NaturalPace::refresh);
  refresh();
}

std::vector<NaturalPace::Source> NaturalPace::models() const {
  std::vector<Source> out;
  for (const ExperimentSystem& system : m_workspace.document().experiment().systems) {
    const std::string file = m_workspace.document().modelFile(system);
    out.push_back({system.name, file, ModelCache::stampOf(file)});
  }
  return out;
}

std::vector<ClipPtr> NaturalPace::naturalClips() const {
  // What plots count as natural motion: an odd file among them cannot stop the measurement.
  for (const MotionSet& set : motionSets(m_workspace.motions().groups()))
    if (set.natural) return set.clips;
  return {};
}

void NaturalPace::refresh() {
  std::vector<Source> models = this->models();
  std::vector<ClipPtr> clips = naturalClips();
  if (models == m_models && clips == m_clips) return;
  m_models = std::move(models);
  m_clips = std::move(clips);
  const int version = ++m_version;
  m_range.reset();
  Q_EMIT changed();
  if (m_clips.empty() && m_models.empty()) return;
  const auto result = std::make_shared<std::optional<PaceRange>>();
  m_workspace.jobs().start(
      Lane::Files, tr("Measure natural speeds and turns"),
      [models = m_models, clips = m_clips, result](Progress& progress) {
        std::vector<PaceModel> files;
        files.reserve(models.size());
        for (const Source& model : models) files.push_back({model.name, model.file});
        *result = naturalPace(files, clips, progress);
      },
      [this, result, version] {
        if (m_version != version) return;
        m_range = *result;
        Q_EMIT changed();
      },
      this);
}

}  // namespace marey::gui
