// The camera of a moving scene, and the way back from the screen into the world.
#include <algorithm>
#include <cmath>

#include "render/scene/live_internals.h"

namespace marey::render {

namespace {
constexpr double fovY = 0.42;        ///< radians
constexpr float lowestEyeM = 0.06F;  ///< above the floor

Vec3 vec(const double* v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

Vec3 level(const Vec3& v) {
  return {v.x(), 0.0F, v.z()};
}

/// The picture's directions, looking along `heading` (level) and down by `elevation`.
ViewAxes lookingDown(const Vec3& heading, float elevation) {
  const Vec3 forward = std::cos(elevation) * heading - std::sin(elevation) * Vec3::UnitY();
  const Vec3 right = heading.cross(Vec3::UnitY());
  return {right, right.cross(forward), forward};
}

ViewAxes axesFor(LiveView view, const Vec3& travel) {
  const auto turned = [&](float angle) {
    return Vec3(Eigen::AngleAxisf(angle, Vec3::UnitY()) * travel);
  };
  const auto quarter = static_cast<float>(0.5 * M_PI);
  switch (view) {
    // To the right and nearer: the viewer looks across the walk and somewhat against it.
    case LiveView::ThreeQuarter:
      return lookingDown(turned(quarter + 0.5F), 0.32F);
    case LiveView::Side:
      return lookingDown(turned(quarter), 0.05F);
    case LiveView::Front:
      return lookingDown(-travel, 0.10F);
    case LiveView::Back:
      return lookingDown(travel, 0.10F);
    case LiveView::Top:
      break;
  }
  return lookingDown(turned(quarter), quarter);
}

double halfHeightAt(const Camera& camera, double depth) {
  return camera.orthographic ? 0.5 * camera.heightM : depth * std::tan(0.5 * camera.fovY);
}

/// The head is a ball around no joint.
void addHead(std::vector<Vec3>& points, const BodyShape& shape, std::span<const Vec3> pose,
             const Vec3& shift) {
  if (shape.head < 0) return;
  const Vec3 head = headCentre(shape, pose) + shift;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-shape.headRadiusM, shape.headRadiusM})
      points.emplace_back(head + side * Vec3::Unit(axis));
}

/// A point on the line of sight through a pixel, and the line's direction.
struct Sight {
  Vec3 origin, direction;
};

Sight sightOf(const Camera& camera, double x, double y, int width, int height) {
  const double scale = halfHeightAt(camera, 1.0) / (0.5 * height);
  const Vec3 across = static_cast<float>((x - 0.5 * width) * scale) * camera.right() +
                      static_cast<float>((0.5 * height - y) * scale) * camera.trueUp();
  if (camera.orthographic) return {camera.eye + across, camera.forward()};
  return {camera.eye, (camera.forward() + across).normalized()};
}

/// The point looked at in the middle of what is seen, so that turning goes about it.
void aimAt(Camera& camera, const Vec3& centre) {
  const float depth = camera.forward().dot(centre - camera.eye);
  camera.target = camera.eye + std::max(0.3F, depth) * camera.forward();
}
}  // namespace

