#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "render/scene/render_bench.h"
#include "render/scene/scene_picture.h"
#include "render/scene_motion.h"
#include "render/tiny_clip.h"

namespace marey::render {
namespace {

constexpr int width = 360, height = 300;

/// Nothing but figures.
SceneOptions bare() {
  SceneOptions options;
  options.floor = options.shadow = false;
  return options;
}

Scene sceneOf(std::vector<SceneMotion> motions, SceneOptions options = bare()) {
  Scene scene;
  scene.setMotions(std::move(motions));
  scene.setOptions(std::move(options));
  scene.setView(View::ThreeQuarter, width, height);
  return scene;
}

Image pictureOf(const Scene& scene) {
  return ScenePicture().take(scene, width, height);
}

const uint8_t* pixelAt(const Image& image, const ScreenPoint& at) {
  return image.at(std::clamp(static_cast<int>(at.x), 0, image.width - 1),
                  std::clamp(static_cast<int>(at.y), 0, image.height - 1));
}

int distance(const uint8_t* a, const uint8_t* b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

/// Pixels that differ from the upper left corner.
int inkOf(const Image& image) {
  int ink = 0;
  for (size_t i = 0; i < image.pixels.size(); i += 4)
    ink += distance(&image.pixels[i], image.pixels.data()) > 30 ? 1 : 0;
  return ink;
}

bool isRed(const uint8_t* p) {
  return p[0] > p[1] + 50 && p[0] > p[2] + 50;
}

bool isBlue(const uint8_t* p) {
  return p[2] > p[0] + 40;
}

TEST(ScenePicture, EveryJointIsDrawnWhereItIsProjected) {
  Scene scene = sceneOf({motionOf(tinyClip(11), red)});
  for (const bool orthographic : {false, true}) {
    scene.setOrthographic(orthographic);
    scene.setView(View::ThreeQuarter, width, height);
    for (const double time : {0.0, 0.55, 1.0}) {
      scene.setTime(time);
      const Image image = pictureOf(scene);
      for (const Vec3& joint : scene.pose(0))
        EXPECT_TRUE(isRed(pixelAt(image, scene.screenPoint(joint, width, height)))) << time;
      const Vec3 beside = scene.pose(0)[7] + Vec3(0.3F, -0.2F, 0);
      EXPECT_FALSE(isRed(pixelAt(image, scene.screenPoint(beside, width, height)))) << time;
    }
  }
}

TEST(ScenePicture, TheHighlightedMotionKeepsItsColourAndTheOthersStepBack) {
  Clip aside = tinyClip(2);
  for (Vec3& p : aside.positions) p.x() += 1.5F;
  const auto strength = [&](const Scene& scene, size_t motion) {
    const Vec3 place = scene.pose(motion)[7];
    const Image image = pictureOf(scene);
    const uint8_t* p = pixelAt(image, scene.screenPoint(place, width, height));
    return p[0] - p[1];
  };
  Scene scene = sceneOf({motionOf(tinyClip(2), red), motionOf(aside, red)});
  const int plain = strength(scene, 1);
  ASSERT_GT(plain, 80);
  std::vector<SceneMotion> motions = scene.motions();
  motions[0].highlighted = true;
  motions[0].opacity = 0.2;
  scene.setMotions(motions);
  EXPECT_GT(strength(scene, 0), 0.8 * plain) << "a highlighted motion is solid";
  EXPECT_LT(strength(scene, 1), 0.6 * plain);
}

TEST(ScenePicture, NearFiguresHideFarOnes) {
  for (const float z : {-1.0F, 1.0F}) {
    Clip other = tinyClip(1);
    for (Vec3& p : other.positions) p.z() += z;
    Scene scene = sceneOf({motionOf(tinyClip(1), red), motionOf(other, blue)});
    scene.setOrthographic(true);
    scene.setView(View::Side, width, height);
    scene.orbit(0.0, -0.05);
    const Vec3 forward = scene.camera().forward();
    const bool redNearer = forward.dot(scene.pose(0)[0]) < forward.dot(scene.pose(1)[0]);
    const Vec3 front = scene.pose(redNearer ? 0 : 1)[0];
    const Image image = pictureOf(scene);
    const uint8_t* p = pixelAt(image, scene.screenPoint(front, width, height));
    EXPECT_TRUE(redNearer ? isRed(p) : isBlue(p)) << z;
  }
}

TEST(ScenePicture, AHalfOpaqueFigureIsHalfWayToTheBackgroundEvenWhereLimbsCross) {
  const Image solid = pictureOf(sceneOf({motionOf(tinyClip(1), red)}));
  const Image half = pictureOf(sceneOf({motionOf(tinyClip(1), red, 0.5)}));
  const uint8_t* back = solid.pixels.data();
  int inside = 0, wrong = 0;
  for (size_t i = 0; i < solid.pixels.size(); i += 4) {
    int error = 0;
    for (size_t c = 0; c < 3; ++c) {
      error = std::max(error, std::abs(half.pixels[i + c] - (solid.pixels[i + c] + back[c]) / 2));
    }
    inside += distance(&solid.pixels[i], back) > 100 ? 1 : 0;
    wrong += error > 12 ? 1 : 0;
  }
  ASSERT_GT(inside, 1500);
  EXPECT_LT(wrong, inside / 50) << "only soft edges inside the figure may differ";
}

TEST(ScenePicture, GhostsAddPalerFigures) {
  SceneOptions options = bare();
  Scene scene = sceneOf({motionOf(tinyClip(21), red)}, options);
  ScenePicture picture;
  const Image alone = picture.take(scene, width, height);
  EXPECT_EQ(scene.cost().figures, 1U);
  options.strobe.everyS = 0.5;
  scene.setOptions(options);
  const Image ghosts = picture.take(scene, width, height);
  EXPECT_EQ(scene.cost().figures, 1U + 5U);
  EXPECT_GT(inkOf(ghosts), 2 * inkOf(alone));
  scene.setTime(2.0);
  const Vec3 first = tinyClip(1).at(0, 7);
  const ScreenPoint at = scene.screenPoint(first, width, height);
  const Image later = picture.take(scene, width, height);
  const int ghost = distance(pixelAt(later, at), later.pixels.data());
  const int solid = distance(pixelAt(alone, at), alone.pixels.data());
  EXPECT_GT(ghost, 0.15 * solid);
  EXPECT_LT(ghost, 0.5 * solid);
}

TEST(ScenePicture, LinesAreThinnerThanCapsules) {
  SceneOptions options = bare();
  options.detail = BodyDetail::Lines;
  Scene scene = sceneOf({motionOf(tinyClip(1), red)}, options);
  const int lines = inkOf(pictureOf(scene));
  EXPECT_TRUE(scene.cost().lines);
  options.detail = BodyDetail::Capsules;
  scene.setOptions(options);
  const int capsules = inkOf(pictureOf(scene));
  EXPECT_FALSE(scene.cost().lines);
  EXPECT_GT(lines, 100);
  EXPECT_GT(capsules, 4 * lines);
}

TEST(ScenePicture, ACrowdIsDrawnAsLinesUnlessAskedOtherwise) {
  SceneMotion one = motionOf(tinyClip(1), red);
  Scene scene = sceneOf(std::vector<SceneMotion>(1000, one));
  pictureOf(scene);
  EXPECT_TRUE(scene.cost().lines);
  scene.setMotions(std::vector<SceneMotion>(40, one));
  pictureOf(scene);
  EXPECT_FALSE(scene.cost().lines);
}

TEST(ScenePicture, BackgroundsAreLightOrDarkWithTheFloorSeenOnBoth) {
  for (const bool dark : {false, true}) {
    SceneOptions options;
    options.tone = dark ? Tone::Dark : Tone::Light;
    Scene scene = sceneOf({motionOf(tinyClip(1), naturalColour())}, options);
    const Image image = pictureOf(scene);
    const double back = (image.pixels[0] + image.pixels[1] + image.pixels[2]) / 3.0;
    EXPECT_NEAR(image.pixels[0], 255 * scene.background().r, 8);
    EXPECT_TRUE(dark ? back < 60 : back > 200) << back;
    const Vec3 hips = scene.pose(0)[0];
    const uint8_t* body = pixelAt(image, scene.screenPoint(hips, width, height));
    EXPECT_GT(distance(body, image.pixels.data()), 200) << "natural motion stands out";
    options.floor = false;
    scene.setOptions(options);
    const ScreenPoint beside = scene.screenPoint({-0.4F, 0, 0.3F}, width, height);
    EXPECT_GT(distance(pixelAt(image, beside), pixelAt(pictureOf(scene), beside)), 8);
  }
}

TEST(ScenePicture, TheShadowFallsOnTheFloorBesideTheFigure) {
  SceneOptions options;
  options.shadow = false;
  Scene scene = sceneOf({motionOf(tinyClip(1), red)}, options);
  const Image without = pictureOf(scene);
  options.shadow = true;
  scene.setOptions(options);
  const Image with = pictureOf(scene);
  int darker = 0, lighter = 0;
  for (size_t i = 0; i < with.pixels.size(); i += 4) {
    darker += with.pixels[i + 1] + 6 < without.pixels[i + 1] ? 1 : 0;
    lighter += with.pixels[i + 1] > without.pixels[i + 1] + 1 ? 1 : 0;
  }
  EXPECT_GT(darker, 200);
  EXPECT_EQ(lighter, 0);
}

TEST(ScenePicture, FramesHaveTheirOwnColours) {
  SceneMotion motion = motionOf(tinyClip(3), red);
  motion.frameColours = {blue, red, blue};
  Scene scene = sceneOf({motion});
  for (const auto& [time, expectRed] : {std::pair{0.0, false}, {0.1, true}, {0.19, false}}) {
    scene.setTime(time);
    const Image image = pictureOf(scene);
    const uint8_t* p = pixelAt(image, scene.screenPoint(scene.pose(0)[7], width, height));
    EXPECT_EQ(isRed(p), expectRed) << time;
    EXPECT_EQ(isBlue(p), !expectRed) << time;
  }
}

TEST(ScenePicture, ATrailLiesWhereTheJointWas) {
  SceneOptions options = bare();
  options.trailS = 0.8;
  SceneMotion motion = motionOf(tinyClip(31), red);
  motion.trailJoints = {7, 99};  // a joint that is not there is left out
  Scene scene = sceneOf({motion}, options);
  scene.setTime(2.0);
  const Image image = pictureOf(scene);
  const auto inkNear = [&](double time) {
    Vec3 place = tinyClip(1).at(0, 7);
    place.x() += static_cast<float>(time);
    const ScreenPoint at = scene.screenPoint(place, width, height);
    int most = 0;
    for (int dy = -2; dy <= 2; ++dy)
      most = std::max(most, distance(pixelAt(image, {at.x, at.y + dy}), image.pixels.data()));
    return most;
  };
  EXPECT_GT(inkNear(1.7), 60);
  EXPECT_GT(inkNear(1.4), 25);
  EXPECT_LT(inkNear(1.4), inkNear(1.7)) << "it fades";
  EXPECT_LT(inkNear(1.1), 5);
}

TEST(ScenePicture, AFootAtRestLeavesARing) {
  SceneOptions options;
  options.shadow = false;
  options.contactMarks = true;
  Scene scene = sceneOf({motionOf(tinyClipWithRest(31, 6, 12), red)}, options);
  scene.setView(View::Top, width, height);
  const auto redAt = [&](double time) {
    scene.setTime(time);
    const Image image = pictureOf(scene);
    // The left foot rests at x = 0.6, z = 0.1; its ring is 5.5 cm wide.
    int found = 0;
    for (int k = 0; k < 24; ++k) {
      const float turn = static_cast<float>(k) * 0.2618F;
      const Vec3 place(0.6F + 0.055F * std::cos(turn), 0, 0.1F + 0.055F * std::sin(turn));
      found += isRed(pixelAt(image, scene.screenPoint(place, width, height))) ? 1 : 0;
    }
    return found;
  };
  EXPECT_LE(redAt(0.0), 2);
  EXPECT_GE(redAt(3.0), 12);
}

TEST(ScenePicture, ThePathIsDrawnOnTheFloor) {
  SceneOptions options;
  options.shadow = false;
  for (int i = 0; i <= 20; ++i) options.path.push_back({0.1 * i, 0.6, M_PI / 2});
  Scene scene = sceneOf({motionOf(tinyClip(21), red)}, options);
  scene.setView(View::Top, width, height);
  const Image with = pictureOf(scene);
  const ScreenPoint at = scene.screenPoint({0.75F, 0, 0.6F}, width, height);
  options.path.clear();
  scene.setOptions(options);
  EXPECT_GT(distance(pixelAt(with, at), pixelAt(pictureOf(scene), at)), 100);
}

TEST(ScenePicture, AHighlightedJointHasABall) {
  SceneMotion motion = motionOf(tinyClip(1), blue);
  motion.highlightJoint = 6;
  Scene scene = sceneOf({motion}, bare());
  const Image image = pictureOf(scene);
  const uint8_t* p = pixelAt(image, scene.screenPoint(scene.pose(0)[6], width, height));
  EXPECT_GT(p[0], p[2] + 60);
}

TEST(ScenePicture, EarlierDrawingsLeaveNoTrace) {
  SceneOptions options;
  options.contactMarks = true;
  const auto fresh = [&] {
    SceneMotion resting = motionOf(tinyClipWithRest(31, 6, 12), red);
    SceneMotion gliding = motionOf(tinyClip(9), blue, 0.4);
    resting.trailJoints = gliding.trailJoints = {7};
    return sceneOf({resting, gliding}, options);
  };
  Scene scene = fresh();
  scene.setTime(1.1);
  const Image expected = pictureOf(scene);
  Scene used = fresh();
  ScenePicture picture;
  for (const double time : {2.5, 0.0, 0.3}) {
    used.setTime(time);
    picture.take(used, width, height);
  }
  const std::vector<SceneMotion> motions = used.motions();
  used.setMotions(std::vector<SceneMotion>(70, motions[1]));
  picture.take(used, width, height);
  used.setMotions(motions);
  used.setTime(1.1);
  EXPECT_EQ(picture.take(used, width, height).pixels, expected.pixels);
}

TEST(RenderBench, MeasuresBothPaths) {
  Progress progress;
  const RenderBenchResult result =
      benchRender({.motions = 3, .frames = 2, .width = 64, .height = 48}, progress);
  EXPECT_GT(result.msPerFrame, result.fillMs);
  EXPECT_GT(result.fillMs, 0.0);
  EXPECT_GT(result.referenceMsPerFrame, 0.0);
  EXPECT_EQ(result.referenceFrames, 2);
  EXPECT_EQ(result.joints, 21);
}

}  // namespace
}  // namespace marey::render
