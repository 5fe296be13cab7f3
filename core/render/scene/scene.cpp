#include "render/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/error.h"
#include "render/scene/bodies.h"
#include "render/scene/composite.h"
#include "render/scene/contacts.h"
#include "render/scene/endings.h"
#include "render/scene/floor.h"
#include "render/scene/overlay.h"
#include "render/scene/vtk_parts.h"

namespace marey::render {

namespace {
/// Earlier figures of a video, against the present ones.
constexpr double trailOpacity = 0.3;

struct Figure {
  size_t motion = 0;
  std::vector<Vec3> pose;
  double opacity = 1.0;
};

/// Figures that are drawn together as one solid, then shown with one opacity.
struct Layer {
  std::vector<const Figure*> figures;
  double opacity = 1.0;
};

bool isOpaque(double opacity) {
  return opacity > 0.995;
}

std::vector<Layer> layersOf(const std::vector<Figure>& figures) {
  Layer solid;
  std::vector<Layer> layers;
  std::vector<size_t> owner;  // motion of each see-through layer
  for (const Figure& figure : figures) {
    if (isOpaque(figure.opacity)) {
      solid.figures.push_back(&figure);
      continue;
    }
    size_t at = 0;
    while (at < layers.size() &&
           (owner[at] != figure.motion || layers[at].opacity != figure.opacity))
      ++at;
    if (at == layers.size() && layers.size() == mostLayers) at = figure.motion % mostLayers;
    if (at == layers.size()) {
      layers.push_back({{}, figure.opacity});
      owner.push_back(figure.motion);
    }
    layers[at].figures.push_back(&figure);
  }
  layers.insert(layers.begin(), solid);
  return layers;
}

/// On the floor in front of the points, along the lower edge of the picture.
ScaleBar scaleBarFor(View view, const Camera& camera, const std::vector<Vec3>& points) {
  Vec3 right = camera.right();
  right.y() = 0.0F;
  right.normalize();
  const Vec3 toViewer =
      view == View::Top ? Vec3(-camera.trueUp()) : Vec3(right.cross(Vec3::UnitY()));
  float start = std::numeric_limits<float>::max(), front = std::numeric_limits<float>::lowest();
  for (const Vec3& p : points) {
    start = std::min(start, p.dot(right));
    front = std::max(front, p.dot(toViewer));
  }
  const Vec3 from = start * right + (front + 0.25F) * toViewer;
  return {from, from + right};
}

Vec3 onFloor(const RootFrame& frame) {
  return {static_cast<float>(frame.x), 0.0F, static_cast<float>(frame.z)};
}

double longestS(const SceneSpec& spec) {
  double longest = 0.0;
  for (const SceneMotion& m : spec.motions) longest = std::max(longest, m.clip->seconds());
  return longest;
}

void checkScene(const SceneSpec& spec) {
  const Place place{.path = "scene '" + spec.title + "'"};
  if (spec.motions.empty()) throw InputError(place, "at least one motion", "none");
  for (const SceneMotion& motion : spec.motions) {
    if (!motion.clip) throw InputError(place, "a clip for every motion", "none");
    validate(*motion.clip);
    if (!(motion.strobeS > 0.0))
      throwInput(place, "a strobe interval above zero", "{}", motion.strobeS);
  }
}

std::vector<Vec3> rootsOf(const Clip& clip) {
  std::vector<Vec3> roots;
  roots.reserve(static_cast<size_t>(clip.frameCount()));
  for (int t = 0; t < clip.frameCount(); ++t) roots.push_back(clip.at(t, 0));
  return roots;
}
}  // namespace

struct SceneRenderer::Internals {
  SceneSpec spec;
  int width = 0, height = 0;
  std::vector<BodyShape> shapes;  ///< per motion
  Camera camera;                  ///< sees everything
  std::optional<ScaleBar> bar;
  std::optional<Camera> following;  ///< sees the figures of one moment; its place is that of time 0
  std::optional<ScaleBar> followingBar;
  FloorArea area;
  OffscreenWindow window;
  vtkSmartPointer<vtkRenderer> renderer = vtkSmartPointer<vtkRenderer>::New();
  vtkSmartPointer<vtkActor> floor, shadow, bodies;

