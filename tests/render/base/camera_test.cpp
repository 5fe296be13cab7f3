#include "render/base/camera.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"

namespace marey::render {
namespace {

TEST(Camera, ProjectsAsWorkedOutByHand) {
  Camera camera;
  camera.eye = {0, 1, 5};
  camera.target = {0, 1, 0};
  camera.fovY = 2.0 * std::atan(0.5);  // 5 m away the picture is 5 m high
  const ScreenPoint centre = project(camera, {0, 1, 0}, 200, 100);
  EXPECT_NEAR(centre.x, 100.0, 1e-4);
  EXPECT_NEAR(centre.y, 50.0, 1e-4);
  const ScreenPoint aside = project(camera, {1, 2, 0}, 200, 100);  // 20 pixels per metre
  EXPECT_NEAR(aside.x, 120.0, 1e-4);
  EXPECT_NEAR(aside.y, 30.0, 1e-4);
  const ScreenPoint near = project(camera, {1, 1, 2.5F}, 200, 100);  // half as far: twice as large
  EXPECT_NEAR(near.x, 140.0, 1e-4);
}

TEST(Camera, WithoutPerspectiveDepthDoesNotMatter) {
  Camera camera;
  camera.eye = {0, 1, 5};
  camera.target = {0, 1, 0};
  camera.orthographic = true;
  camera.heightM = 4.0;
  for (const float z : {-3.0F, 0.0F, 3.0F}) {
    EXPECT_NEAR(project(camera, {1, 2, z}, 200, 100).x, 125.0, 1e-4);
    EXPECT_NEAR(project(camera, {1, 2, z}, 200, 100).y, 25.0, 1e-4);
  }
}

std::vector<Vec3> cloud() {
  std::vector<Vec3> points;
  for (int i = 0; i < 60; ++i) {
    const auto t = static_cast<float>(i);
    points.emplace_back(3.0F * std::sin(t), 0.9F + 0.9F * std::cos(2.3F * t), 0.2F * t - 4.0F);
  }
  return points;
}

TEST(Camera, SeesEveryPointAndIsAsNearAsItCanBe) {
  const auto points = cloud();
  const Frame frame{.width = 640, .height = 360, .left = 20, .right = 30, .top = 50, .bottom = 10};
  const Vec3 down(0.0F, -0.6F, -0.8F), level(-1.0F, 0.0F, 0.0F);
  for (const Vec3& forward : {down, level}) {
    const Vec3 right = forward.cross(Vec3::UnitY()).normalized();
    const ViewAxes axes{right, right.cross(forward), forward};
    for (const bool orthographic : {false, true}) {
      const Camera camera = fitCamera(points, axes, orthographic, frame);
      double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
      for (const Vec3& p : points) {
        const ScreenPoint at = project(camera, p, frame.width, frame.height);
        left = std::min(left, at.x);
        right = std::max(right, at.x);
        top = std::min(top, at.y);
        bottom = std::max(bottom, at.y);
      }
      EXPECT_GE(left, 20.0 - 0.1);
      EXPECT_LE(right, 610.0 + 0.1);
      EXPECT_GE(top, 50.0 - 0.1);
      EXPECT_LE(bottom, 350.0 + 0.1);
      // It touches both sides or both the top and the bottom.
      const bool touchesAcross = std::abs(left - 20.0) < 0.2 && std::abs(right - 610.0) < 0.2;
      const bool touchesUp = std::abs(top - 50.0) < 0.2 && std::abs(bottom - 350.0) < 0.2;
      EXPECT_TRUE(touchesAcross || touchesUp)
          << left << " " << right << " " << top << " " << bottom;
    }
  }
}

TEST(Camera, TravelIsTheNetWayTheLongAxisOrTheFallback) {
  const std::vector<Vec3> straight = {{0, 1, 0}, {0.5F, 1, 0.1F}, {1, 1, 0}, {2, 1.2F, 0}};
  EXPECT_LT((travelDirection(straight, Vec3::UnitZ()) - Vec3::UnitX()).norm(), 1e-5F);
  std::vector<Vec3> there_and_back;
  for (int i = 0; i <= 20; ++i) there_and_back.emplace_back(0, 1, i <= 10 ? i : 20 - i);
  EXPECT_LT((travelDirection(there_and_back, Vec3::UnitZ()) - Vec3::UnitZ()).norm(), 1e-5F);
  const std::vector<Vec3> still(5, Vec3(1, 1, 1));
  EXPECT_EQ(travelDirection(still, Vec3::UnitX()), Vec3::UnitX());
}

TEST(Camera, NothingToLookAtIsAnError) {
  EXPECT_THROW(fitCamera({}, {Vec3::UnitX(), Vec3::UnitY(), -Vec3::UnitZ()}, false, {}),
               NumericError);
}

}  // namespace
}  // namespace marey::render
