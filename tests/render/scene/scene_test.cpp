#include "render/scene/scene.h"

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>
#include <stdlib.h>

#include "base/error.h"
#include "render/baseline.h"
#include "render/tiny_clip.h"

namespace marey::render {
namespace {

SceneMotion motionOf(Clip clip, const Colour& colour, double opacity, const std::string& name) {
  SceneMotion motion;
  motion.clip = std::make_shared<const Clip>(std::move(clip));
  motion.colour = colour;
  motion.opacity = opacity;
  motion.system = name;
  motion.strobeS = 0.6;
  return motion;
}

/// Bare: no floor, no text; only figures on white.
SceneSpec bareScene(SceneMotion motion) {
  SceneSpec scene;
  scene.motions.push_back(std::move(motion));
  scene.floor = scene.legend = scene.scaleBar = false;
  scene.view = View::Side;
  scene.orthographic = true;
  return scene;
}

SceneSpec fullScene() {
  SceneSpec scene;
  scene.title = "Tiny";
  scene.motions.push_back(motionOf(tinyClipWithRest(19, 6, 12), naturalColour(), 1.0, "natural"));
  Clip aside = tinyClip(19);
  for (Vec3& p : aside.positions) p += Vec3(0.15F, 0, 0.25F);
  scene.motions.push_back(motionOf(std::move(aside), colourOf(1), 0.5, "samples"));
  for (int i = 0; i <= 18; ++i) scene.path.push_back({0.1 * i, 0.0, M_PI / 2});
  return scene;
}

struct Extent {
  int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1, pixels = 0;
};
/// Where pixels are darker than white.
Extent inkOf(const Image& image) {
  Extent extent;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const uint8_t* p = image.at(x, y);
      if (p[0] + p[1] + p[2] > 3 * 250) continue;
      extent.left = std::min(extent.left, x);
      extent.right = std::max(extent.right, x);
      extent.top = std::min(extent.top, y);
      extent.bottom = std::max(extent.bottom, y);
      ++extent.pixels;
    }
  }
  return extent;
}

TEST(Scene, AStrobedSceneLooksAsItDid) {
  EXPECT_TRUE(matchesBaseline(renderScene(fullScene(), 300, 300), "scene_three_quarter"));
}

TEST(Scene, FromAboveWithoutPerspectiveItLooksAsItDid) {
  SceneSpec scene = fullScene();
  scene.view = View::Top;
  scene.orthographic = true;
  EXPECT_TRUE(matchesBaseline(renderScene(scene, 300, 300), "scene_top"));
}

TEST(Scene, AFollowedFrameLooksAsItDid) {
  SceneRenderer renderer(fullScene(), 300, 300);
  EXPECT_TRUE(matchesBaseline(renderer.frame(1.2, true, true), "scene_follow_trail"));
}

TEST(Scene, TheSameSceneGivesTheSameBytes) {
  const Image first = renderScene(fullScene(), 200, 150);
  EXPECT_EQ(first.pixels, renderScene(fullScene(), 200, 150).pixels);
  SceneRenderer renderer(fullScene(), 200, 150);
  renderer.frame(0.5);
  EXPECT_EQ(first.pixels, renderer.still().pixels) << "earlier frames must leave no trace";
}

TEST(Scene, TheFigureFillsThePictureUpToItsMargins) {
  const Image image =
      renderScene(bareScene(motionOf(tinyClip(1), naturalColour(), 1.0, "")), 300, 300);
  const Extent ink = inkOf(image);
  // 4 % of the size and 6 pixels of margin to joints; limbs are a few pixels thick.
  EXPECT_NEAR(ink.top, 18, 8);
  EXPECT_NEAR(ink.bottom, 300 - 18, 12);
  EXPECT_GT(ink.left, 18);
  EXPECT_LT(ink.right, 300 - 18);
}

TEST(Scene, StrobedFiguresStandWhereTheMotionWas) {
  // 1.2 m at 1 m/s with a figure every 0.6 s: three figures, and nothing between them.
  SceneSpec scene = bareScene(motionOf(tinyClip(13), naturalColour(), 1.0, ""));
  const Image image = renderScene(scene, 400, 300);
  int runs = 0;
  bool before = false;
  const int row = inkOf(image).top + 8;  // through the heads
  for (int x = 0; x < image.width; ++x) {
    const bool dark = image.at(x, row)[0] < 128;
    runs += dark && !before ? 1 : 0;
    before = dark;
  }
  EXPECT_EQ(runs, 3);
}

