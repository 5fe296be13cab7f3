// Work in the background: reading, sampling, scoring.
#include <QCoreApplication>
#include <QPointer>
#include <algorithm>
#include <cmath>

#include "gui/workspace/workspace.h"

#include "base/error.h"
#include "motion/main_body.h"

namespace marey::gui {
namespace {

/// Motions that advance together at first while a set is drawn: the first ones are shown soon.
constexpr int kFirstMotions = 10;
/// Lines of a message about files that could not be read.
constexpr size_t kMostFaults = 8;

QString faultText(const std::vector<std::string>& faults) {
  QStringList lines;
  for (size_t i = 0; i < std::min(faults.size(), kMostFaults); ++i)
    lines += QString::fromStdString(faults[i]);
  if (faults.size() > kMostFaults)
    lines += Workspace::tr("and %1 more").arg(faults.size() - kMostFaults);
  lines += Workspace::tr("The rest is shown. File ▸ Reload natural motion tries again.");
  return lines.join(u'\n');
}

/// A clip of another skeleton than the model's leaves the others alone: its score has no name, and
/// panels count it.
std::vector<ClipScore> scoresOf(const MotionModel& model, const std::vector<ClipPtr>& clips,
                                Progress& progress) {
  std::vector<Clip> fitting;
  std::vector<size_t> places;
  for (size_t i = 0; i < clips.size(); ++i) {
    if (!whyNotScored(model.info(), *clips[i]).empty()) continue;
    fitting.push_back(*clips[i]);
    places.push_back(i);
  }
  std::vector<ClipScore> out(clips.size());
  auto scores = scoreClips(model, fitting, false, progress);
  for (size_t k = 0; k < places.size(); ++k) out[places[k]] = std::move(scores[k]);
  return out;
}

/// Clips of another skeleton than most: they are shown, but nothing can compare them.
QString oddText(const MotionGroup& natural) {
  std::vector<const Skeleton*> bodies;
  for (const Motion& motion : natural.motions) bodies.push_back(motion.clip->skeleton.get());
  const int main = mainBody(bodies);
  std::vector<std::string> odd;
  for (const Motion& motion : natural.motions)
    if (const Skeleton& body = *motion.clip->skeleton;
        main >= 0 && !sameJoints(body, *bodies[static_cast<size_t>(main)]))
      odd.push_back(motion.clip->name + ": " +
                    otherJoints(body, *bodies[static_cast<size_t>(main)]));
  if (odd.empty()) return {};
  QStringList lines;
  for (size_t i = 0; i < std::min(odd.size(), kMostFaults); ++i)
    lines += QString::fromStdString(odd[i]);
  if (odd.size() > kMostFaults) lines += Workspace::tr("and %1 more").arg(odd.size() - kMostFaults);
  lines += Workspace::tr(
               "%1 of %2 natural clips are shown but not counted: their joints are not "
               "those that most clips have.")
               .arg(odd.size())
               .arg(natural.motions.size());
  return lines.join(u'\n');
}

}  // namespace

void Workspace::cancelWork() {
  m_jobs.cancelLane(Lane::Models);
  m_jobs.cancelLane(Lane::Files);
}

void Workspace::jobEnded(int job, bool successful) {
  std::erase_if(m_scoring, [job](const auto& entry) { return entry.second == job; });
  // The last motions may still be on their way here.
  if (!m_drawings.empty()) QCoreApplication::sendPostedEvents(this, QEvent::MetaCall);
  const auto found = std::find_if(m_drawings.begin(), m_drawings.end(),
                                  [job](const auto& entry) { return entry.second.job == job; });
  if (found == m_drawings.end()) return;
  const auto [group, drawing] = *found;
  m_drawings.erase(found);
  finishGroup(group, drawing, successful);
}

// Natural motion.

void Workspace::readNatural() {
  const int version = ++m_naturalVersion;
  m_naturalScores.clear();
  const auto scoring = std::move(m_scoring);
  m_scoring.clear();
  for (const auto& [model, job] : scoring) m_jobs.cancel(job);
  m_jobs.cancel(m_naturalJob);
  const Experiment document = experiment();
  if (document.natural.empty()) return takeNatural({});
  auto natural = std::make_shared<NaturalMotion>();
  m_naturalJob = m_jobs.start(
      Lane::Files, tr("Reading natural motion"),
      [natural, document](Progress& progress) { *natural = readableNatural(document, progress); },
      [this, natural, version] {
        if (version == m_naturalVersion) takeNatural(std::move(*natural));
      },
      this);
}

void Workspace::takeNatural(NaturalMotion natural) {
  MotionGroup group{.id = m_nextGroup++, .name = "Natural"};
  group.motions.reserve(natural.clips.size());
  for (size_t i = 0; i < natural.clips.size(); ++i)
    group.motions.push_back({.clip = std::make_shared<const Clip>(std::move(natural.clips[i])),
                             .score = {},
                             .visible = false,
                             .source = std::move(natural.sources[i])});
  showNatural(group);
  for (const MotionGroup& old : m_groups)
    if (old.natural()) dropSelectionOf(old.id);
  std::erase_if(m_groups, [](const MotionGroup& g) { return g.natural(); });
  dropHeldOut();
  const QString odd = oddText(group);
  m_naturalInputs = std::move(natural.inputs);
  if (!group.motions.empty()) m_groups.insert(m_groups.begin(), std::move(group));
  followUse();
  tellMotions();
  Q_EMIT naturalScoresChanged();
  if (!natural.faults.empty()) report(tr("Reading natural motion"), faultText(natural.faults));
  if (!odd.isEmpty()) report(tr("Comparing natural motion"), odd);
  io::InputReport all;
  for (const auto& [source, inputs] : m_naturalInputs) all.add(inputs);
  if (const std::string missing = all.missingText(); !missing.empty())
    Q_EMIT noticed(
        tr("Natural motion: %1; the tip of its row in Motions lists them with the reasons")
            .arg(QString::fromStdString(missing)));
}

const std::vector<ClipScore>* Workspace::naturalScores(const std::string& system) const {
  const int index = systemIndex(system);
  if (index < 0 || m_naturalScores.empty()) return nullptr;
  const std::string file = modelFile(experiment().systems[static_cast<size_t>(index)]);
  const auto found = m_naturalScores.find(ModelCache::stampOf(file));
  return found == m_naturalScores.end() ? nullptr : &found->second;
}

void Workspace::scoreNatural(const std::string& system) {
  const int index = systemIndex(system);
  const auto natural = std::find_if(m_groups.begin(), m_groups.end(),
                                    [](const MotionGroup& g) { return g.natural(); });
  if (index < 0 || natural == m_groups.end()) return;
  const std::string file = modelFile(experiment().systems[static_cast<size_t>(index)]);
  const std::string stamp = ModelCache::stampOf(file);
  if (m_naturalScores.contains(stamp) || m_scoring.contains(stamp)) return;
  std::vector<ClipPtr> clips;
  for (const Motion& motion : natural->motions) clips.push_back(motion.clip);
  auto scores = std::make_shared<std::vector<ClipScore>>();
  m_scoring[stamp] = m_jobs.start(
      Lane::Models, tr("Scoring natural motion under %1").arg(QString::fromStdString(system)),
      [models = m_models, clips, file, scores](Progress& progress) {
        *scores = scoresOf(*models->model(file), clips, progress);
      },
      [this, scores, stamp, version = m_naturalVersion] {
        if (version != m_naturalVersion) return;
        m_naturalScores[stamp] = std::move(*scores);
        Q_EMIT naturalScoresChanged();
      },
      this);
}

// Sample sets.

void Workspace::setSampled(const std::string& system, bool sampled) {
  if (sampled)
    m_leftOut.erase(system);
  else
    m_leftOut.insert(system);
}

void Workspace::sampleCurrentPath() {
  const Experiment& e = experiment();
  const bool any = std::any_of(e.systems.begin(), e.systems.end(),
                               [this](const auto& system) { return sampled(system.name); });
  if (!any || e.paths.empty()) {
    report(tr("Sampling"), tr("There is nothing to sample yet: the document needs a path and a "
                              "model that is ticked in the Sampling panel."));
    return;
  }
  const ExperimentPath path = e.paths[static_cast<size_t>(m_currentPath)];
  QStringList unchanged;
  for (const ExperimentSystem& system : e.systems) {
    if (!sampled(system.name)) continue;
    int old = -1;
    for (const MotionGroup& group : m_groups)
      if (group.recipe && !group.heldOut() && !group.pinned && group.system == system.name &&
          group.recipe->path.name == path.name)
        old = group.id;
    const SampleRecipe recipe{.system = system,
                              .path = path,
                              .samples = e.samples,
                              .seed = e.seed,
                              .fps = e.fps,
                              .folder = e.folder};
    if (groupLike(recipe) == nullptr)
      sample(recipe, old);
    else
      unchanged << QString::fromStdString(system.name);
  }
  if (!unchanged.isEmpty())
    Q_EMIT noticed(tr("Unchanged, and not sampled again: %1").arg(unchanged.join(u", ")));
}

void Workspace::sample(const SampleRecipe& given, int replaceGroup, int colourIndex) {
  const SampleRecipe recipe = given;  // it may be that of a group, and groups come and go here
  const int known = systemIndex(recipe.system.name);
  const MotionGroup* old = this->group(replaceGroup);
  const int index = known >= 0 ? known : std::max(0, old ? old->colourIndex : colourIndex);
  const int id = m_nextGroup++;
  Drawing& drawing = m_drawings[id];
  drawing.modelHash = std::make_shared<std::string>();
  if (old != nullptr && !old->pinned) {
    drawing.replaces.push_back(replaceGroup);
    const auto stopped = m_drawings.find(replaceGroup);
    if (stopped != m_drawings.end()) {
      // It has replaced nothing yet, perhaps: then both go.
      for (const int older : stopped->second.replaces) drawing.replaces.push_back(older);
      stopped->second.replaces.clear();
      m_jobs.cancel(int{stopped->second.job});
    }
  }
  const std::string name = recipe.system.name + " – " + recipe.path.name;
  m_groups.push_back({.id = id,
                      .name = name,
                      .system = recipe.system.name,
                      .colourIndex = index,
                      .complete = false,
                      .recipe = recipe,
                      .modelHash = {},
                      .wanted = {},
                      .motions = {},
                      .modelStamp = stampOf(recipe)});
  tellMotions();
  m_drawings[id].job = m_jobs.start(
      Lane::Models, tr("Sampling %1").arg(QString::fromStdString(name)), drawingWork(recipe, id));
}

Job::Work Workspace::drawingWork(const SampleRecipe& recipe, int id) {
  if (recipe.heldOut) return heldOutWork(recipe, id);
  const std::string file = modelFileOf(recipe);
  const QPointer<Workspace> self(this);
  return [self, models = m_models, file, recipe, id,
          hash = m_drawings[id].modelHash](Progress& progress) {
    const auto weights = models->model(file);
    requireRate(*weights, file, recipe.fps);
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
}

void Workspace::cancelSampling() {
  std::vector<int> jobs;
  for (const auto& [group, drawing] : m_drawings) jobs.push_back(drawing.job);
  // Backwards, so that no waiting one starts in the place of a stopped one.
  for (auto job = jobs.rbegin(); job != jobs.rend(); ++job) m_jobs.cancel(*job);
}

void Workspace::addMotions(int id, const std::vector<RootFrame>& wanted,
                           std::vector<SampledMotion> motions) {
  MotionGroup* group = findGroup(id);
  if (group == nullptr) return;
  group->wanted = wanted;
  const size_t fresh = group->motions.size();
  for (SampledMotion& motion : motions)
    group->motions.push_back({std::move(motion.clip), std::move(motion.score), true});
  markAsKept(*group, fresh);
  const auto drawing = m_drawings.find(id);
  if (drawing != m_drawings.end()) dropReplaced(std::exchange(drawing->second.replaces, {}));
  tellMotions();
}

void Workspace::dropReplaced(const std::vector<int>& groups) {
  for (const int id : groups)
    if (const MotionGroup* old = group(id); old != nullptr && !old->pinned) removeGroup(id);
}

void Workspace::finishGroup(int id, const Drawing& drawing, bool successful) {
  MotionGroup* group = findGroup(id);
  m_kept.erase(id);
  if (group == nullptr) return;
  group->modelHash = *drawing.modelHash;
  group->complete = successful;
  // What a cancelled run has drawn stays; a set without any motion is of no use.
  if (!successful && group->motions.empty()) return removeGroup(id);
  dropReplaced(drawing.replaces);
  tellMotions();
}

}  // namespace marey::gui