Camera LiveScene::Internals::camera() const {
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

void LiveScene::Internals::apply(const Camera& camera) {
  const auto set = [](const Vec3& v, auto&& setter) { setter(v.x(), v.y(), v.z()); };
  set(camera.eye, [&](double x, double y, double z) { eye->SetPosition(x, y, z); });
  set(camera.target, [&](double x, double y, double z) { eye->SetFocalPoint(x, y, z); });
  set(camera.up, [&](double x, double y, double z) { eye->SetViewUp(x, y, z); });
  eye->SetParallelProjection(camera.orthographic ? 1 : 0);
  eye->SetViewAngle(camera.fovY * 180.0 / M_PI);
  eye->SetParallelScale(0.5 * camera.heightM);
}

std::vector<Vec3> LiveScene::Internals::outline(bool relativeToFollowed) const {
  std::vector<Vec3> points;
  std::vector<Vec3> pose;
  // Enough moments to be near every extreme; fewer where there are many motions.
  const double most = std::max(4.0, 4000.0 / static_cast<double>(tracks.size() + 1));
  constexpr double stepS = 0.1;
  std::vector<Vec3> shifts(1, Vec3::Zero());
  for (double at = 0.0; relativeToFollowed && at <= longestS() + stepS; at += stepS)
    shifts.emplace_back(followed - meanRoot(at));
  for (const auto& track : tracks) {
    const int moments = static_cast<int>(std::clamp(10.0 * track->lastS(), 1.0, most));
    pose.resize(static_cast<size_t>(track->jointCount()));
    for (int k = 0; k <= moments; ++k) {
      const double at = track->lastS() * k / moments;
      track->pose(at, options.placement, pose);
      const Vec3& shift =
          shifts[relativeToFollowed ? 1 + static_cast<size_t>(std::round(at / stepS)) : 0];
      for (const Vec3& p : pose) points.emplace_back(p + shift);
      addHead(points, track->shape(), pose, shift);
    }
  }
  if (relativeToFollowed || !marksInPlace()) return points;
  const bool aside = options.placement == Placement::SideBySide;
  for (const RootFrame& f : options.path) {
    const Vec3 p(static_cast<float>(f.x), 0.0F, static_cast<float>(f.z));
    if (!aside) points.push_back(p);
    for (size_t m = 0; aside && m < tracks.size(); ++m) points.emplace_back(p + tracks[m]->shift);
  }
  return points;
}

void LiveScene::Internals::updateExtent() {
  const std::vector<Vec3> points = outline(false);
  extent = {};
  if (!points.empty()) {
    Vec3 low = points.front(), high = points.front();
    for (const Vec3& p : points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    extent.centre = 0.5F * (low + high);
    extent.radius = 0.5F * (high - low).norm() + 0.5F;
    extent.floorRadius = 0.5F * level(high - low).norm();
  }
  extent.floorRadius = 1.7F * extent.floorRadius + 5.0F;
  floor.setPlace(extent.centre.x(), extent.centre.z(), extent.floorRadius);
}

Vec3 LiveScene::Internals::meanRoot(double timeS) const {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (size_t m = 0; m < tracks.size(); ++m) {
    if (someHighlighted && !motions[m].highlighted) continue;
    // Averaged over a second, so that the camera glides.
    for (int k = -2; k <= 2; ++k) sum += tracks[m]->joint(timeS + 0.25 * k, 0, options.placement);
    count += 5;
  }
  return count == 0 ? Vec3::Zero() : level(sum / static_cast<float>(count));
}

void LiveScene::Internals::followNow() {
  const Vec3 now = meanRoot(time), step = now - followed;
  followed = now;
  Camera shifted = camera();
  shifted.eye += step;
  shifted.target += step;
  apply(shifted);
}

void LiveScene::setView(LiveView view, int width, int height) {
  Internals& i = *m_internals;
  const Vec3 travel =
      i.options.placement == Placement::RootAligned ? Vec3(Vec3::UnitZ()) : travelOf(i.tracks);
  const ViewAxes axes = axesFor(view, travel);
  Camera camera = i.camera();
  camera.fovY = fovY;
  camera.target = i.extent.centre;
  camera.eye = camera.target - axes.forward;
  camera.up = axes.up;
  i.apply(camera);
  // The light comes from the upper left of the viewer.
  const Vec3 back = Vec3::UnitY().cross(axes.right);
  const Vec3 shade = 0.34F * axes.right + 0.20F * back;
  i.slant = {shade.x(), shade.z()};
  i.sceneChanged = true;
  fit(width, height);
}

void LiveScene::fit(int width, int height) {
  Internals& i = *m_internals;
  std::vector<Vec3> points = i.outline(i.following);
  const Vec3 centre = i.following ? i.followed : i.extent.centre;
  if (points.empty())
    points = {centre - Vec3(1.0F, centre.y(), 1.0F), centre + Vec3(1.0F, 0.9F, 1.0F)};
  const Camera before = i.camera();
  const double margin = 0.07 * std::min(width, height) + 6.0;
  const Frame frame{.width = std::max(32, width),
                    .height = std::max(32, height),
                    .left = margin,
                    .right = margin,
                    .top = margin,
                    .bottom = margin};
  Camera camera = fitCamera(points, {before.right(), before.trueUp(), before.forward()},
                            before.orthographic, frame);
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : points) middle += p / static_cast<float>(points.size());
  aimAt(camera, middle);
  camera.fovY = fovY;
  if (!camera.orthographic) {
    camera.heightM = 2.0 * halfHeightAt(camera, (camera.target - camera.eye).norm());
  } else {
    // Far enough away that a change to perspective keeps the size.
    const auto away = static_cast<float>(0.5 * camera.heightM / std::tan(0.5 * fovY));
    camera.eye = camera.target - away * camera.forward();
  }
  i.apply(camera);
}

void LiveScene::setFollow(bool follow) {
  m_internals->following = follow;
  m_internals->followed = m_internals->meanRoot(m_internals->time);
}

bool LiveScene::follow() const {
  return m_internals->following;
}

void LiveScene::setOrthographic(bool orthographic) {
  Camera camera = m_internals->camera();
  if (camera.orthographic == orthographic) return;
  const double tangent = std::tan(0.5 * camera.fovY);
  if (orthographic) {
    camera.heightM = 2.0 * tangent * (camera.target - camera.eye).norm();
  } else {
    const auto away = static_cast<float>(0.5 * camera.heightM / tangent);
    camera.eye = camera.target - away * camera.forward();
  }
  camera.orthographic = orthographic;
  m_internals->apply(camera);
}

bool LiveScene::orthographic() const {
  return m_internals->camera().orthographic;
}

void LiveScene::orbit(double aroundRad, double upRad) {
  Camera camera = m_internals->camera();
  const Vec3 forward = camera.forward();
  const float away = (camera.target - camera.eye).norm();
  // Looking straight down, the picture's upper edge tells the heading.
  const bool down = level(forward).norm() < 0.02F;
  const Vec3 heading = level(down ? camera.trueUp() : forward).normalized();
  const float lowest = std::asin(std::clamp((lowestEyeM - camera.target.y()) / away, -1.0F, 1.0F));
  const float elevation =
      std::clamp(std::asin(std::clamp(-forward.y(), -1.0F, 1.0F)) + static_cast<float>(upRad),
                 lowest, static_cast<float>(0.5 * M_PI));
  const Vec3 turned = Eigen::AngleAxisf(static_cast<float>(aroundRad), Vec3::UnitY()) * heading;
  const ViewAxes axes = lookingDown(turned, elevation);
  camera.eye = camera.target - away * axes.forward;
  camera.up = axes.up;
  m_internals->apply(camera);
}

void LiveScene::pan(double x, double y, int height) {
  Camera camera = m_internals->camera();
  const double perPixel =
      halfHeightAt(camera, (camera.target - camera.eye).norm()) / (0.5 * std::max(1, height));
  Vec3 step = static_cast<float>(-x * perPixel) * camera.right() +
              static_cast<float>(y * perPixel) * camera.trueUp();
  step.y() = std::max(step.y(), std::min(0.0F, lowestEyeM - camera.eye.y()));
  camera.eye += step;
  camera.target += step;
  m_internals->apply(camera);
}

void LiveScene::zoom(double factor) {
  if (!(factor > 0.0)) return;
  Camera camera = m_internals->camera();
  camera.heightM = std::clamp(camera.heightM / factor, 0.02, 2000.0);
  const float away = (camera.target - camera.eye).norm();
  const float next = std::clamp(away / static_cast<float>(factor), 0.15F, 2000.0F);
  camera.eye = camera.target - next * camera.forward();
  camera.eye.y() = std::max(camera.eye.y(), std::min(lowestEyeM, camera.target.y()));
  m_internals->apply(camera);
}

Camera LiveScene::camera() const {
  return m_internals->camera();
}

Viewpoint LiveScene::viewpoint() const {
  return {camera(), m_internals->slant, m_internals->time};
}

void LiveScene::setViewpoint(const Viewpoint& viewpoint) {
  setTime(viewpoint.timeS);
  m_internals->apply(viewpoint.camera);
  m_internals->slant = viewpoint.light;
  m_internals->sceneChanged = true;
}

std::optional<Hit> LiveScene::pick(double x, double y, int width, int height, double reach) const {
  constexpr double alike = 3.0;  // pixels; of joints over each other the one in front is meant
  const Camera camera = m_internals->camera();
  struct Found {
    Hit hit;
    float depth;
  };
  std::vector<Found> found;
  double nearest = reach;
  for (size_t m = 0; m < m_internals->motions.size(); ++m) {
    if (m_internals->shownColour(m, time()).a <= 0.0) continue;
    const auto pose = m_internals->poseOf(m);
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

std::optional<Vec3> LiveScene::floorPoint(double x, double y, int width, int height) const {
  const Sight sight = sightOf(m_internals->camera(), x, y, width, height);
  if (std::abs(sight.direction.y()) < 1e-6F) return std::nullopt;
  const float along = -sight.origin.y() / sight.direction.y();
  if (along <= 0.0F) return std::nullopt;
  Vec3 place = sight.origin + along * sight.direction;
  place.y() = 0.0F;
  return place;
}

ScreenPoint LiveScene::screenPoint(const Vec3& world, int width, int height) const {
  return project(m_internals->camera(), world, width, height);
}

}  // namespace marey::render