TEST(Scene, AHalfOpaqueFigureIsHalfWayToTheBackground) {
  const Image solid = renderScene(bareScene(motionOf(tinyClip(1), colourOf(0), 1.0, "")), 300, 300);
  const Image half = renderScene(bareScene(motionOf(tinyClip(1), colourOf(0), 0.5, "")), 300, 300);
  int inside = 0;
  for (int y = 0; y < 300; ++y) {
    for (int x = 0; x < 300; ++x) {
      for (int c = 0; c < 3; ++c) {
        ASSERT_NEAR(half.at(x, y)[c], (solid.at(x, y)[c] + 255) / 2.0, 2.0) << x << "," << y;
      }
      inside += solid.at(x, y)[0] < 200 ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 1000);
}

TEST(Scene, SolidFiguresHideWhatIsBehindAndNotWhatIsInFront) {
  Clip behind = tinyClip(1);
  for (Vec3& p : behind.positions) p.z() -= 1.0F;
  SceneSpec scene = bareScene(motionOf(tinyClip(1), naturalColour(), 1.0, ""));
  const Image alone = renderScene(scene, 200, 200);
  scene.motions.push_back(motionOf(behind, colourOf(1), 0.5, ""));
  const Image hidden = renderScene(scene, 200, 200);
  // Without perspective and seen along z, the one behind is hidden but for its softened rim.
  const Extent a = inkOf(alone), b = inkOf(hidden);
  EXPECT_NEAR(a.pixels, b.pixels, 0.03 * a.pixels);
  Clip inFront = tinyClip(1);
  for (Vec3& p : inFront.positions) p.z() += 1.0F;
  scene.motions.back() = motionOf(inFront, colourOf(1), 0.5, "");
  const Image tinted = renderScene(scene, 200, 200);
  double redder = 0.0;
  for (size_t i = 0; i < alone.pixels.size(); i += 4) redder += tinted.pixels[i] - alone.pixels[i];
  EXPECT_GT(redder, 5.0 * a.pixels);
}

TEST(Scene, WhatCannotBeDrawnIsRefused) {
  EXPECT_THROW(renderScene({}, 100, 100), InputError);
  SceneSpec scene = fullScene();
  EXPECT_THROW(renderScene(scene, 10, 10), InputError);
  scene.motions[0].strobeS = 0.0;
  EXPECT_THROW(renderScene(scene, 100, 100), InputError);
  Clip broken = tinyClip(3);
  broken.positions[4].x() = NAN;
  EXPECT_THROW(renderScene(bareScene(motionOf(broken, naturalColour(), 1.0, "")), 100, 100),
               InputError);
}

TEST(Baseline, AMissingOneFailsAndKeepsThePicture) {
  const std::filesystem::path kept = std::filesystem::current_path() / "no_such_baseline.png";
  std::filesystem::remove(kept);
  EXPECT_FALSE(matchesBaselineIn("no/such/folder", Image(20, 20), "no_such_baseline", 0.9));
  EXPECT_TRUE(std::filesystem::exists(kept));
  std::filesystem::remove(kept);
}

TEST(Baseline, AnotherColourOfTheSameBrightnessFails) {
  std::string pattern = (std::filesystem::temp_directory_path() / "marey-baseline-XXXXXX").string();
  ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
  const std::filesystem::path folder = pattern;
  // 0.299 * 100 = 0.587 * 50.94
  writePng(folder / "flat_colour.png", Image(20, 20, {100 / 255.0, 0, 0, 1}));
  EXPECT_TRUE(matchesBaselineIn(folder.string(), Image(20, 20, {100 / 255.0, 0, 0, 1}),
                                "flat_colour", 0.97));
  EXPECT_FALSE(matchesBaselineIn(folder.string(), Image(20, 20, {0, 51 / 255.0, 0, 1}),
                                 "flat_colour", 0.97));
  std::filesystem::remove_all(folder);
  std::filesystem::remove(std::filesystem::current_path() / "flat_colour.png");
}

}  // namespace
}  // namespace marey::render
