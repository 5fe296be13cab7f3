#include "shell/workspace.h"

#include <QPointer>
#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "families.h"

#include "base/error.h"
#include "experiment/edits.h"
#include "experiment/run.h"
#include "stats/footsteps.h"

namespace marey::gui {
namespace {
namespace fs = std::filesystem;

/// Motions that advance together while a set is drawn: the first ones are shown soon.
constexpr int kFirstMotions = 10;
/// Natural clips that are shown at first: a thousand over each other would show nothing.
constexpr size_t kNaturalShown = 3;
}  // namespace

/// Weights by file and time of writing, shared by the threads that draw samples.
struct Workspace::ModelCache {
  struct Entry {
    fs::file_time_type written;
    std::shared_ptr<const MotionModel> model;
  };
  std::mutex mutex;
  std::map<std::string, Entry> models;
};

Workspace::Workspace(JobQueue& jobs, Experiment experiment, QObject* parent)
    : QObject(parent),
      m_jobs(jobs),
      m_history(experiment),
      m_saved(std::move(experiment)),
      m_models(std::make_shared<ModelCache>()) {
  connect(&m_jobs, &JobQueue::failed, this, &Workspace::errorReported);
}

Workspace::~Workspace() {
  m_jobs.stop();  // running work uses the models kept here
}

void Workspace::report(const QString& title, const QString& error) {
  Q_EMIT errorReported(title, error);
}

// The document.

void Workspace::edit(const QString& label, const std::function<void(Experiment&)>& change,
                     bool amend) {
  const Experiment before = experiment();
  Experiment next = before;
  try {
    change(next);
  } catch (const Error& error) {
    report(label, QString::fromStdString(error.what()));
    return;
  }
  const bool changed = amend ? m_history.amend(std::move(next), label.toStdString())
                             : m_history.commit(std::move(next), label.toStdString());
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
  Q_EMIT documentChanged();
  const bool otherNatural =
      now.natural != before.natural || now.fps != before.fps || now.folder != before.folder;
  if (otherNatural) readNatural();
  // A system keeps its colour by its place in the document.
  for (MotionGroup& group : m_groups) {
    if (group.natural()) continue;
    const int index = systemIndex(group.system);
    if (index >= 0) group.colourIndex = index;
  }
  Q_EMIT motionsChanged();
  Q_EMIT visibilityChanged();
}

void Workspace::open(Experiment experiment, const QString& file) {
  m_jobs.cancelAll();
  m_saved = experiment;
  m_history = History<Experiment>(std::move(experiment));
  m_file = file;
  m_currentPath = 0;
  m_groups.clear();
  m_naturalScores.clear();
  m_scoring.clear();
  m_selection = {};
  m_time = 0.0;
  m_range.reset();
  Q_EMIT documentOpened();
  Q_EMIT documentChanged();
  Q_EMIT motionsChanged();
  Q_EMIT visibilityChanged();
  Q_EMIT selectionChanged();
  Q_EMIT rangeChanged();
  Q_EMIT timeChanged(0.0);
  readNatural();
}

void Workspace::save(const QString& file) {
  Experiment moved = experiment();
  const fs::path path = file.toStdString();
  moveToFolder(moved, fs::absolute(path).parent_path());
  writeExperiment(path, moved);
  m_file = file;
  m_saved = moved;
  if (m_history.commit(moved, "Save in another folder")) Q_EMIT motionsChanged();
  Q_EMIT documentChanged();
}

void Workspace::setCurrentPath(int index) {
  if (index == m_currentPath || index < 0 || index >= static_cast<int>(experiment().paths.size()))
    return;
  m_currentPath = index;
  Q_EMIT currentPathChanged();
}

// Background work.

void Workspace::readNatural() {
  const int version = ++m_naturalVersion;
  m_naturalScores.clear();
  m_scoring.clear();
  auto clips = std::make_shared<std::vector<Clip>>();
  const Experiment document = experiment();
  m_jobs.start(
      Lane::Files, tr("Reading natural motion"),
      [clips, document](Progress& progress) { *clips = naturalClips(document, progress); },
      [this, clips, version] {
        if (version != m_naturalVersion) return;
        MotionGroup group{.id = m_nextGroup++, .name = "Natural"};
        group.motions.reserve(clips->size());
        for (Clip& clip : *clips) {
          const bool shown = group.motions.size() < kNaturalShown;
          group.motions.push_back({std::make_shared<const Clip>(std::move(clip)), {}, shown});
        }
        for (const MotionGroup& old : m_groups)
          if (old.natural()) dropSelectionOf(old.id);
        std::erase_if(m_groups, [](const MotionGroup& g) { return g.natural(); });
        m_groups.insert(m_groups.begin(), std::move(group));
        Q_EMIT motionsChanged();
        Q_EMIT visibilityChanged();
        Q_EMIT naturalScoresChanged();
      });
}

std::string Workspace::modelFile(const ExperimentSystem& system) const {
  return (experiment().folder / system.model).string();
}

std::shared_ptr<const MotionModel> Workspace::model(const std::string& file) const {
  std::error_code none;
  const auto written = fs::last_write_time(file, none);
  const std::lock_guard lock(m_models->mutex);
  auto& entry = m_models->models[file];
  if (!entry.model || entry.written != written) {
    entry.model = loadModel(file, modelFamilies());
    entry.written = written;
  }
  return entry.model;
}

void Workspace::sample(const SampleRecipe& recipe, int replaceGroup, int colourIndex) {
  const int known = systemIndex(recipe.system.name);
  const MotionGroup* old = this->group(replaceGroup);
  const int index = known >= 0 ? known : std::max(0, old ? old->colourIndex : colourIndex);
  MotionGroup group{.id = m_nextGroup++,
                    .name = recipe.system.name + " – " + recipe.path.name,
                    .system = recipe.system.name,
                    .colourIndex = index,
                    .complete = false,
                    .recipe = recipe};
  const int id = group.id;
  if (replaceGroup >= 0) removeGroup(replaceGroup);
  m_groups.push_back(std::move(group));
  Q_EMIT motionsChanged();
  const std::string file = (recipe.folder / recipe.system.model).string();
  const QPointer<Workspace> self(this);
  auto hash = std::make_shared<std::string>();
  const auto work = [self, this, file, recipe, id, hash](Progress& progress) {
    const auto weights = model(file);
    if (std::abs(weights->info().features.fps - recipe.fps) > 1e-6)
      throwInput({.path = file}, fmt::format("a model at the document's {} fps", recipe.fps), "{}",
                 weights->info().features.fps);
    *hash = weights->info().hash;
    drawSampleSet(
        *weights, recipe, progress, kFirstMotions,
        [self, id](const std::vector<RootFrame>& wanted, std::vector<SampledMotion> motions) {
          QMetaObject::invokeMethod(
              self.data(),
              [self, id, wanted, motions = std::move(motions)]() mutable {
                if (self) self->addMotions(id, wanted, std::move(motions));
              },
              Qt::QueuedConnection);
        });
  };
  const QString title = tr("Sampling %1").arg(QString::fromStdString(findGroup(id)->name));
  const int job = m_jobs.start(Lane::Models, title, work);
  auto connection = std::make_shared<QMetaObject::Connection>();
  *connection = connect(&m_jobs, &JobQueue::ended, this,
                        [this, connection, job, id, hash](int ended, bool successful) {
                          if (ended != job) return;
                          disconnect(*connection);
                          finishGroup(id, *hash, successful);
                        });
}

void Workspace::finishGroup(int id, const std::string& modelHash, bool successful) {
  MotionGroup* group = findGroup(id);
  if (group == nullptr) return;
  group->modelHash = modelHash;
  group->complete = successful;
  // What a cancelled run has drawn stays; a set without any motion is of no use.
  if (!successful && group->motions.empty()) return removeGroup(id);
  Q_EMIT motionsChanged();
}

void Workspace::addMotions(int id, const std::vector<RootFrame>& wanted,
                           std::vector<SampledMotion> motions) {
  MotionGroup* group = findGroup(id);
  if (group == nullptr) return;
  group->wanted = wanted;
  for (SampledMotion& motion : motions)
    group->motions.push_back({std::move(motion.clip), std::move(motion.score), true});
  Q_EMIT motionsChanged();
  Q_EMIT visibilityChanged();
}

void Workspace::sampleCurrentPath() {
  const Experiment& e = experiment();
  if (e.systems.empty() || e.paths.empty()) {
    report(tr("Sampling"), tr("There is nothing to sample yet: the document needs a model and a "
                              "path."));
    return;
  }
  const ExperimentPath& path = e.paths[static_cast<size_t>(m_currentPath)];
  for (const ExperimentSystem& system : e.systems) {
    int old = -1;
    for (const MotionGroup& group : m_groups)
      if (group.recipe && !group.pinned && group.system == system.name &&
          group.recipe->path.name == path.name)
        old = group.id;
    sample({.system = system,
            .path = path,
            .samples = e.samples,
            .seed = e.seed,
            .fps = e.fps,
            .folder = e.folder},
           old);
  }
}

const std::vector<ClipScore>* Workspace::naturalScores(const std::string& system) const {
  const auto found = m_naturalScores.find(system);
  return found == m_naturalScores.end() ? nullptr : &found->second;
}

void Workspace::scoreNatural(const std::string& system) {
  const int index = systemIndex(system);
  const auto natural = std::find_if(m_groups.begin(), m_groups.end(),
                                    [](const MotionGroup& g) { return g.natural(); });
  if (index < 0 || natural == m_groups.end() || !m_scoring.insert(system).second) return;
  std::vector<ClipPtr> clips;
  for (const Motion& motion : natural->motions) clips.push_back(motion.clip);
  const std::string file = modelFile(experiment().systems[static_cast<size_t>(index)]);
  auto scores = std::make_shared<std::vector<ClipScore>>();
  const int version = m_naturalVersion;
  m_jobs.start(
      Lane::Models, tr("Scoring natural motion under %1").arg(QString::fromStdString(system)),
      [this, clips, file, scores](Progress& progress) {
        const auto weights = model(file);
        for (size_t i = 0; i < clips.size(); ++i) {
          progress.throwIfCancelled();
          const bool longEnough = clips[i]->frameCount() > weights->info().context;
          scores->push_back(longEnough ? scoreClip(*weights, *clips[i]) : ClipScore{});
          progress.report(static_cast<double>(i + 1) / static_cast<double>(clips.size()));
        }
      },
      [this, scores, system, version] {
        if (version != m_naturalVersion) return;
        m_naturalScores[system] = std::move(*scores);
        Q_EMIT naturalScoresChanged();
      });
}

// Motions.

MotionGroup* Workspace::findGroup(int id) {
  const auto found = std::find_if(m_groups.begin(), m_groups.end(),
                                  [id](const MotionGroup& group) { return group.id == id; });
  return found == m_groups.end() ? nullptr : &*found;
}

const MotionGroup* Workspace::group(int id) const {
  return const_cast<Workspace*>(this)->findGroup(id);
}

const Motion* Workspace::motion(const MotionId& id) const {
  const MotionGroup* owner = group(id.group);
  if (owner == nullptr || id.index < 0 || id.index >= static_cast<int>(owner->motions.size()))
    return nullptr;
  return &owner->motions[static_cast<size_t>(id.index)];
}

int Workspace::systemIndex(const std::string& name) const {
  const auto& systems = experiment().systems;
  for (size_t i = 0; i < systems.size(); ++i)
    if (systems[i].name == name) return static_cast<int>(i);
  return -1;
}

void Workspace::setVisible(int id, bool visible) {
  MotionGroup* group = findGroup(id);
  if (group == nullptr) return;
  for (Motion& motion : group->motions) motion.visible = visible;
  Q_EMIT visibilityChanged();
}

void Workspace::setVisible(const MotionId& id, bool visible) {
  if (motion(id) == nullptr || motion(id)->visible == visible) return;
  findGroup(id.group)->motions[static_cast<size_t>(id.index)].visible = visible;
  Q_EMIT visibilityChanged();
}

void Workspace::setPinned(int id, bool pinned) {
  if (MotionGroup* group = findGroup(id)) {
    group->pinned = pinned;
    Q_EMIT motionsChanged();
  }
}

void Workspace::removeGroup(int id) {
  dropSelectionOf(id);
  if (std::erase_if(m_groups, [id](const MotionGroup& group) { return group.id == id; }) == 0)
    return;
  Q_EMIT motionsChanged();
  Q_EMIT visibilityChanged();
}

int Workspace::addGroup(MotionGroup group) {
  group.id = m_nextGroup++;
  const int id = group.id;
  m_groups.push_back(std::move(group));
  Q_EMIT motionsChanged();
  Q_EMIT visibilityChanged();
  return id;
}

void Workspace::setMotions(int id, std::vector<Motion> motions) {
  MotionGroup* group = findGroup(id);
  if (group == nullptr) return;
  group->motions = std::move(motions);
  Q_EMIT motionsChanged();
  Q_EMIT visibilityChanged();
}

std::vector<MotionId> Workspace::visibleMotions() const {
  std::vector<MotionId> out;
  for (const MotionGroup& group : m_groups)
    for (size_t i = 0; i < group.motions.size(); ++i)
      if (group.motions[i].visible) out.push_back({group.id, static_cast<int>(i)});
  return out;
}

std::shared_ptr<const Skeleton> Workspace::skeleton() const {
  for (const MotionGroup& group : m_groups)
    if (!group.motions.empty()) return group.motions.front().clip->skeleton;
  return nullptr;
}

std::vector<int> Workspace::feet() const {
  const auto body = skeleton();
  if (!body) return {};
  try {
    return stats::feetOf(*body, experiment().feet);
  } catch (const InputError&) {
    return {};  // a skeleton without feet: nothing to count
  }
}

// Selection and time.

void Workspace::dropSelectionOf(int group) {
  Selection next = m_selection;
  std::erase_if(next.motions, [group](const MotionId& id) { return id.group == group; });
  select(std::move(next));
}

void Workspace::select(Selection selection) {
  if (selection == m_selection) return;
  m_selection = std::move(selection);
  Q_EMIT selectionChanged();
}

double Workspace::duration() const {
  double longest = 0.0;
  for (const MotionGroup& group : m_groups)
    for (const Motion& motion : group.motions)
      if (motion.visible)
        longest = std::max(longest, (motion.clip->frameCount() - 1) / motion.clip->fps);
  return longest;
}

void Workspace::setTime(double seconds) {
  const double next = std::clamp(seconds, 0.0, duration());
  if (next == m_time) return;
  m_time = next;
  Q_EMIT timeChanged(next);
}

void Workspace::setRange(std::optional<TimeRange> range) {
  if (range && !(range->endS > range->beginS)) range.reset();
  if (range == m_range) return;
  m_range = range;
  Q_EMIT rangeChanged();
}

ClipPtr Workspace::clipInRange(const MotionId& id) const {
  const Motion* found = motion(id);
  if (found == nullptr) return nullptr;
  if (!m_range) return found->clip;
  const Clip& clip = *found->clip;
  const int first = std::max(0, static_cast<int>(std::ceil(m_range->beginS * clip.fps - 1e-9)));
  const int last = std::min(clip.frameCount(),
                            static_cast<int>(std::floor(m_range->endS * clip.fps + 1e-9)) + 1);
  if (first >= last) return nullptr;
  return std::make_shared<const Clip>(sliceFrames(clip, first, last));
}

}  // namespace marey::gui
