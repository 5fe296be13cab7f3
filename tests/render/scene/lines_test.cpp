// Lines of crowds: their width, colour and place, at every slant.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "render/scene/scene_picture.h"
#include "render/scene_motion.h"

namespace marey::render {
namespace {

constexpr int width = 400, height = 400;

/// A hub with bones to these places.
Clip spokes(const Vec3& hub, const std::vector<Vec3>& ends) {
  Skeleton skeleton;
  Clip clip;
  clip.fps = 10.0;
  skeleton.names = {"hub"};
  skeleton.parents = {-1};
  skeleton.offsets = {hub};
  clip.positions = {hub};
  for (const Vec3& end : ends) {
    skeleton.names.push_back("end" + std::to_string(skeleton.names.size()));
    skeleton.parents.push_back(0);
    skeleton.offsets.push_back(end - hub);
    clip.positions.push_back(end);
  }
  clip.skeleton = std::make_shared<const Skeleton>(skeleton);
  return clip;
}

Scene sceneOf(Clip clip) {
  Scene scene;
  scene.setMotions({motionOf(std::move(clip), red)});
  SceneOptions options;
  options.floor = options.shadow = false;
  options.detail = BodyDetail::Lines;
  scene.setOptions(options);
  return scene;
}

/// How far a place is from the background towards the colour of the line, 0 to 1, between pixels.
double inkAt(const Image& image, double x, double y) {
  const auto ink = [&](int column, int row) {
    const double back = image.pixels[1];
    return (back - image.at(column, row)[1]) / (back - 255.0 * red.g);
  };
  const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
  const double fx = x - 0.5 - left, fy = y - 0.5 - top;
  const int c = static_cast<int>(left), r = static_cast<int>(top);
  return (1 - fy) * ((1 - fx) * ink(c, r) + fx * ink(c + 1, r)) +
         fy * ((1 - fx) * ink(c, r + 1) + fx * ink(c + 1, r + 1));
}

/// Ink across a line at a place on it, as pixels of full colour.
double widthAt(const Image& image, const ScreenPoint& from, const ScreenPoint& to, double share) {
  const double dx = to.x - from.x, dy = to.y - from.y, length = std::hypot(dx, dy);
  double sum = 0.0;
  for (double off = -5.0; off <= 5.0; off += 0.1) {
    sum += 0.1 * inkAt(image, from.x + share * dx - off * dy / length,
                       from.y + share * dy + off * dx / length);
  }
  return sum;
}

TEST(Lines, HaveTheirWidthAndColourAtEverySlant) {
  std::vector<Vec3> ends;
  const Vec3 hub(0.0F, 1.5F, 0.0F);
  for (int k = 0; k < 16; ++k) {
    const float turn = static_cast<float>(k) * std::numbers::pi_v<float> / 8.0F + 0.03F;
    ends.push_back(hub + Vec3(std::cos(turn), std::sin(turn), 0.2F));
  }
  Scene scene = sceneOf(spokes(hub, ends));
  for (const bool orthographic : {false, true}) {
    scene.setOrthographic(orthographic);
    scene.setView(View::ThreeQuarter, width, height);
    const Image image = ScenePicture().take(scene, width, height);
    const ScreenPoint middle = scene.screenPoint(hub, width, height);
    for (const Vec3& end : ends) {
      const ScreenPoint at = scene.screenPoint(end, width, height);
      ASSERT_GT(std::hypot(at.x - middle.x, at.y - middle.y), 40.0);
      for (const double share : {0.7, 0.9})
        EXPECT_NEAR(widthAt(image, middle, at, share), 1.6, 0.15) << end.transpose();
      EXPECT_GT(inkAt(image, 0.2 * middle.x + 0.8 * at.x, 0.2 * middle.y + 0.8 * at.y), 0.8);
      // Round ends, half a width beyond the joint.
      EXPECT_NEAR(widthAt(image, middle, at, 1.05), 0.0, 0.1);
    }
  }
}

TEST(Lines, OneThatPassesTheViewerIsDrawnUpToTheEdge) {
  Camera camera;
  camera.eye = Vec3(0.0F, 1.5F, 4.0F);
  camera.target = Vec3(0.0F, 1.5F, 0.0F);
  const Vec3 before(0.0F, 1.5F, 0.0F), behind(0.6F, 1.2F, 7.0F);
  Scene scene = sceneOf(spokes(before, {behind}));
  scene.setViewpoint({.camera = camera});
  const Image image = ScenePicture().take(scene, width, height);
  for (const float share : {0.1F, 0.3F, 0.4F}) {
    const ScreenPoint at = scene.screenPoint(before + share * (behind - before), width, height);
    EXPECT_GT(inkAt(image, at.x, at.y), 0.5) << share;
    EXPECT_LT(inkAt(image, at.x, at.y - 12), 0.05) << share;
  }
}

TEST(Lines, AHighlightedJointHasAWiderDot) {
  const Vec3 hub(0.0F, 1.5F, 0.0F), end(0.8F, 1.2F, 0.0F);
  Scene scene = sceneOf(spokes(hub, {end}));
  std::vector<SceneMotion> motions = scene.motions();
  motions[0].highlightJoint = 1;
  scene.setMotions(motions);
  scene.setView(View::ThreeQuarter, width, height);
  const Image image = ScenePicture().take(scene, width, height);
  const ScreenPoint at = scene.screenPoint(end, width, height);
  const uint8_t* dot = image.at(static_cast<int>(at.x), static_cast<int>(at.y - 2));
  EXPECT_GT(dot[0], 220);
  EXPECT_GT(dot[1], 150) << "amber, not the red of the line";
  EXPECT_LT(dot[2], 80);
}

}  // namespace
}  // namespace marey::render
