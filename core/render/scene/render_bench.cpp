#include "render/scene/render_bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkLight.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkSmartPointer.h>
#include <vtkTubeFilter.h>

#include "base/error.h"
#include "motion/path.h"
#include "motion/walker.h"
#include "render/scene/offscreen.h"
#include "render/scene/scene_picture.h"

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

void addLight(vtkRenderer* renderer, double x, double y, double z, double intensity) {
  auto light = vtkSmartPointer<vtkLight>::New();
  light->SetLightTypeToCameraLight();
  light->SetPosition(x, y, z);
  light->SetFocalPoint(0, 0, 0);
  light->SetIntensity(intensity);
  renderer->AddLight(light);
}

/// The plain way of VTK: all bones as lines with a tube filter, built anew for every frame.
class Reference {
 public:
  Reference(const RenderBenchSpec& spec, const std::vector<SceneMotion>& motions,
            const Camera& camera)
      : m_spec(spec), m_motions(motions) {
    m_renderer->SetBackground(1, 1, 1);
    m_renderer->AutomaticLightCreationOff();
    addLight(m_renderer, -0.55, 0.9, 0.8, 0.85);
    addLight(m_renderer, 0.9, 0.1, 0.6, 0.30);
    m_tubes->SetInputData(m_bones);
    m_tubes->SetNumberOfSides(motions.size() > 100 ? 8 : 12);
    m_tubes->SetRadius(0.03);
    m_tubes->CappingOn();
    auto mapper = vtkSmartPointer<vtkPolyDataMapper>::New();
    mapper->SetInputConnection(m_tubes->GetOutputPort());
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    m_renderer->AddActor(actor);
    vtkCamera* eye = m_renderer->GetActiveCamera();
    eye->SetPosition(camera.eye.x(), camera.eye.y(), camera.eye.z());
    eye->SetFocalPoint(camera.target.x(), camera.target.y(), camera.target.z());
    eye->SetViewUp(camera.up.x(), camera.up.y(), camera.up.z());
    eye->SetViewAngle(camera.fovY * 180.0 / M_PI);
  }

  void draw(double timeS) {
    auto points = vtkSmartPointer<vtkPoints>::New();
    auto lines = vtkSmartPointer<vtkCellArray>::New();
    for (const SceneMotion& motion : m_motions) {
      const Clip& clip = *motion.clip;
      const auto pose =
          clip.frame(std::min(static_cast<int>(timeS * clip.fps), clip.frameCount() - 1));
      const vtkIdType first = points->GetNumberOfPoints();
      for (const Vec3& p : pose) points->InsertNextPoint(p.x(), p.y(), p.z());
      for (const auto& [parent, child] : clip.skeleton->bones())
        lines->InsertNextCell({first + parent, first + child});
    }
    m_bones->SetPoints(points);
    m_bones->SetLines(lines);
    m_renderer->ResetCameraClippingRange();
    m_window.draw(m_renderer, m_spec.width, m_spec.height);
  }

 private:
  RenderBenchSpec m_spec;
  const std::vector<SceneMotion>& m_motions;
  OffscreenWindow m_window;
  vtkSmartPointer<vtkRenderer> m_renderer = vtkSmartPointer<vtkRenderer>::New();
  vtkSmartPointer<vtkPolyData> m_bones = vtkSmartPointer<vtkPolyData>::New();
  vtkSmartPointer<vtkTubeFilter> m_tubes = vtkSmartPointer<vtkTubeFilter>::New();
};

double timeOf(int frame) {
  return std::fmod(frame / fps, walkS);
}

void measureScene(const RenderBenchSpec& spec, Scene& scene, RenderBenchResult& result,
                  Progress progress) {
  ScenePicture picture;
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

void measureReference(const RenderBenchSpec& spec, const Scene& scene, RenderBenchResult& result,
                      Progress progress) {
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

std::vector<SceneMotion> benchMotions(int motions, uint64_t seed) {
  std::vector<SceneMotion> result;
  const int columns = std::max(1, static_cast<int>(std::ceil(std::sqrt(1.6 * motions))));
  for (int m = 0; m < motions; ++m) {
    SceneMotion motion;
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
  Scene scene;
  progress.report(0.0, "walkers");
  scene.setMotions(benchMotions(spec.motions, spec.seed));
  SceneOptions options;
  options.detail = spec.detail;
  scene.setOptions(options);
  scene.setView(View::ThreeQuarter, spec.width, spec.height);
  result.joints = scene.motions().front().clip->jointCount();
  measureScene(spec, scene, result, progress.part(0.1, 0.7));
  measureReference(spec, scene, result, progress.part(0.7, 1.0));
  return result;
}

}  // namespace marey::render
