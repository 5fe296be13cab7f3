#include "render/scene/views.h"

#include <gtest/gtest.h>

namespace marey::render {
namespace {

const std::vector<Vec3> walked = {{0, 1, 0}, {1, 1, 3}};

TEST(Views, ShowAWalkGoingToTheRight) {
  const Vec3 travel = travelDirection(walked, Vec3::UnitX());
  for (const View view : {View::ThreeQuarter, View::Side, View::Top}) {
    const Camera camera = fittedCamera(walked, axesFor(view, travel, 0.0), false, {});
    EXPECT_LT(project(camera, walked[0], 800, 600).x, project(camera, walked[1], 800, 600).x);
  }
}

TEST(Views, LookFromHigherUpWhereMotionsSpread) {
  const auto drop = [](double spreadM) {
    return axesFor(View::ThreeQuarter, Vec3::UnitX(), spreadM).forward.y();
  };
  EXPECT_LT(drop(4.0), drop(2.0));
  EXPECT_LT(drop(2.0), drop(0.0));
  EXPECT_EQ(drop(40.0), drop(4.0)) << "but never straight down";
}

TEST(Views, AnotherProjectionKeepsTheSizeInTheMiddle) {
  const Camera before = fittedCamera(walked, axesFor(View::Side, Vec3::UnitX(), 0.0), false, {});
  const Vec3 above = before.target + before.trueUp();
  const double pixels = project(before, before.target, 800, 600).y -
                        project(before, above, 800, 600).y;
  for (const Camera& after : {withProjection(before, true),
                              withProjection(withProjection(before, true), false)})
    EXPECT_NEAR(project(after, after.target, 800, 600).y - project(after, above, 800, 600).y,
                pixels, 0.01 * pixels);
}

TEST(Views, OrbitingNeverGoesBelowTheFloor) {
  Camera camera = fittedCamera(walked, axesFor(View::Side, Vec3::UnitX(), 0.0), false, {});
  for (int k = 0; k < 50; ++k) camera = orbited(camera, 0.1, -0.2);
  EXPECT_GT(camera.eye.y(), 0.0F);
}

}  // namespace
}  // namespace marey::render
