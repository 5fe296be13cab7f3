#include "gui/workspace/sampling.h"

#include <QCoreApplication>
#include <QPointer>
#include <algorithm>
#include <utility>

#include "experiment/held_out_set.h"
#include "experiment/kept_sets.h"

namespace marey::gui {
namespace {

/// Motions that advance together at first while a set is drawn: the first ones are shown soon.
constexpr int kFirstMotions = 10;

std::shared_ptr<const MotionModel> modelFor(ModelCache& models, const SampleRecipe& recipe) {
  const std::string file = modelFileOf(recipe);
  auto model = models.model(file);
  requireRate(*model, file, recipe.fps);
  return model;
}

}  // namespace

Sampling::Sampling(NaturalParts parts, const NaturalMotions& natural, QObject* parent)
    : QObject(parent), m_parts(std::move(parts)), m_natural(natural) {
  connect(&m_parts.jobs, &JobQueue::ended, this, &Sampling::jobEnded);
  connect(&m_parts.motions, &MotionGroups::removing, this, &Sampling::stopDrawing);
}

void Sampling::setSampled(const std::string& system, bool sampled) {
  if (sampled)
    m_leftOut.erase(system);
  else
    m_leftOut.insert(system);
}

/// Of what a recipe is drawn with beside itself: the model's file, and of held-out control the
/// natural motions that are used.
std::string Sampling::stampOf(const SampleRecipe& recipe) const {
  std::string out = ModelCache::stampOf(modelFileOf(recipe));
  if (!recipe.heldOut) return out;
  for (const int index : m_natural.used()) out += '\n' + std::to_string(index);
  return out;
}

const MotionGroup* Sampling::groupLike(const SampleRecipe& recipe) const {
  const std::string stamp = stampOf(recipe);
  const auto& groups = m_parts.motions.groups();
  const auto found = std::find_if(groups.begin(), groups.end(), [&](const MotionGroup& g) {
    return g.recipe && g.complete && inFolder(*g.recipe, experiment().folder) == recipe &&
           g.modelStamp == stamp;
  });
  return found == groups.end() ? nullptr : &*found;
}

std::vector<std::string> Sampling::withoutHeldOut() const {
  std::vector<std::string> out;
  for (const ExperimentSystem& system : experiment().systems)
    if (sampled(system.name) && groupLike(heldOutRecipe(experiment(), system)) == nullptr)
      out.push_back(system.name);
  return out;
}

void Sampling::sampleHeldOut() {
  for (const std::string& name : withoutHeldOut()) {
    const auto index = static_cast<size_t>(m_parts.document.systemIndex(name));
    int old = -1;
    for (const MotionGroup& group : m_parts.motions.groups())
      if (group.heldOut() && group.system == name) old = group.id;
    sample(heldOutRecipe(experiment(), experiment().systems[index]), old);
  }
}

void Sampling::sampleCurrentPath() {
  const Experiment& e = experiment();
  const bool any = std::any_of(e.systems.begin(), e.systems.end(),
                               [this](const auto& system) { return sampled(system.name); });
  if (!any || e.paths.empty()) {
    Q_EMIT failed(tr("Sampling"),
                  tr("There is nothing to sample yet: the document needs a path and a "
                     "model that is ticked in the Sampling panel."));
    return;
  }
  const ExperimentPath path = e.paths[static_cast<size_t>(m_parts.document.currentPath())];
  QStringList unchanged;
  for (const ExperimentSystem& system : e.systems) {
    if (!sampled(system.name)) continue;
    int old = -1;
    for (const MotionGroup& group : m_parts.motions.groups())
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

std::vector<int> Sampling::replacedBy(int group) {
  const MotionGroup* old = m_parts.motions.group(group);
  if (old == nullptr || old->pinned) return {};
  std::vector<int> out{group};
  const auto stopped = m_drawings.find(group);
  if (stopped == m_drawings.end()) return out;
  // It has replaced nothing yet, perhaps: then both go.
  const std::vector<int> older = std::exchange(stopped->second.replaces, {});
  out.insert(out.end(), older.begin(), older.end());
  m_parts.jobs.cancel(int{stopped->second.job});
  return out;
}

int Sampling::sample(const SampleRecipe& given, int replaceGroup, int colourIndex) {
  const SampleRecipe recipe = given;  // it may be that of a group, and groups come and go here
  const int known = m_parts.document.systemIndex(recipe.system.name);
  const MotionGroup* old = m_parts.motions.group(replaceGroup);
  const int index = known >= 0 ? known : std::max(0, old ? old->colourIndex : colourIndex);
  const std::vector<int> replaces = replacedBy(replaceGroup);
  const std::string name = recipe.system.name + " – " + recipe.path.name;
  const int id = m_parts.motions.add({.name = name,
                                      .system = recipe.system.name,
                                      .colourIndex = index,
                                      .complete = false,
                                      .recipe = recipe,
                                      .modelHash = {},
                                      .wanted = {},
                                      .motions = {},
                                      .modelStamp = stampOf(recipe)});
  Drawing& drawing = m_drawings[id];
  drawing.replaces = replaces;
  drawing.modelHash = std::make_shared<std::string>();
  Job::Work work = recipe.heldOut ? alongNatural(recipe, id) : alongPath(recipe, id);
  drawing.job = m_parts.jobs.start(
      Lane::Models, tr("Sampling %1").arg(QString::fromStdString(name)), std::move(work));
  return id;
}

Job::Work Sampling::alongPath(const SampleRecipe& recipe, int id) {
  const QPointer<Sampling> self(this);
  return [self, models = m_parts.models, recipe, id,
          hash = m_drawings[id].modelHash](Progress& progress) {
    const auto model = modelFor(*models, recipe);
    *hash = model->info().hash;
    const MotionSink sink = [self, id](const std::vector<RootFrame>& wanted,
                                       std::vector<SampledMotion> sampled) {
      std::vector<Motion> motions;
      for (SampledMotion& one : sampled)
        motions.push_back({std::move(one.clip), std::move(one.score), true});
      QMetaObject::invokeMethod(
          self.data(),
          [self, id, wanted, motions = std::move(motions)]() mutable {
            if (self) self->addMotions(id, wanted, std::move(motions));
          },
          Qt::QueuedConnection);
    };
    drawSampleSet(*model, recipe, progress, kFirstMotions, sink);
  };
}

Job::Work Sampling::alongNatural(const SampleRecipe& recipe, int id) {
  const std::vector<int> followed = m_natural.used();
  std::vector<ClipPtr> clips;
  for (const int index : followed)
    clips.push_back(m_parts.motions.natural()->motions[static_cast<size_t>(index)].clip);
  const QPointer<Sampling> self(this);
  return [self, models = m_parts.models, recipe, id, followed, clips = std::move(clips),
          hash = m_drawings[id].modelHash](Progress& progress) {
    const auto model = modelFor(*models, recipe);
    *hash = model->info().hash;
    std::vector<Clip> natural;
    for (const ClipPtr& clip : clips) natural.push_back(*clip);
    auto motions = heldOutSet(*model, recipe, natural, followed, progress);
    QMetaObject::invokeMethod(
        self.data(),
        [self, id, motions = std::move(motions)]() mutable {
          if (self) self->addMotions(id, {}, std::move(motions));
        },
        Qt::QueuedConnection);
  };
}

void Sampling::cancel() {
  std::vector<int> jobs;
  for (const auto& [group, drawing] : m_drawings) jobs.push_back(drawing.job);
  // Backwards, so that no waiting one starts in the place of a stopped one.
  for (auto job = jobs.rbegin(); job != jobs.rend(); ++job) m_parts.jobs.cancel(*job);
}

void Sampling::stopDrawing(int group) {
  const auto drawing = m_drawings.find(group);
  if (drawing == m_drawings.end()) return;
  const int job = drawing->second.job;
  m_drawings.erase(drawing);
  m_parts.jobs.cancel(job);
}

void Sampling::addMotions(int id, const std::vector<RootFrame>& wanted,
                          std::vector<Motion> motions) {
  MotionGroup* group = m_parts.motions.find(id);
  if (group == nullptr) return;
  group->wanted = wanted;
  const auto first = static_cast<int>(group->motions.size());
  for (Motion& motion : motions) group->motions.push_back(std::move(motion));
  Q_EMIT drawn(id, first);
  const auto drawing = m_drawings.find(id);
  if (drawing != m_drawings.end()) dropReplaced(std::exchange(drawing->second.replaces, {}));
  m_parts.motions.tell();
}

void Sampling::dropReplaced(const std::vector<int>& groups) {
  for (const int id : groups)
    if (const MotionGroup* old = m_parts.motions.group(id); old != nullptr && !old->pinned)
      m_parts.motions.remove(id);
}

void Sampling::jobEnded(int job, bool successful) {
  // The last motions may still be on their way here.
  if (!m_drawings.empty()) QCoreApplication::sendPostedEvents(this, QEvent::MetaCall);
  const auto found = std::find_if(m_drawings.begin(), m_drawings.end(),
                                  [job](const auto& entry) { return entry.second.job == job; });
  if (found == m_drawings.end()) return;
  const auto [group, drawing] = *found;
  m_drawings.erase(found);
  finish(group, drawing, successful);
}

void Sampling::finish(int id, const Drawing& drawing, bool successful) {
  MotionGroup* group = m_parts.motions.find(id);
  Q_EMIT ended(id);
  if (group == nullptr) return;
  group->modelHash = *drawing.modelHash;
  group->complete = successful;
  // What a cancelled run has drawn stays; a set without any motion is of no use.
  if (!successful && group->motions.empty()) return m_parts.motions.remove(id);
  dropReplaced(drawing.replaces);
  m_parts.motions.tell();
}

}  // namespace marey::gui
