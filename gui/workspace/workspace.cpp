// The document and its history.
#include "gui/workspace/workspace.h"

#include <algorithm>
#include <utility>

#include "families.h"

#include "base/error.h"
#include "experiment/edits.h"

namespace marey::gui {
namespace {
namespace fs = std::filesystem;

/// Whether plots of the same motions come out otherwise.
bool measuresOtherwise(const Experiment& a, const Experiment& b) {
  const auto same = [](const ExperimentSystem& x, const ExperimentSystem& y) {
    return x.name == y.name && x.model == y.model;
  };
  return a.feet != b.feet || a.toleranceStepCmS != b.toleranceStepCmS || a.fps != b.fps ||
         a.folder != b.folder ||
         !std::equal(a.systems.begin(), a.systems.end(), b.systems.begin(), b.systems.end(), same);
}

}  // namespace

Workspace::Workspace(JobQueue& jobs, Experiment experiment, QObject* parent)
    : QObject(parent),
      m_jobs(jobs),
      m_history(experiment),
      m_saved(std::move(experiment)),
      m_models(std::make_shared<ModelCache>(modelFamilies())) {
  connect(&m_jobs, &JobQueue::failed, this, &Workspace::errorReported);
  connect(&m_jobs, &JobQueue::ended, this, &Workspace::jobEnded);
}

Workspace::~Workspace() {
  m_jobs.stop();  // running work uses the models kept here
}

void Workspace::report(const QString& title, const QString& error) {
  Q_EMIT errorReported(title, error);
}

void Workspace::edit(const QString& label, const std::function<void(Experiment&)>& change,
                     bool amend) {
  const Experiment before = experiment();
  Experiment next = before;
  try {
    change(next);
    next = asStored(next);
  } catch (const std::exception& error) {
    report(label, QString::fromUtf8(error.what()));
    return;
  }
  const std::string place = changedPlace(before, next);
  const bool changed = amend ? m_history.amend(std::move(next), label.toStdString(), place)
                             : m_history.commit(std::move(next), label.toStdString(), place);
  if (changed) documentMoved(before);
}

void Workspace::undo() {
  const Experiment before = experiment();
  m_history.undo();
  documentMoved(before);
}

void Workspace::redo() {
  const Experiment before = experiment();
  m_history.redo();
  documentMoved(before);
}

void Workspace::goToEdit(size_t index) {
  const Experiment before = experiment();
  m_history.goTo(index);
  documentMoved(before);
}

void Workspace::documentMoved(const Experiment& before) {
  const Experiment& now = experiment();
  const int paths = static_cast<int>(now.paths.size());
  m_currentPath = std::clamp(m_currentPath, 0, std::max(0, paths - 1));
  followRenamed(before);
  std::erase_if(m_leftOut, [this](const std::string& name) { return systemIndex(name) < 0; });
  bool changed = recolour();
  if (now.naturalLeftOut != before.naturalLeftOut) {
    followUse();
    changed = true;
  }
  Q_EMIT documentChanged();
  if (now.natural != before.natural || now.fps != before.fps || now.folder != before.folder)
    readNatural();
  if (changed || measuresOtherwise(before, now)) tellMotions();
}

void Workspace::followRenamed(const Experiment& before) {
  const Experiment& now = experiment();
  if (now.systems.size() != before.systems.size()) return;
  for (size_t i = 0; i < now.systems.size(); ++i) {
    const std::string& old = before.systems[i].name;
    const std::string& name = now.systems[i].name;
    if (old == name || now.systems[i].model != before.systems[i].model || systemIndex(old) >= 0)
      continue;
    if (m_leftOut.erase(old) > 0) m_leftOut.insert(name);
    for (MotionGroup& group : m_groups) {
      if (group.system != old) continue;
      group.system = name;
      if (group.name.starts_with(old)) group.name.replace(0, old.size(), name);
      if (group.recipe) group.recipe->system.name = name;
    }
  }
}

void Workspace::open(Experiment experiment, const QString& file) {
  Experiment saved = experiment;
  start(std::move(experiment), std::move(saved), file);
}

void Workspace::openUnsaved(Experiment experiment, const QString& file) {
  start(std::move(experiment), std::nullopt, file);
}

void Workspace::start(Experiment experiment, std::optional<Experiment> saved, const QString& file) {
  m_drawings.clear();
  cancelWork();
  ViewState view = std::exchange(experiment.view, {});
  m_saved = std::move(saved);
  m_history = History<Experiment>(std::move(experiment));
  m_file = file;
  m_currentPath = 0;
  m_groups.clear();
  m_aside.clear();
  m_leftOut.clear();
  m_selection = {};
  m_time = 0.0;
  m_range.reset();
  Q_EMIT documentOpened();
  Q_EMIT documentChanged();
  tellMotions();
  Q_EMIT selectionChanged();
  Q_EMIT rangeChanged();
  Q_EMIT timeChanged(0.0);
  takeView(std::move(view));
  readNatural();
}

void Workspace::save(const QString& file) {
  Experiment moved = document();
  const fs::path path = file.toStdString();
  moveToFolder(moved, fs::absolute(path).parent_path());
  writeExperiment(path, moved);
  if (moved.view.natural) renameSources(*moved.view.natural);
  moved.view = {};
  m_file = file;
  m_saved = moved;
  m_savedPins = pinnedSets();
  if (m_history.commit(moved, "Save in another folder")) tellMotions();
  // What is edited next is another edit, so that undo comes back to what was saved.
  m_history.seal();
  Q_EMIT documentChanged();
}

void Workspace::setCurrentPath(int index) {
  if (index == m_currentPath || index < 0 || index >= static_cast<int>(experiment().paths.size()))
    return;
  m_currentPath = index;
  Q_EMIT currentPathChanged();
}

std::vector<std::string> Workspace::motionTypes() const {
  return marey::motionTypes(experiment(), m_models->held());
}

std::string Workspace::modelFile(const ExperimentSystem& system) const {
  return (experiment().folder / system.model).string();
}

int Workspace::systemIndex(const std::string& name) const {
  const auto& systems = experiment().systems;
  for (size_t i = 0; i < systems.size(); ++i)
    if (systems[i].name == name) return static_cast<int>(i);
  return -1;
}

}  // namespace marey::gui
