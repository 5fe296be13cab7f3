// What is kept from one drawing to the next never shows: after any change the picture is that of a
// scene drawn for the first time.
#include <algorithm>
#include <cstdlib>
#include <functional>

#include <gtest/gtest.h>
#include <sched.h>
#include <vtkRenderer.h>

#include "render/scene/scene_picture.h"
#include "render/scene/shadow_tiles.h"
#include "render/scene_motion.h"
#include "render/tiny_clip.h"

namespace marey::render {
namespace {

constexpr int width = 240, height = 160;

Scene walkingScene() {
  Scene scene;
  scene.setMotions({motionOf(tinyClip(31), red)});
  scene.setView(View::ThreeQuarter, width, height);
  return scene;
}

Scene copyOf(const Scene& scene) {
  Scene copy;
  copy.setMotions(scene.motions());
  copy.setOptions(scene.options());
  copy.setTime(scene.time());
  copy.setViewpoint(scene.viewpoint());
  return copy;
}

/// Pixels that differ by more than rounding.
int differing(const Image& a, const Image& b) {
  int pixels = 0;
  for (size_t i = 0; i < a.pixels.size(); i += 4) {
    int most = 0;
    for (size_t c = 0; c < 3; ++c)
      most = std::max(most, std::abs(a.pixels[i + c] - b.pixels[i + c]));
    pixels += most > 12 ? 1 : 0;
  }
  return pixels;
}

int darkerPixels(const Image& image, const Image& than) {
  int darker = 0;
  for (size_t i = 0; i < image.pixels.size(); i += 4)
    darker += image.pixels[i] + 6 < than.pixels[i] ? 1 : 0;
  return darker;
}

TEST(Redraw, TheFloorIsCopiedFromTheThirdDrawingOnUntilTheCameraMoves) {
  Scene scene = walkingScene();
  ScenePicture picture;
  std::vector<bool> copied;
  const auto draw = [&] {
    picture.draw(scene, width, height);
    copied.push_back(scene.cost().floorCopied);
  };
  for (int frame = 0; frame < 4; ++frame) {
    scene.setTime(0.1 * frame);
    draw();
  }
  scene.orbit(0.1, 0.0);
  draw();
  EXPECT_EQ(copied, (std::vector<bool>{false, false, true, true, false}));
}

TEST(Redraw, APictureAfterAnyChangeIsThatOfTheFirstDrawing) {
  Scene scene = walkingScene();
  ScenePicture used;
  int wide = width;
  const auto option = [&](auto&& change) {
    SceneOptions options = scene.options();
    change(options);
    scene.setOptions(options);
  };
  const std::vector<std::pair<const char*, std::function<void()>>> changes = {
      {"nothing", [] {}},
      {"time", [&] { scene.setTime(1.3); }},
      {"orbit", [&] { scene.orbit(0.4, 0.1); }},
      {"zoom", [&] { scene.zoom(1.5); }},
      {"dark", [&] { option([](SceneOptions& o) { o.tone = Tone::Dark; }); }},
      {"grid", [&] { option([](SceneOptions& o) { o.gridM = 0.8; }); }},
      {"no shadow", [&] { option([](SceneOptions& o) { o.shadow = false; }); }},
      {"no floor", [&] { option([](SceneOptions& o) { o.floor = false; }); }},
      {"floor", [&] { option([](SceneOptions& o) { o.floor = o.shadow = true; }); }},
      {"orthographic", [&] { scene.setOrthographic(true); }},
      {"size", [&] { wide = 300; }},
      {"more motions",
       [&] {
         Clip far = tinyClip(31);
         for (Vec3& p : far.positions) p.z() += 6.0F;
         scene.setMotions({motionOf(tinyClip(31), red), motionOf(std::move(far), blue)});
       }},
  };
  for (const auto& [name, change] : changes) {
    change();
    const Image first = ScenePicture().take(copyOf(scene), wide, height);
    for (int frame = 0; frame < 3; ++frame)
      EXPECT_TRUE(used.take(scene, wide, height).pixels == first.pixels) << name << ' ' << frame;
  }
}

TEST(Redraw, AShadowGoesWithItsBodyOverACopiedFloor) {
  Scene scene = walkingScene();
  ScenePicture picture;
  for (int frame = 0; frame < 3; ++frame) picture.draw(scene, width, height);
  scene.setTime(3.0);  // 3 m on
  const Image there = picture.take(scene, width, height);
  ASSERT_TRUE(scene.cost().floorCopied);
  SceneOptions options = scene.options();
  options.shadow = false;
  scene.setOptions(options);
  const Image without = picture.take(scene, width, height);
  EXPECT_GT(darkerPixels(there, without), 40);
  EXPECT_EQ(darkerPixels(without, there), 0);
}

TEST(Redraw, AViewBesideOthersInAWindowIsDrawnAsAlone) {
  Scene scene = walkingScene();
  SceneOptions options = scene.options();
  options.detail = BodyDetail::Lines;
  scene.setOptions(options);
  const Image alone = ScenePicture().take(scene, width, height);
  scene = copyOf(scene);
  scene.renderer()->SetViewport(0.5, 0.5, 1.0, 1.0);
  ScenePicture picture;
  for (int frame = 0; frame < 3; ++frame) {
    const Image both = picture.take(scene, 2 * width, 2 * height);
    Image corner(width, height);
    for (int y = 0; y < height; ++y)
      std::copy_n(both.at(width, y), 4 * static_cast<size_t>(width), corner.at(0, y));
    EXPECT_EQ(differing(corner, alone), 0) << frame;
  }
}

/// Limbs enough for several threads.
std::vector<ShadowLimb> crowd() {
  std::vector<ShadowLimb> limbs;
  for (int i = 0; i < 400; ++i) {
    const float x = 0.7F * static_cast<float>(i % 20), z = 0.9F * static_cast<float>(i / 20);
    limbs.push_back({{x, 0.0F, z}, {x + 0.3F, 1.1F, z + 0.2F}, 0.05F, 1.0F});
  }
  return limbs;
}

TEST(SoftShadow, TheMapIsTheSameForAnyNumberOfThreads) {
  const std::vector<ShadowLimb> limbs = crowd();
  const Eigen::Vector2f slant(0.34F, 0.2F);
  ShadowMap many, one;
  castSoftShadows(limbs, slant, many);
  cpu_set_t all, single;
  ASSERT_EQ(sched_getaffinity(0, sizeof(all), &all), 0);
  CPU_ZERO(&single);
  for (int cpu = 0; CPU_COUNT(&single) == 0; ++cpu)
    if (CPU_ISSET(cpu, &all)) CPU_SET(cpu, &single);
  ASSERT_EQ(sched_setaffinity(0, sizeof(single), &single), 0);
  castSoftShadows(limbs, slant, one);
  ASSERT_EQ(sched_setaffinity(0, sizeof(all), &all), 0);
  EXPECT_TRUE(many.light == one.light);
}

TEST(ShadowTiles, HoldEveryShadedTexelOnceWithItsRimAndLittleElse) {
  ShadowMap map;
  map.width = 50;
  map.height = 37;
  map.area = {-2.0, 1.0, 3.0, 4.7};  // ten texels a metre
  map.light.assign(static_cast<size_t>(map.width) * map.height, 255);
  const auto shade = [&](int x, int y) { map.light[static_cast<size_t>(y) * map.width + x] = 90; };
  shade(7, 7);  // at the corner of four tiles
  shade(44, 30);
  const std::vector<FloorArea> areas = shadedAreas(map);
  const auto covered = [&](double column, double row) {
    const double x = map.area.x0 + 0.1 * column, z = map.area.z0 + 0.1 * row;
    int times = 0;
    for (const FloorArea& a : areas) times += x > a.x0 && x < a.x1 && z > a.z0 && z < a.z1 ? 1 : 0;
    return times;
  };
  for (const auto& [x, y] : {std::pair{7, 7}, {44, 30}}) {
    for (const double dx : {-0.45, 0.5, 1.45})
      for (const double dy : {-0.45, 0.5, 1.45}) EXPECT_EQ(covered(x + dx, y + dy), 1) << x;
  }
  EXPECT_EQ(covered(25.5, 20.5), 0);
  EXPECT_EQ(covered(44.5, 10.5), 0);
  EXPECT_TRUE(shadedAreas({}).empty());
}

}  // namespace
}  // namespace marey::render