  Vec3 travel() const;
  std::vector<Figure> strobes(double untilS) const;
  void buildFloor();
  std::vector<Vec3> outline(const std::vector<Figure>& figures) const;
  Camera fitted(std::vector<Vec3> points, std::optional<ScaleBar>& placedBar) const;
  Eigen::Vector2f slant() const;
  Rendered draw(const Layer& layer, bool withFloor, const Camera& from);
  Image picture(const std::vector<Figure>& figures, const Camera& from,
                const std::optional<ScaleBar>& bar);
  Vec3 middleAt(double timeS) const;
  std::vector<Figure> figuresAt(double timeS) const;
  void fitWhole();
  void fitFollowing();
  void castShadows(const std::vector<Figure>& figures);
};

Vec3 SceneRenderer::Internals::travel() const {
  std::vector<Vec3> places;
  for (const RootFrame& f : spec.path) places.push_back(onFloor(f));
  if (places.size() < 2) places = rootsOf(*spec.motions.front().clip);
  return travelDirection(places, Vec3::UnitX());
}

std::vector<Figure> SceneRenderer::Internals::strobes(double untilS) const {
  std::vector<Figure> figures;
  for (size_t m = 0; m < spec.motions.size(); ++m) {
    const SceneMotion& motion = spec.motions[m];
    const double last = std::min(untilS, (motion.clip->frameCount() - 1) / motion.clip->fps);
    for (int k = 0; k * motion.strobeS <= last + 1e-9; ++k) {
      figures.push_back({m, poseAt(*motion.clip, k * motion.strobeS), motion.opacity});
    }
  }
  return figures;
}

void SceneRenderer::Internals::buildFloor() {
  FloorSpec floorSpec;
  floorSpec.gridM = spec.gridM;
  floorSpec.area = {1e9, 1e9, -1e9, -1e9};
  for (const SceneMotion& motion : spec.motions) {
    for (const Vec3& root : rootsOf(*motion.clip)) floorSpec.area.include(root.x(), root.z());
    if (!motion.contactMarks) continue;
    const Colour colour = withOpacity(motion.colour, std::max(0.35, motion.opacity));
    for (const Rest& rest : feetAtRest(*motion.clip, spec.contacts)) {
      floorSpec.marks.push_back({rest.place.x(), rest.place.z(), 0.055, colour});
    }
  }
  for (const RootFrame& f : spec.path) {
    floorSpec.area.include(f.x, f.z);
    floorSpec.path.emplace_back(f.x, f.z);
  }
  area = floorSpec.area;
  if (!spec.floor) return;
  const FloorImage picture = paintFloor(floorSpec);
  const FloorArea& a = picture.area;
  floor = floorActor(picture.image, a.x0, a.z0, a.x1, a.z1, 0.0);
  renderer->AddActor(floor);
}

std::vector<Vec3> SceneRenderer::Internals::outline(const std::vector<Figure>& figures) const {
  std::vector<Vec3> points;
  for (const Figure& figure : figures) {
    points.insert(points.end(), figure.pose.begin(), figure.pose.end());
    const BodyShape& shape = shapes[figure.motion];
    if (shape.head < 0) continue;
    const Vec3 head = headCentre(shape, figure.pose);
    for (int axis = 0; axis < 3; ++axis) {
      points.emplace_back(head + shape.headRadiusM * Vec3::Unit(axis));
      points.emplace_back(head - shape.headRadiusM * Vec3::Unit(axis));
    }
  }
  return points;
}

Camera SceneRenderer::Internals::fitted(std::vector<Vec3> points,
                                        std::optional<ScaleBar>& placedBar) const {
  const double margin = 0.04 * std::min(width, height) + 6.0;
  const Frame frame{.width = width,
                    .height = height,
                    .left = margin,
                    .right = margin,
                    .top = margin + overlayHeight(spec, height),
                    .bottom = margin + (spec.scaleBar ? 0.02 * height + 6.0 : 0.0)};
  // A path that spreads over the floor is seen from higher up.
  const double spread = std::min(area.width(), area.depth());
  const double elevation = 0.30 + 0.25 * std::clamp(spread / 4.0, 0.0, 1.0);
  const auto fit = [&] {
    return fitCamera(points, travel(), spec.view, spec.orthographic, frame, elevation);
  };
  Camera first = fit();
  if (!spec.scaleBar) return first;
  // The bar lies in front of the figures as seen from this direction, so it needs a camera first.
  placedBar = scaleBarFor(spec.view, first, points);
  points.push_back(placedBar->from);
  points.push_back(placedBar->to);
  return fit();
}

void SceneRenderer::Internals::fitWhole() {
  std::vector<Vec3> points = outline(strobes(std::numeric_limits<double>::max()));
  for (const RootFrame& f : spec.path) points.push_back(onFloor(f));
  camera = fitted(std::move(points), bar);
}

void SceneRenderer::Internals::fitFollowing() {
  if (following) return;
  std::vector<Vec3> points;
  const Vec3 start = middleAt(0.0);
  const int moments = static_cast<int>(std::ceil(10.0 * longestS(spec)));
  for (int k = 0; k < moments; ++k) {
    const double t = 0.1 * k;
    const Vec3 shift = middleAt(t) - start;
    for (const Vec3& p : outline(figuresAt(t))) points.emplace_back(p - shift);
  }
  following = fitted(std::move(points), followingBar);
}

Eigen::Vector2f SceneRenderer::Internals::slant() const {
  if (spec.view == View::Top) return {0.12F, 0.12F};
  const Vec3 right = camera.right(), back = Vec3::UnitY().cross(right);
  return {0.30F * right.x() + 0.22F * back.x(), 0.30F * right.z() + 0.22F * back.z()};
}

Rendered SceneRenderer::Internals::draw(const Layer& layer, bool withFloor, const Camera& from) {
  size_t bones = 0;
  for (const Figure* f : layer.figures) bones += shapes[f->motion].capsules.size();
  const MeshDetail detail = bones > 2500 ? MeshDetail{8, 3} : MeshDetail{12, 4};
  Mesh mesh;
  for (const Figure* f : layer.figures) {
    appendPose(mesh, shapes[f->motion], f->pose, spec.motions[f->motion].colour, detail);
  }
  if (bodies) renderer->RemoveActor(bodies);
  bodies = mesh.triangles.empty() ? nullptr : bodyActor(mesh);
  if (bodies) renderer->AddActor(bodies);
  if (floor) floor->SetVisibility(withFloor ? 1 : 0);
  if (shadow) shadow->SetVisibility(withFloor ? 1 : 0);
  applyCamera(from, renderer->GetActiveCamera());
  return window.render(renderer, width * oversampling, height * oversampling);
}

void SceneRenderer::Internals::castShadows(const std::vector<Figure>& figures) {
  std::vector<Caster> casters;
  casters.reserve(figures.size());
  for (const Figure& f : figures) casters.push_back({&shapes[f.motion], f.pose, f.opacity});
  const FloorImage shadows = paintShadows(casters, slant());
  const FloorArea& a = shadows.area;
  constexpr double aboveFloorM = 0.003;
  if (shadow) {
    setFloorPicture(shadow, shadows.image, a.x0, a.z0, a.x1, a.z1, aboveFloorM);
  } else {
    shadow = floorActor(shadows.image, a.x0, a.z0, a.x1, a.z1, aboveFloorM);
    renderer->AddActor(shadow);
  }
}

Image SceneRenderer::Internals::picture(const std::vector<Figure>& figures, const Camera& from,
                                        const std::optional<ScaleBar>& placedBar) {
  if (spec.floor) castShadows(figures);
  const std::vector<Layer> layers = layersOf(figures);
  // Solid figures alone need no putting together.
  const bool onlySolid = layers.size() == 1;
  Rendered ground = draw(onlySolid ? layers.front() : Layer{}, true, from);
  std::vector<LayerPicture> over;
  for (const Layer& layer : layers) {
    if (onlySolid || layer.figures.empty()) continue;
    over.push_back({draw(layer, false, from), layer.opacity});
  }
  composite(ground, over);
  return withOverlay(shrunk(ground), spec, from, placedBar);
}

std::vector<Figure> SceneRenderer::Internals::figuresAt(double timeS) const {
  std::vector<Figure> figures;
  for (size_t m = 0; m < spec.motions.size(); ++m) {
    const Clip& clip = *spec.motions[m].clip;
    const double presence = presenceAt(timeS, (clip.frameCount() - 1) / clip.fps);
    figures.push_back({m, poseAt(clip, timeS), spec.motions[m].opacity * presence});
  }
  return figures;
}

Vec3 SceneRenderer::Internals::middleAt(double timeS) const {
  // Averaged over a second, so that the camera glides.
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (const SceneMotion& motion : spec.motions) {
    for (int k = -5; k <= 5; ++k) {
      sum += poseAt(*motion.clip, timeS + 0.1 * k).front();
      ++count;
    }
  }
  return sum / static_cast<float>(count);
}

SceneRenderer::SceneRenderer(SceneSpec spec, int width, int height) {
  checkScene(spec);
  if (width < 32 || height < 32) {
    throwInput({.path = "picture size"}, "32x32 pixels or more", "{}x{}", width, height);
  }
  m_internals = std::make_unique<Internals>();
  Internals& i = *m_internals;
  i.spec = std::move(spec);
  i.width = width;
  i.height = height;
  for (const SceneMotion& m : i.spec.motions)
    i.shapes.push_back(bodyShape(*m.clip->skeleton, m.clip->frame(0)));
  i.renderer->SetBackground(1.0, 1.0, 1.0);
  addLights(i.renderer);
  i.buildFloor();
  i.fitWhole();
}

SceneRenderer::~SceneRenderer() = default;
SceneRenderer::SceneRenderer(SceneRenderer&&) noexcept = default;
SceneRenderer& SceneRenderer::operator=(SceneRenderer&&) noexcept = default;

Image SceneRenderer::still() {
  Internals& i = *m_internals;
  return i.picture(i.strobes(std::numeric_limits<double>::max()), i.camera, i.bar);
}

Image SceneRenderer::frame(double timeS, bool follow, bool trail) {
  Internals& i = *m_internals;
  std::vector<Figure> figures;
  if (trail) figures = i.strobes(timeS);
  for (Figure& f : figures) f.opacity *= trailOpacity;
  for (Figure& f : i.figuresAt(timeS)) figures.push_back(std::move(f));
  if (!follow) return i.picture(figures, i.camera, i.bar);

  i.fitFollowing();
  Vec3 shift = i.middleAt(timeS) - i.middleAt(0.0);
  shift.y() = 0.0F;
  Camera camera = *i.following;
  camera.eye += shift;
  camera.target += shift;
  std::optional<ScaleBar> bar = i.followingBar;
  if (bar) bar = ScaleBar{bar->from + shift, bar->to + shift};
  return i.picture(figures, camera, bar);
}

double SceneRenderer::seconds() const {
  return longestS(m_internals->spec);
}

double sampleOpacity(size_t samples, bool besideNatural) {
  const auto count = static_cast<double>(std::max<size_t>(1, samples));
  return besideNatural ? std::clamp(1.4 / count, 0.2, 0.6) : std::clamp(3.0 / count, 0.25, 1.0);
}

SceneSpec sceneOfMotions(std::vector<SceneMotion> motions) {
  constexpr size_t mostNames = 6;
  const auto isNatural = [](const SceneMotion& m) { return m.colour == naturalColour(); };
  const auto natural =
      static_cast<size_t>(std::count_if(motions.begin(), motions.end(), isNatural));
  const double opacity = sampleOpacity(motions.size() - natural, natural > 0);
  std::set<std::string> names;
  for (SceneMotion& motion : motions) {
    motion.opacity = isNatural(motion) ? 1.0 : opacity;
    names.insert(motion.system);
  }
  SceneSpec scene;
  scene.motions = std::move(motions);
  scene.legend = names.size() <= mostNames;
  return scene;
}

Image renderScene(const SceneSpec& spec, int width, int height) {
  return SceneRenderer(spec, width, height).still();
}

}  // namespace marey::render
