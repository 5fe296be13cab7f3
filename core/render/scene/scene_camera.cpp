// The camera of a scene, and the way back from the screen into the world.
#include <algorithm>
#include <cmath>

#include "render/scene/scene_internals.h"
#include "render/scene/views.h"

namespace marey::render {

namespace {
Vec3 vec(const double* v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

/// As a window has it around its motions.
Frame windowFrame(int width, int height) {
  const double margin = 0.07 * std::min(width, height) + 6.0;
  return {.width = std::max(32, width),
          .height = std::max(32, height),
          .left = margin,
          .right = margin,
          .top = margin,
          .bottom = margin};
}
}  // namespace

Camera Scene::Internals::camera() const {
  Camera result;
  result.eye = vec(eye->GetPosition());
  result.target = vec(eye->GetFocalPoint());
  result.up = vec(eye->GetViewUp());
  result.orthographic = eye->GetParallelProjection() != 0;
  result.fovY = eye->GetViewAngle() * M_PI / 180.0;
  result.heightM = 2.0 * eye->GetParallelScale();
  eye->GetClippingRange(result.nearM, result.farM);
  return result;
}

void Scene::Internals::apply(const Camera& camera) {
  const auto set = [](const Vec3& v, auto&& setter) { setter(v.x(), v.y(), v.z()); };
  set(camera.eye, [&](double x, double y, double z) { eye->SetPosition(x, y, z); });
  set(camera.target, [&](double x, double y, double z) { eye->SetFocalPoint(x, y, z); });
  set(camera.up, [&](double x, double y, double z) { eye->SetViewUp(x, y, z); });
  eye->SetParallelProjection(camera.orthographic ? 1 : 0);
  eye->SetViewAngle(camera.fovY * 180.0 / M_PI);
  eye->SetParallelScale(0.5 * camera.heightM);
}

void Scene::Internals::turnTo(const ViewAxes& axes) {
  Camera turned = camera();
  turned.fovY = viewFovY;
  turned.target = stage.extent().centre;
  turned.eye = turned.target - axes.forward;
  turned.up = axes.up;
  apply(turned);
  slant = lightFor(axes);
  sceneChanged = true;
}

void Scene::setView(View view, int width, int height) {
  m_internals->turnTo(axesFor(view, m_internals->stage.travel(), 0.0));
  fit(width, height);
}

void Scene::setView(View view, const Frame& frame) {
  const Stage& stage = m_internals->stage;
  m_internals->turnTo(axesFor(view, stage.travel(), stage.spreadM()));
  fit(frame);
}

void Scene::fit(int width, int height) {
  fit(windowFrame(width, height));
}

std::vector<Vec3> Scene::outline() const {
  const Internals& i = *m_internals;
  std::vector<Vec3> points = i.following ? i.stage.outlineAround(i.followed) : i.stage.outline();
  if (!points.empty()) return points;
  const Vec3 centre = i.following ? i.followed : i.stage.extent().centre;
  return {centre - Vec3(1.0F, centre.y(), 1.0F), centre + Vec3(1.0F, 0.9F, 1.0F)};
}

void Scene::fit(const Frame& frame, std::span<const Vec3> more) {
  std::vector<Vec3> points = outline();
  points.insert(points.end(), more.begin(), more.end());
  const Camera before = camera();
  m_internals->apply(fittedCamera(points, {before.right(), before.trueUp(), before.forward()},
                                  before.orthographic, frame));
}

void Scene::setFollow(bool follow) {
  m_internals->following = follow;
  m_internals->followed = m_internals->stage.meanRoot(time());
}

bool Scene::follow() const {
  return m_internals->following;
}

void Scene::setOrthographic(bool orthographic) {
  m_internals->apply(withProjection(camera(), orthographic));
}

bool Scene::orthographic() const {
  return camera().orthographic;
}

void Scene::orbit(double aroundRad, double upRad) {
  m_internals->apply(orbited(camera(), aroundRad, upRad));
}

void Scene::pan(double x, double y, int height) {
  m_internals->apply(panned(camera(), x, y, height));
}

void Scene::zoom(double factor) {
  m_internals->apply(zoomed(camera(), factor));
}

Camera Scene::camera() const {
  return m_internals->camera();
}

Viewpoint Scene::viewpoint() const {
  return {camera(), m_internals->slant, time()};
}

void Scene::setViewpoint(const Viewpoint& viewpoint) {
  setTime(viewpoint.timeS);
  m_internals->apply(viewpoint.camera);
  m_internals->slant = viewpoint.light;
  m_internals->sceneChanged = true;
}

std::optional<Hit> Scene::pick(double x, double y, int width, int height, double reach) const {
  constexpr double alike = 3.0;  // pixels; of joints over each other the one in front is meant
  const Camera camera = this->camera();
  struct Found {
    Hit hit;
    float depth;
  };
  std::vector<Found> found;
  double nearest = reach;
  for (size_t m = 0; m < motions().size(); ++m) {
    if (m_internals->stage.colour(m, time()).a <= 0.0) continue;
    const auto pose = m_internals->stage.pose(m);
    for (size_t j = 0; j < pose.size(); ++j) {
      const float depth = camera.forward().dot(pose[j] - camera.eye);
      if (!camera.orthographic && depth < 0.01F) continue;
      const ScreenPoint at = project(camera, pose[j], width, height);
      const double pixels = std::hypot(at.x - x, at.y - y);
      if (pixels > std::min(reach, nearest + alike)) continue;
      nearest = std::min(nearest, pixels);
      found.push_back({{m, static_cast<int>(j), pose[j], pixels}, depth});
    }
  }
  const Found* best = nullptr;
  for (const Found& f : found) {
    if (f.hit.pixels > nearest + alike) continue;
    if (best == nullptr || f.depth < best->depth) best = &f;
  }
  return best == nullptr ? std::nullopt : std::optional<Hit>(best->hit);
}

std::optional<Vec3> Scene::floorPoint(double x, double y, int width, int height) const {
  const Sight sight = sightOf(this->camera(), x, y, width, height);
  if (std::abs(sight.direction.y()) < 1e-6F) return std::nullopt;
  const float along = -sight.origin.y() / sight.direction.y();
  if (along <= 0.0F) return std::nullopt;
  Vec3 place = sight.origin + along * sight.direction;
  place.y() = 0.0F;
  return place;
}

ScreenPoint Scene::screenPoint(const Vec3& world, int width, int height) const {
  return project(this->camera(), world, width, height);
}

}  // namespace marey::render
