#include "render/film/film.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include "base/error.h"
#include "render/scene/scene_picture.h"
#include "render/scene_motion.h"
#include "render/tiny_clip.h"

namespace marey::render {
namespace {

namespace fs = std::filesystem;
constexpr int width = 96, height = 64;

Shot tinyShot() {
  Shot shot;
  shot.motions = {motionOf(tinyClip(12), red)};
  return shot;
}

class Film : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "marey-film-XXXXXX").string();
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    m_folder = pattern;
  }
  void TearDown() override { fs::remove_all(m_folder); }
  fs::path m_folder;
};

TEST_F(Film, ShowsWhatTheSceneShowsFromWhereItIsSeen) {
  Shot shot = tinyShot();
  shot.options.strobe.everyS = 0.3;
  Scene scene;
  scene.setMotions(shot.motions);
  scene.setOptions(shot.options);
  scene.setView(View::Front, width, height);
  scene.orbit(0.7, 0.2);
  scene.zoom(1.3);
  scene.setTime(0.5);
  shot.viewpoint = scene.viewpoint();
  const Image shown = ScenePicture().take(scene, width, height);
  EXPECT_EQ(drawShot(shot, 0.5, width, height).pixels, shown.pixels);
  scene.setTime(0.9);
  EXPECT_EQ(drawShot(shot, 0.9, width, height).pixels,
            ScenePicture().take(scene, width, height).pixels);
}

TEST_F(Film, LaysALegendOverEveryPicture) {
  Shot shot = tinyShot();
  const Image bare = drawShot(shot, 0.5, width, height);
  shot.over = Image(width, height, {0, 0, 0, 0});
  std::fill_n(shot.over.at(3, 2), 4, uint8_t{255});     // white, opaque
  std::fill_n(shot.over.at(4, 2) + 3, 1, uint8_t{51});  // black, a fifth
  const Image drawn = drawShot(shot, 0.5, width, height);
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(drawn.at(3, 2)[c], 255);
    EXPECT_NEAR(drawn.at(4, 2)[c], 0.8 * bare.at(4, 2)[c], 1.0);
    EXPECT_EQ(drawn.at(5, 2)[c], bare.at(5, 2)[c]);
  }
  shot.over = Image(width, height + 1);
  EXPECT_THROW(drawShot(shot, 0.5, width, height), NumericError);
}

TEST_F(Film, AFollowingCameraStandsWhereItStoodInTheScene) {
  Shot shot = tinyShot();
  shot.follow = true;
  Scene scene;
  scene.setMotions(shot.motions);
  scene.setOptions(shot.options);
  scene.setTime(0.2);
  scene.setFollow(true);
  scene.setView(View::Side, width, height);
  scene.setTime(0.8);
  shot.viewpoint = scene.viewpoint();
  scene.setTime(0.1);
  const Image shown = ScenePicture().take(scene, width, height);
  const Image drawn = drawShot(shot, 0.1, width, height);
  int differing = 0;  // the camera's way there and back rounds
  for (size_t i = 0; i < shown.pixels.size(); ++i)
    differing += std::abs(int(shown.pixels[i]) - int(drawn.pixels[i])) > 8 ? 1 : 0;
  EXPECT_LT(differing, 40);
}

TEST_F(Film, FramesAreThoseOfTheRange) {
  Shot shot = tinyShot();  // 12 frames at 10 fps
  EXPECT_EQ(frameCountOf(shot, 20.0), 24);
  shot.beginS = 0.3;
  EXPECT_EQ(frameCountOf(shot, 20.0), 18);
  shot.endS = 0.5;
  EXPECT_EQ(frameCountOf(shot, 20.0), 5) << "0.3, 0.35, 0.4, 0.45 and 0.5 s";
  shot.view = View::Side;
  Progress progress;
  const fs::path name = m_folder / "f{frame}.png";
  EXPECT_EQ(writeFilm(name, shot, {.width = width, .height = height, .fps = 20.0}, {}, progress),
            5);
  EXPECT_EQ(framesThere(name).size(), 5U);
  EXPECT_EQ(readPng(m_folder / "f4.png").pixels, drawShot(shot, 0.5, width, height).pixels);
}

TEST_F(Film, TheRecipeTellsTheSettings) {
  Shot shot = tinyShot();
  shot.options.placement = Placement::SideBySide;
  shot.view = View::Top;
  shot.orthographic = true;
  const Json told = toJson(shot);
  EXPECT_EQ(told["placement"], "side by side");
  EXPECT_EQ(told["camera"]["view"], "top");
  EXPECT_EQ(told["camera"]["orthographic"], true);
  EXPECT_FALSE(told.contains("end_s"));
}

}  // namespace
}  // namespace marey::render
