// A motion that has ended fades while longer ones go on: the same in window, films and pictures.
#include "render/scene/endings.h"

#include <gtest/gtest.h>

#include "render/film/film.h"
#include "render/scene/scene_picture.h"
#include "render/scene_motion.h"
#include "render/tiny_clip.h"

namespace marey::render {
namespace {

/// The reddest pixel there is: 0 to 255.
int reddest(const Image& image) {
  int most = 0;
  for (size_t i = 0; i < image.pixels.size(); i += 4)
    most = std::max(most, image.pixels[i] - std::max(image.pixels[i + 1], image.pixels[i + 2]));
  return most;
}

Clip longClip() {
  Clip clip = tinyClip(31);
  for (Vec3& p : clip.positions) p += Vec3(0, 0, 1.2F);
  return clip;
}

/// A red motion of a second beside a blue one of three.
std::vector<SceneMotion> shortAndLong() {
  return {motionOf(tinyClip(11), red), motionOf(longClip(), blue)};
}

TEST(Endings, AMotionIsWholeUntilItsLastFrameAndAPaleTraceSoonAfter) {
  EXPECT_EQ(presenceAt(0.0, 1.0), 1.0);
  EXPECT_EQ(presenceAt(1.0, 1.0), 1.0);
  EXPECT_NEAR(presenceAt(1.0 + endingS / 2, 1.0), (1.0 + endedOpacity) / 2, 0.1);
  for (const double later : {1.0 + endingS, 5.0, 100.0})
    EXPECT_NEAR(presenceAt(later, 1.0), endedOpacity, 1e-9);
}

TEST(Endings, FadeInTheWindow) {
  Scene scene;
  scene.setMotions(shortAndLong());
  scene.setView(View::Side, 320, 240);
  ScenePicture picture;
  scene.setTime(1.0);
  const int whole = reddest(picture.take(scene, 320, 240));
  scene.setTime(2.0);
  const int ended = reddest(picture.take(scene, 320, 240));
  EXPECT_GT(whole, 100);
  EXPECT_GT(ended, 0) << "where it ended is not seen any more";
  EXPECT_LT(ended, 0.5 * whole) << "it stands there in full colour";
}

TEST(Endings, FadeInFilmsOfTheView) {
  const Shot shot{.motions = shortAndLong(), .options = {}, .view = View::Side};
  EXPECT_LT(reddest(drawShot(shot, 2.0, 320, 240)), 0.5 * reddest(drawShot(shot, 1.0, 320, 240)));
}

TEST(Endings, FadeInPrintedFilms) {
  Shot shot = printed(shortAndLong());
  shot.options.contactMarks = false;
  ShotPicture picture(shot, 320, 240);
  EXPECT_LT(reddest(picture.at(2.0)), 0.5 * reddest(picture.at(1.0)));
}

}  // namespace
}  // namespace marey::render
