// Sampling along the control of natural clips, as a report does, and telling what need not be drawn
// again.
#include <QPointer>
#include <algorithm>
#include <utility>

#include "gui/workspace/workspace.h"

#include "base/error.h"
#include "base/ranks.h"

namespace marey::gui {
namespace {

/// `followed`: indices of the natural motions, `samples` motions along each.
std::vector<Motion> heldOutMotions(SystemResult&& result, const std::vector<int>& followed,
                                   int samples) {
  std::vector<Motion> out;
  for (size_t i = 0; i < result.heldOut.size(); ++i) {
    out.push_back({.clip = std::make_shared<const Clip>(std::move(result.heldOut[i])),
                   .score = std::move(result.heldOutScores[i]),
                   .visible = false,
                   .source = {},
                   .wanted = std::make_shared<const std::vector<RootFrame>>(
                       std::move(result.heldOutPaths[i])),
                   .follows = followed[i / static_cast<size_t>(samples)]});
  }
  return out;
}

}  // namespace

SampleRecipe Workspace::heldOutRecipe(const ExperimentSystem& system) const {
  const Experiment& e = experiment();
  return {.system = system,
          .path = {.name = "held-out control", .path = "natural", .seconds = 0.0},
          .samples = std::max(1, e.heldOutSamples),
          .seed = e.seed,
          .fps = e.fps,
          .folder = e.folder,
          .heldOut = true};
}

/// Of what a recipe is drawn with beside itself: the model's file, and of held-out control the
/// natural motions that are used.
std::string Workspace::stampOf(const SampleRecipe& recipe) const {
  std::string out = ModelCache::stampOf(modelFileOf(recipe));
  if (!recipe.heldOut) return out;
  for (const int index : usedNatural()) out += '\n' + std::to_string(index);
  return out;
}

std::vector<int> Workspace::usedNatural() const {
  std::vector<int> out;
  for (const MotionGroup& group : m_groups)
    for (size_t i = 0; group.natural() && i < group.motions.size(); ++i)
      if (group.motions[i].used) out.push_back(static_cast<int>(i));
  return out;
}

const MotionGroup* Workspace::groupLike(const SampleRecipe& recipe) const {
  const std::string stamp = stampOf(recipe);
  const auto found = std::find_if(m_groups.begin(), m_groups.end(), [&](const MotionGroup& g) {
    return g.recipe && g.complete && recipeHere(*g.recipe) == recipe && g.modelStamp == stamp;
  });
  return found == m_groups.end() ? nullptr : &*found;
}

std::vector<std::string> Workspace::withoutHeldOut() const {
  std::vector<std::string> out;
  for (const ExperimentSystem& system : experiment().systems)
    if (sampled(system.name) && groupLike(heldOutRecipe(system)) == nullptr)
      out.push_back(system.name);
  return out;
}

void Workspace::sampleHeldOut() {
  for (const std::string& name : withoutHeldOut()) {
    const ExperimentSystem& system = experiment().systems[static_cast<size_t>(systemIndex(name))];
    int old = -1;
    for (const MotionGroup& group : m_groups)
      if (group.heldOut() && group.system == name) old = group.id;
    sample(heldOutRecipe(system), old);
  }
}

/// They belong to natural clips that are there no more.
void Workspace::dropHeldOut() {
  std::vector<int> gone;
  for (const MotionGroup& group : m_groups)
    if (group.heldOut()) gone.push_back(group.id);
  for (const int id : gone) removeGroup(id);
}

Job::Work Workspace::heldOutWork(const SampleRecipe& recipe, int id) {
  const std::vector<int> followed = usedNatural();
  std::vector<ClipPtr> clips;
  for (const MotionGroup& group : m_groups)
    for (size_t k = 0; group.natural() && k < followed.size(); ++k)
      clips.push_back(group.motions[static_cast<size_t>(followed[k])].clip);
  const QPointer<Workspace> self(this);
  return [self, models = m_models, recipe, id, followed, clips = std::move(clips),
          hash = m_drawings[id].modelHash](Progress& progress) {
    const std::string file = modelFileOf(recipe);
    const auto weights = models->model(file);
    requireRate(*weights, file, recipe.fps);
    *hash = weights->info().hash;
    std::vector<Clip> natural;
    for (const ClipPtr& clip : clips) natural.push_back(*clip);
    if (natural.empty())
      throw InputError({.path = recipe.system.name}, "natural clips whose control is followed",
                       "none");
    Experiment e;
    e.heldOutSamples = recipe.samples;
    e.seed = recipe.seed;
    e.fps = recipe.fps;
    SystemResult result{.name = recipe.system.name,
                        .info = weights->info(),
                        .temperature = recipe.system.temperature,
                        .options = recipe.system.options};
    Ranks alone;
    marey::sampleHeldOut(*weights, e, natural, result, progress, alone);
    auto motions = heldOutMotions(std::move(result), followed, recipe.samples);
    QMetaObject::invokeMethod(
        self.data(),
        [self, id, motions = std::move(motions)]() mutable {
          if (self) self->takeHeldOut(id, std::move(motions));
        },
        Qt::QueuedConnection);
  };
}

void Workspace::takeHeldOut(int id, std::vector<Motion> motions) {
  MotionGroup* group = findGroup(id);
  if (group == nullptr) return;
  group->motions = std::move(motions);
  markAsKept(*group, 0);
  const auto drawing = m_drawings.find(id);
  if (drawing != m_drawings.end()) dropReplaced(std::exchange(drawing->second.replaces, {}));
  tellMotions();
}

}  // namespace marey::gui
