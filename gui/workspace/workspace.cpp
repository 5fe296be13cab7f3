#include "gui/workspace/workspace.h"

#include <algorithm>
#include <filesystem>
#include <set>
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
      m_models(std::make_shared<ModelCache>(modelFamilies())),
      m_document(std::move(experiment)),
      m_view(m_motions),
      m_natural({m_jobs, m_models, m_document, m_motions}),
      m_sampling({m_jobs, m_models, m_document, m_motions}, m_natural),
      m_kept(m_document, m_motions, m_natural, m_sampling) {
  connectPieces();
}

Workspace::~Workspace() {
  m_jobs.stop();  // running work uses the models kept here
}

void Workspace::connectPieces() {
  connect(&m_document, &Document::moving, this, &Workspace::followDocument);
  connect(&m_document, &Document::moved, this, [this](const Experiment& before) {
    const Experiment& now = m_document.experiment();
    if (now.natural != before.natural || now.fps != before.fps || now.folder != before.folder)
      m_natural.read();
    if (m_motionsFollow || measuresOtherwise(before, now)) m_motions.tell();
  });
  connect(&m_motions, &MotionGroups::pinsChanged, &m_document, &Document::changed);
  connect(&m_jobs, &JobQueue::failed, this, &Workspace::errorReported);
  connect(&m_document, &Document::failed, this, &Workspace::errorReported);
  connect(&m_natural, &NaturalMotions::failed, this, &Workspace::errorReported);
  connect(&m_sampling, &Sampling::failed, this, &Workspace::errorReported);
  connect(&m_natural, &NaturalMotions::noticed, this, &Workspace::noticed);
  connect(&m_sampling, &Sampling::noticed, this, &Workspace::noticed);
  connect(&m_kept, &KeptSets::noticed, this, &Workspace::noticed);
}

void Workspace::report(const QString& title, const QString& error) {
  Q_EMIT errorReported(title, error);
}

std::vector<std::string> Workspace::systemNames() const {
  std::vector<std::string> out;
  for (const ExperimentSystem& system : m_document.experiment().systems) out.push_back(system.name);
  return out;
}

void Workspace::followDocument(const Experiment& before) {
  followRenamed(before);
  std::set<std::string> leftOut = m_sampling.leftOut();
  std::erase_if(leftOut,
                [this](const std::string& name) { return m_document.systemIndex(name) < 0; });
  m_sampling.setLeftOut(std::move(leftOut));
  m_motionsFollow = recolour(m_motions.all(), systemNames());
  if (m_document.experiment().naturalLeftOut == before.naturalLeftOut) return;
  m_natural.followUse();
  m_motionsFollow = true;
}

void Workspace::followRenamed(const Experiment& before) {
  const Experiment& now = m_document.experiment();
  if (now.systems.size() != before.systems.size()) return;
  for (size_t i = 0; i < now.systems.size(); ++i) {
    const std::string& old = before.systems[i].name;
    const std::string& name = now.systems[i].name;
    if (old == name || now.systems[i].model != before.systems[i].model ||
        m_document.systemIndex(old) >= 0)
      continue;
    if (!m_sampling.sampled(old)) {
      m_sampling.setSampled(old, true);
      m_sampling.setSampled(name, false);
    }
    for (MotionGroup& group : m_motions.all()) {
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
  m_sampling.forget();
  cancelWork();
  ViewState view = std::exchange(experiment.view, {});
  m_document.replace(std::move(experiment), std::move(saved), file);
  m_motions.clear();
  m_sampling.setLeftOut({});
  m_view.clear();
  Q_EMIT opened();
  Q_EMIT m_document.changed();
  m_motions.tell();
  m_view.tell();
  takeView(std::move(view));
  m_natural.read();
}

void Workspace::takeView(ViewState view) {
  const auto& paths = m_document.experiment().paths;
  const auto path = std::find_if(paths.begin(), paths.end(),
                                 [&](const ExperimentPath& p) { return p.name == view.path; });
  if (path != paths.end()) m_document.setCurrentPath(static_cast<int>(path - paths.begin()));
  for (const std::string& system : view.notSampled)
    if (m_document.systemIndex(system) >= 0) m_sampling.setSampled(system, false);
  m_natural.showWhenRead(view.natural);
  m_kept.offer(view.sets);
  Q_EMIT m_document.changed();  // ticks
  m_view.setComparison(view.comparison);
  Q_EMIT m_kept.offeredChanged();
  Q_EMIT viewOpened(view);
}

Experiment Workspace::toWrite() {
  Experiment out = m_document.experiment();
  ViewState& view = out.view;
  const auto path = static_cast<size_t>(m_document.currentPath());
  if (path > 0 && path < out.paths.size()) view.path = out.paths[path].name;
  view.notSampled.assign(m_sampling.leftOut().begin(), m_sampling.leftOut().end());
  view.comparison = m_view.comparison();
  view.natural = m_natural.shown();
  view.sets = m_kept.toKeep();
  Q_EMIT viewAsked(view);
  return out;
}

void Workspace::save(const QString& file) {
  Experiment stored = toWrite();
  const fs::path path = file.toStdString();
  moveToFolder(stored, fs::absolute(path).parent_path());
  writeExperiment(path, stored);
  if (stored.view.natural) m_natural.renameSources(*stored.view.natural);
  stored.view = {};
  m_kept.setSaved();
  if (m_document.setSaved(stored, file)) m_motions.tell();
  Q_EMIT m_document.changed();
}

void Workspace::setUsed(const std::vector<MotionId>& ids, bool used) {
  std::set<std::string> natural;
  for (const MotionId& id : ids) {
    const Motion* motion = m_motions.motion(id);
    if (motion != nullptr && motion->used != used && m_motions.group(id.group)->natural())
      natural.insert(motion->clip->name);
  }
  m_motions.setUsed(ids, used);
  if (natural.empty()) return;
  m_document.edit(used ? tr("Use clips") : tr("Leave clips out"), [&](Experiment& e) {
    std::erase_if(e.naturalLeftOut,
                  [&](const std::string& name) { return natural.contains(name); });
    if (!used) e.naturalLeftOut.insert(e.naturalLeftOut.end(), natural.begin(), natural.end());
  });
}

std::vector<int> Workspace::feet() const {
  const auto body = m_motions.skeleton();
  if (!body) return {};
  try {
    return stats::feetOf(*body, m_document.experiment().feet);
  } catch (const InputError&) {
    return {};  // a skeleton without feet: nothing to count
  }
}

std::vector<std::string> Workspace::motionTypes() const {
  return marey::motionTypes(m_document.experiment(), m_models->held());
}

stats::ContactRule Workspace::contactRule() const {
  return {.toleranceCmS = m_view.contactToleranceCmS(), .feet = m_document.experiment().feet};
}

void Workspace::cancelWork() {
  m_jobs.cancelLane(Lane::Models);
  m_jobs.cancelLane(Lane::Files);
}

}  // namespace marey::gui
