#include "render/scene/shot.h"

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>
#include <stdlib.h>

#include "base/error.h"
#include "render/baseline.h"
#include "render/tiny_clip.h"

namespace marey::render {
namespace {

constexpr double everyS = 0.6;

SceneMotion motionOf(Clip clip, const Colour& colour, double opacity, const std::string& name) {
  SceneMotion motion;
  motion.clip = std::make_shared<const Clip>(std::move(clip));
  motion.colour = colour;
  motion.opacity = opacity;
  motion.label = name;
  return motion;
}

/// Bare: no floor, no text; only figures on white.
Shot bareShot(SceneMotion motion) {
  Shot shot = strobed(printed({std::move(motion)}), everyS);
  shot.options.floor = shot.options.contactMarks = false;
  shot.caption = {};
  shot.view = View::Side;
  shot.orthographic = true;
  return shot;
}

/// The same looked at level, along -Z.
Shot levelShot(SceneMotion motion) {
  Shot shot = bareShot(std::move(motion));
  shot.view = std::nullopt;
  shot.viewpoint.camera = {.eye = {0, 0.8F, 5}, .target = {0, 0.8F, 0}, .orthographic = true};
  return shot;
}

Shot fullShot() {
  Clip aside = tinyClip(19);
  for (Vec3& p : aside.positions) p += Vec3(0.15F, 0, 0.25F);
  Shot shot = printed({motionOf(tinyClipWithRest(19, 6, 12), naturalColour(), 1.0, "natural"),
                       motionOf(std::move(aside), colourOf(1), 0.5, "samples")});
  shot.caption.title = "Tiny";
  for (int i = 0; i <= 18; ++i) shot.options.path.push_back({0.1 * i, 0.0, M_PI / 2});
  return shot;
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

TEST(Shot, AStrobedSceneLooksAsItDid) {
  EXPECT_TRUE(
      matchesBaseline(drawEnd(strobed(fullShot(), everyS), 300, 300), "scene_three_quarter"));
}

TEST(Shot, FromAboveWithoutPerspectiveItLooksAsItDid) {
  Shot shot = strobed(fullShot(), everyS);
  shot.view = View::Top;
  shot.orthographic = true;
  EXPECT_TRUE(matchesBaseline(drawEnd(shot, 300, 300), "scene_top"));
}

TEST(Shot, AFollowedFrameLooksAsItDid) {
  Shot shot = withTrail(fullShot(), everyS);
  shot.follow = true;
  EXPECT_TRUE(matchesBaseline(drawShot(shot, 1.2, 300, 300), "scene_follow_trail"));
}

TEST(Shot, TheSameSceneGivesTheSameBytes) {
  const Shot shot = withTrail(fullShot(), everyS);
  const Image first = drawShot(shot, 1.0, 200, 150);
  EXPECT_EQ(first.pixels, drawShot(shot, 1.0, 200, 150).pixels);
  ShotPicture picture(shot, 200, 150);
  picture.at(0.5);
  EXPECT_EQ(first.pixels, picture.at(1.0).pixels) << "earlier frames must leave no trace";
}

TEST(Shot, TheFigureFillsThePictureUpToItsMargins) {
  const Image image = drawEnd(bareShot(motionOf(tinyClip(1), naturalColour(), 1.0, "")), 300, 300);
  const Extent ink = inkOf(image);
  // 5 % of the size and 6 pixels of margin to joints; limbs are a few pixels thick.
  EXPECT_NEAR(ink.top, 21, 8);
  EXPECT_NEAR(ink.bottom, 300 - 21, 12);
  EXPECT_GT(ink.left, 21);
  EXPECT_LT(ink.right, 300 - 21);
}

TEST(Shot, StrobedFiguresStandWhereTheMotionWas) {
  // 1.2 m at 1 m/s with a figure every 0.6 s: three figures, and nothing between them.
  const Image image = drawEnd(bareShot(motionOf(tinyClip(13), naturalColour(), 1.0, "")), 400, 300);
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

TEST(Shot, AHalfOpaqueFigureIsHalfWayToTheBackground) {
  const Image solid = drawEnd(bareShot(motionOf(tinyClip(1), colourOf(0), 1.0, "")), 300, 300);
  const Image half = drawEnd(bareShot(motionOf(tinyClip(1), colourOf(0), 0.5, "")), 300, 300);
  int inside = 0, off = 0;
  for (int y = 0; y < 300; ++y) {
    for (int x = 0; x < 300; ++x) {
      const auto wanted = [&](int c) { return (solid.at(x, y)[c] + 255) / 2.0; };
      const auto wrong = [&](int c) { return std::abs(half.at(x, y)[c] - wanted(c)) > 3.0; };
      off += wrong(0) || wrong(1) || wrong(2) ? 1 : 0;
      inside += solid.at(x, y)[0] < 200 ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 1000);
  // The soft edges along which limbs meet let some of the ground through: lines a pixel wide.
  EXPECT_LT(off, 0.05 * inside);
}

TEST(Shot, SolidFiguresHideWhatIsBehindAndNotWhatIsInFront) {
  Clip behind = tinyClip(1);
  for (Vec3& p : behind.positions) p.z() -= 1.0F;
  Shot shot = levelShot(motionOf(tinyClip(1), naturalColour(), 1.0, ""));
  const Image alone = drawEnd(shot, 200, 200);
  shot.motions.push_back(motionOf(behind, colourOf(1), 0.5, ""));
  const Image hidden = drawEnd(shot, 200, 200);
  // Without perspective and seen along z, the one behind is hidden but for its softened rim.
  const Extent a = inkOf(alone), b = inkOf(hidden);
  EXPECT_NEAR(a.pixels, b.pixels, 0.03 * a.pixels);
  Clip inFront = tinyClip(1);
  for (Vec3& p : inFront.positions) p.z() += 1.0F;
  shot.motions.back() = motionOf(inFront, colourOf(1), 0.5, "");
  const Image tinted = drawEnd(shot, 200, 200);
  double redder = 0.0;
  for (size_t i = 0; i < alone.pixels.size(); i += 4) redder += tinted.pixels[i] - alone.pixels[i];
  EXPECT_GT(redder, 5.0 * a.pixels);
}

TEST(Shot, WhatIsSeenThroughIsThinnerOverSolidFigures) {
  Clip inFront = tinyClip(1);
  for (Vec3& p : inFront.positions) p.z() += 1.0F;
  Shot shot = levelShot(motionOf(tinyClip(1), naturalColour(), 1.0, ""));
  const Image solid = drawEnd(shot, 200, 200);
  shot.motions = {motionOf(inFront, colourOf(1), 1.0, "")};
  const Image full = drawEnd(shot, 200, 200);
  shot.motions = {motionOf(tinyClip(1), naturalColour(), 1.0, ""),
                  motionOf(inFront, colourOf(1), 0.8, "")};
  // The same outline twice: 0.45 of an opacity of 0.8 is left before the solid one.
  const auto farthest = [&](double share) {
    const Image drawn = drawEnd(shot, 200, 200);
    int inside = 0, off = 0;
    for (int y = 1; y < 199; ++y)
      for (int x = 1; x < 199; ++x) {
        const auto ink = [&](int dx, int dy) { return solid.at(x + dx, y + dy)[0] < 128; };
        if (!ink(0, 0) || !ink(-1, 0) || !ink(1, 0) || !ink(0, -1) || !ink(0, 1)) continue;
        ++inside;
        const double wanted = (1 - share) * solid.at(x, y)[0] + share * full.at(x, y)[0];
        off += std::abs(drawn.at(x, y)[0] - wanted) > 4.0 ? 1 : 0;
      }
    EXPECT_GT(inside, 500);
    return off / static_cast<double>(inside);
  };
  EXPECT_LT(farthest(0.45 * 0.8), 0.02);
  shot.options.solidFirst = false;
  EXPECT_LT(farthest(0.8), 0.02);
}

TEST(Shot, WhatCannotBeDrawnIsRefused) {
  EXPECT_THROW(drawEnd({}, 100, 100), InputError);
  EXPECT_THROW(drawEnd(fullShot(), 10, 10), InputError);
  for (const double never : {0.0, -1.0, std::nan("")}) {
    EXPECT_THROW(strobed(fullShot(), never), InputError);
    EXPECT_THROW(withTrail(fullShot(), never), InputError);
  }
  Clip broken = tinyClip(3);
  broken.positions[4].x() = NAN;
  EXPECT_THROW(drawEnd(bareShot(motionOf(broken, naturalColour(), 1.0, "")), 100, 100), InputError);
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
