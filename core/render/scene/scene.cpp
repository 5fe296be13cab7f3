#include "render/scene/scene.h"

#include <algorithm>
#include <chrono>

#include <vtkCallbackCommand.h>
#include <vtkCullerCollection.h>

#include "render/scene/scene_internals.h"
#include "render/scene/views.h"

namespace marey::render {

Scene::Internals::Internals() {
  renderer->GetCullers()->RemoveAllItems();
  renderer->AutomaticLightCreationOff();
  renderer->SetActiveCamera(eye);
  auto command = vtkSmartPointer<vtkCallbackCommand>::New();
  command->SetCallback([](vtkObject*, unsigned long, void* internals, void*) {
    static_cast<Internals*>(internals)->draw();
  });
  command->SetClientData(this);
  m_observer = renderer->AddObserver(vtkCommand::StartEvent, command);
}

Scene::Internals::~Internals() {
  renderer->RemoveObserver(m_observer);
}

void Scene::Internals::stageChanged() {
  sceneChanged = true;
  followed = stage.meanRoot(stage.time());
  const SceneExtent& extent = stage.extent();
  floor.setPlace(extent.centre.x(), extent.centre.z(), extent.floorRadius);
}

void Scene::Internals::castShadows() {
  if (!stage.options().floor) return;
  castSoftShadows(strokes.shadows, slant, m_shadowMap);
  floor.setShadows(m_shadowMap);
}

void Scene::Internals::setClipping(const Camera& from) {
  const SceneExtent& extent = stage.extent();
  const float depth = from.forward().dot(extent.centre - from.eye);
  const float reach = extent.floorRadius + extent.radius;
  // Near planes nearer than this cost the depth that keeps marks apart from the floor.
  eye->SetClippingRange(std::max(0.05F + 0.002F * extent.radius, depth - reach),
                        std::max(1.0F, depth + reach));
}

void Scene::Internals::fill() {
  if (sceneChanged || timeChanged) {
    strokes.fillNow(stage);
    castShadows();
    batches.showMarks(strokes);
  }
  if (sceneChanged || (timeChanged && stage.options().strobe.untilNow)) strokes.fillStrobe(stage);
}

void Scene::Internals::show(const Camera& from, bool moved) {
  const SceneOptions& options = stage.options();
  if (sceneChanged || timeChanged || moved)
    batches.showFigures(strokes, from, m_thinStrokes, options.solidFirst);
  if (sceneChanged || moved || (timeChanged && options.strobe.untilNow))
    batches.showStrobe(strokes, from, m_thinStrokes, stage.asLines());
  if (!sceneChanged && !moved) return;
  setClipping(from);
  batches.setView({camera(), m_seenIn});
}

void Scene::Internals::draw() {
  const auto begin = std::chrono::steady_clock::now();
  std::array<int, 4> viewport{};
  auto& [left, low, width, height] = viewport;
  renderer->GetTiledSizeAndOrigin(&width, &height, &left, &low);
  width = std::max(1, width);
  height = std::max(1, height);
  const bool thin = drawsThinStrokes(renderer);
  const bool moved = eye->GetMTime() != m_seenFrom || viewport != m_seenIn || thin != m_thinStrokes;
  m_seenIn = viewport;
  m_thinStrokes = thin;
  fill();
  show(camera(), moved);
  cost.floorCopied = floor.prepare(renderer);
  sceneChanged = timeChanged = false;
  m_seenFrom = eye->GetMTime();
  cost.figures = strokes.figureCount();
  cost.strokes = strokes.strokeCount();
  cost.lines = stage.asLines();
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - begin;
  cost.fillMs = spent.count();
}

Scene::Scene() : m_internals(std::make_unique<Internals>()) {
  setOptions({});
  setView(View::ThreeQuarter, 1280, 720);
}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

vtkRenderer* Scene::renderer() const {
  return m_internals->renderer;
}

void Scene::setMotions(std::vector<SceneMotion> motions) {
  m_internals->stage.setMotions(std::move(motions));
  m_internals->stageChanged();
}

const std::vector<SceneMotion>& Scene::motions() const {
  return m_internals->stage.motions();
}

void Scene::setOptions(SceneOptions options) {
  Internals& i = *m_internals;
  i.stage.setOptions(std::move(options));
  i.stageChanged();
  const SceneOptions& set = i.stage.options();
  const Backdrop& backdrop = backdropOf(set.tone);
  i.renderer->SetBackground(backdrop.background.r, backdrop.background.g, backdrop.background.b);
  i.floor.setVisible(set.floor);
  i.floor.setLook(backdrop, std::max(0.01, set.gridM));
}

const SceneOptions& Scene::options() const {
  return m_internals->stage.options();
}

void Scene::setTime(double seconds) {
  Internals& i = *m_internals;
  if (i.stage.time() == seconds) return;
  i.stage.setTime(seconds);
  i.timeChanged = true;
  if (!i.following) return;
  const Vec3 now = i.stage.meanRoot(seconds), step = now - i.followed;
  i.followed = now;
  Camera shifted = camera();
  shifted.eye += step;
  shifted.target += step;
  i.apply(shifted);
}

double Scene::time() const {
  return m_internals->stage.time();
}

double Scene::seconds() const {
  return m_internals->stage.longestS();
}

std::vector<Vec3> Scene::pose(size_t motion) const {
  const auto pose = m_internals->stage.pose(motion);
  return {pose.begin(), pose.end()};
}

Colour Scene::background() const {
  return backdropOf(options().tone).background;
}

const SceneCost& Scene::cost() const {
  return m_internals->cost;
}

}  // namespace marey::render
