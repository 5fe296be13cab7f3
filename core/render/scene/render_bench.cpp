#include "render/scene/render_bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "base/error.h"
#include "motion/path.h"
#include "motion/walker.h"
#include "render/scene/floor.h"
#include "render/scene/live_picture.h"
#include "render/scene/offscreen.h"
#include "render/scene/vtk_parts.h"

namespace marey::render {

namespace {
constexpr double fps = 60.0, walkS = 4.0;
constexpr double spacingM = 1.1;

double nowMs() {
  const std::chrono::duration<double, std::milli> now =
      std::chrono::steady_clock::now().time_since_epoch();
  return now.count();
}

double cpuMs() {
  return 1000.0 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

void check(const RenderBenchSpec& spec) {
  const Place place{.path = "bench render"};
  if (spec.motions < 1) throwInput(place, "one motion or more", "{}", spec.motions);
  if (spec.frames < 1) throwInput(place, "one frame or more", "{}", spec.frames);
  if (spec.width < 32 || spec.height < 32)
    throwInput(place, "32x32 pixels or more", "{}x{}", spec.width, spec.height);
}

std::shared_ptr<const Clip> walkFrom(double x, double z, uint64_t seed) {
  static const char* const presets[] = {"slow", "turn-left", "fast", "turn-right"};
  std::vector<RootFrame> path = presetPath(presets[seed % std::size(presets)], walkS, fps);
  for (RootFrame& frame : path) {
    frame.x += x;
    frame.z += z;
  }
  WalkerOptions options;
  options.fps = fps;
  options.seed = seed;
  return std::make_shared<const Clip>(walk(path, options).clip);
}

/// The plain way: floor as a picture, all bodies as one mesh built anew.
class Reference {
 public:
  Reference(const RenderBenchSpec& spec, const std::vector<LiveMotion>& motions,
            const Camera& camera)
      : m_spec(spec), m_motions(motions) {
    m_renderer->SetBackground(1, 1, 1);
    addLights(m_renderer);
    FloorSpec floorSpec;
    floorSpec.area = {1e9, 1e9, -1e9, -1e9};
    for (const LiveMotion& m : motions) {
      m_shapes.push_back(bodyShape(*m.clip->skeleton, m.clip->frame(0)));
      for (int t = 0; t < m.clip->frameCount(); ++t)
        floorSpec.area.include(m.clip->at(t, 0).x(), m.clip->at(t, 0).z());
    }
    const FloorImage floor = paintFloor(floorSpec);
    m_renderer->AddActor(
        floorActor(floor.image, floor.area.x0, floor.area.z0, floor.area.x1, floor.area.z1, 0.0));
    applyCamera(camera, m_renderer->GetActiveCamera());
  }

  void draw(double timeS) {
    // As SceneRenderer does it.
    const bool many = m_motions.size() * m_shapes.front().capsules.size() > 2500;
    Mesh mesh;
    for (size_t m = 0; m < m_motions.size(); ++m) {
      appendPose(mesh, m_shapes[m], poseAt(*m_motions[m].clip, timeS), m_motions[m].colour,
                 many ? MeshDetail{8, 3} : MeshDetail{12, 4});
    }
    if (m_bodies) m_renderer->RemoveActor(m_bodies);
    m_bodies = bodyActor(mesh);
    m_renderer->AddActor(m_bodies);
    m_window.draw(m_renderer, m_spec.width, m_spec.height);
  }

 private:
  RenderBenchSpec m_spec;
  const std::vector<LiveMotion>& m_motions;
  std::vector<BodyShape> m_shapes;
  OffscreenWindow m_window;
  vtkSmartPointer<vtkRenderer> m_renderer = vtkSmartPointer<vtkRenderer>::New();
  vtkSmartPointer<vtkActor> m_bodies;
};

double timeOf(int frame) {
  return std::fmod(frame / fps, walkS);
}

void measureLive(const RenderBenchSpec& spec, LiveScene& scene, RenderBenchResult& result,
                 Progress progress) {
  LivePicture picture;
  // The first drawing compiles shaders.
  picture.draw(scene, spec.width, spec.height);
  const double begin = nowMs(), cpuBegin = cpuMs();
  for (int frame = 0; frame < spec.frames; ++frame) {
    progress.throwIfCancelled();
    scene.setTime(timeOf(frame + 1));
    picture.draw(scene, spec.width, spec.height);
    result.fillMs += scene.cost().fillMs / spec.frames;
    progress.report((frame + 1.0) / spec.frames, "frames");
  }
  result.msPerFrame = (nowMs() - begin) / spec.frames;
  result.cpuMsPerFrame = (cpuMs() - cpuBegin) / spec.frames;
  result.lines = scene.cost().lines;
}

void measureReference(const RenderBenchSpec& spec, const LiveScene& scene,
                      RenderBenchResult& result, Progress progress) {
  constexpr int most = 12;  // it is slow
  result.referenceFrames = std::min(most, spec.frames);
  Camera camera = scene.camera();
  Reference reference(spec, scene.motions(), camera);
  reference.draw(0.0);
  const double begin = nowMs();
  for (int frame = 0; frame < result.referenceFrames; ++frame) {
    progress.throwIfCancelled();
    reference.draw(timeOf(frame + 1));
    progress.report((frame + 1.0) / result.referenceFrames, "reference frames");
  }
  result.referenceMsPerFrame = (nowMs() - begin) / result.referenceFrames;
}
}  // namespace

std::vector<LiveMotion> benchMotions(int motions, uint64_t seed) {
  std::vector<LiveMotion> result;
  const int columns = std::max(1, static_cast<int>(std::ceil(std::sqrt(1.6 * motions))));
  for (int m = 0; m < motions; ++m) {
    LiveMotion motion;
    motion.clip = walkFrom(spacingM * (m % columns), spacingM * (m / columns),
                           seed * 1000003U + static_cast<uint64_t>(m));
    motion.colour = colourOf(m);
    result.push_back(std::move(motion));
  }
  return result;
}

RenderBenchResult benchRender(const RenderBenchSpec& spec, Progress& progress) {
  check(spec);
  RenderBenchResult result;
  LiveScene scene;
  progress.report(0.0, "walkers");
  scene.setMotions(benchMotions(spec.motions, spec.seed));
  LiveOptions options;
  options.detail = spec.detail;
  scene.setOptions(options);
  scene.setView(LiveView::ThreeQuarter, spec.width, spec.height);
  result.joints = scene.motions().front().clip->jointCount();
  measureLive(spec, scene, result, progress.part(0.1, 0.7));
  measureReference(spec, scene, result, progress.part(0.7, 1.0));
  return result;
}

}  // namespace marey::render
