#include "render/scene/scene.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "motion/path.h"
#include "motion/roles.h"
#include "motion/walker.h"
#include "render/scene_motion.h"
#include "render/tiny_clip.h"

namespace marey::render {
namespace {

std::shared_ptr<const Clip> walker(const std::string& preset, double fps = 30.0) {
  WalkerOptions options;
  options.fps = fps;
  return std::make_shared<const Clip>(walk(presetPath(preset, 3.0, fps), options).clip);
}

/// tinyClip's motion at twice the rate.
Clip tinyClipFast(int frames) {
  Clip clip = tinyClip(2 * frames - 1);
  clip.fps = 20.0;
  for (int t = 0; t < clip.frameCount(); ++t)
    for (Vec3& p : clip.frame(t)) p.x() -= 0.05F * static_cast<float>(t);
  return clip;
}

TEST(Scene, TimeBetweenFramesIsInterpolated) {
  Scene scene;
  scene.setMotions({motionOf(tinyClip(11), red)});
  scene.setTime(0.37);  // 1 m/s along x
  EXPECT_NEAR(scene.pose(0)[0].x(), 0.37F, 1e-5F);
  scene.setTime(5.0);
  EXPECT_NEAR(scene.pose(0)[0].x(), 1.0F, 1e-5F) << "the last frame is held";
  EXPECT_NEAR(scene.seconds(), 1.0, 1e-9);
}

TEST(Scene, MotionsOfDifferentRatesShareOneClock) {
  Scene scene;
  scene.setMotions({motionOf(tinyClip(11), red), motionOf(tinyClipFast(11), blue)});
  for (const double time : {0.0, 0.13, 0.5, 0.98}) {
    scene.setTime(time);
    const auto slow = scene.pose(0), fast = scene.pose(1);
    for (size_t j = 0; j < slow.size(); ++j) EXPECT_LT((slow[j] - fast[j]).norm(), 1e-5F) << time;
  }
}

TEST(Scene, AlignedRootsStandAtTheOriginAndFaceAlongZ) {
  const auto circle = walker("circle"), straight = walker("sideways");
  Scene scene;
  scene.setMotions({SceneMotion{.clip = circle}, SceneMotion{.clip = straight}});
  scene.setOptions({.placement = Placement::RootAligned});
  const SkeletonRoles roles = rolesOf(*circle->skeleton);
  for (const double time : {0.0, 0.7, 1.4, 2.9}) {
    scene.setTime(time);
    for (const size_t motion : {0U, 1U}) {
      const auto pose = scene.pose(motion);
      // The root frame is filtered in time: the hips sway about it.
      EXPECT_LT(std::hypot(pose[0].x(), pose[0].z()), 0.12F) << motion << " at " << time;
      const Vec3 left =
          pose[static_cast<size_t>(roles.leftHip)] - pose[static_cast<size_t>(roles.rightHip)];
      EXPECT_GT(left.normalized().x(), 0.85F) << motion << " at " << time;
    }
  }
  scene.setOptions({});
  scene.setTime(2.9);
  EXPECT_GT(scene.pose(0)[0].norm(), 1.5F) << "in the world it has walked away";
}

TEST(Scene, SideBySideNoTwoMotionsEverOverlap) {
  Scene scene;
  scene.setMotions({SceneMotion{.clip = walker("turn-left")}, SceneMotion{.clip = walker("fast")},
                    SceneMotion{.clip = walker("turn-right")}});
  const auto spans = [&] {
    std::vector<std::pair<float, float>> result(3, {1e9F, -1e9F});
    for (double time = 0.0; time <= scene.seconds(); time += 0.05) {
      scene.setTime(time);
      for (size_t m = 0; m < 3; ++m) {
        for (const Vec3& p : scene.pose(m)) {
          result[m].first = std::min(result[m].first, p.x());
          result[m].second = std::max(result[m].second, p.x());
        }
      }
    }
    return result;
  };
  const auto together = spans();
  EXPECT_LT(together[1].first, together[0].second);
  scene.setOptions({.placement = Placement::SideBySide});
  // They walk along z, so that the left is at larger x.
  const auto apart = spans();
  EXPECT_GT(apart[0].first, apart[1].second + 0.2F);
  EXPECT_GT(apart[1].first, apart[2].second + 0.2F);
  const float width = apart[0].second - apart[0].first;
  EXPECT_NEAR(width, together[0].second - together[0].first, 1e-4F);
}

TEST(Scene, WhatIsOnScreenIsPicked) {
  Scene scene;
  Clip aside = tinyClip(3);
  for (Vec3& p : aside.positions) p += Vec3(0.5F, 0.0F, -0.8F);
  scene.setMotions({motionOf(tinyClip(3), red), motionOf(std::move(aside), blue)});
  scene.setTime(0.1);
  for (const View view : {View::ThreeQuarter, View::Side, View::Front, View::Back, View::Top}) {
    for (const bool orthographic : {false, true}) {
      scene.setOrthographic(orthographic);
      scene.setView(view, 900, 700);
      for (const size_t motion : {0U, 1U}) {
        const auto pose = scene.pose(motion);
        for (size_t j = 0; j < pose.size(); ++j) {
          const ScreenPoint at = scene.screenPoint(pose[j], 900, 700);
          const auto hit = scene.pick(at.x, at.y, 900, 700);
          ASSERT_TRUE(hit.has_value());
          EXPECT_LT(hit->pixels, 3.1);
          // Joints that cover each other: the one in front is as good an answer.
          if (hit->motion == motion && hit->joint == static_cast<int>(j)) continue;
          const Vec3 forward = scene.camera().forward();
          EXPECT_LE(forward.dot(hit->place), forward.dot(pose[j]));
        }
      }
    }
  }
  EXPECT_FALSE(scene.pick(5, 5, 900, 700).has_value());
}

TEST(Scene, OfJointsOverEachOtherTheFrontOneIsPicked) {
  Clip behind = tinyClip(2);
  for (Vec3& p : behind.positions) p.z() -= 2.0F;
  Scene scene;
  scene.setMotions({motionOf(std::move(behind), red), motionOf(tinyClip(2), blue)});
  scene.setOrthographic(true);
  scene.setView(View::Side, 600, 600);
  const auto front = scene.pose(1);
  const ScreenPoint at = scene.screenPoint(front[7], 600, 600);
  const auto hit = scene.pick(at.x, at.y, 600, 600);
  ASSERT_TRUE(hit.has_value());
  const Vec3 forward = scene.camera().forward();
  const size_t nearer = forward.dot(front[7]) < forward.dot(scene.pose(0)[7]) ? 1 : 0;
  EXPECT_EQ(hit->motion, nearer);
  EXPECT_EQ(hit->joint, 7);
}

TEST(Scene, FloorPointsAreWhereTheyAreSeen) {
  Scene scene;
  scene.setMotions({motionOf(tinyClip(20), red)});
  for (const bool orthographic : {false, true}) {
    scene.setOrthographic(orthographic);
    scene.setView(View::ThreeQuarter, 640, 480);
    for (const Vec3& place : {Vec3(0, 0, 0), Vec3(1.2F, 0, -0.7F), Vec3(-0.4F, 0, 0.9F)}) {
      const ScreenPoint at = scene.screenPoint(place, 640, 480);
      const auto found = scene.floorPoint(at.x, at.y, 640, 480);
      ASSERT_TRUE(found.has_value());
      EXPECT_LT((*found - place).norm(), 2e-3F);
      EXPECT_EQ(found->y(), 0.0F);
    }
  }
  scene.setOrthographic(false);
  scene.setView(View::Side, 640, 480);
  EXPECT_FALSE(scene.floorPoint(320, 2, 640, 480).has_value()) << "above the horizon";
}

TEST(Scene, EveryViewSeesTheWholeMotion) {
  Scene scene;
  scene.setMotions({SceneMotion{.clip = walker("figure-eight")}});
  for (const View view : {View::ThreeQuarter, View::Side, View::Front, View::Back, View::Top}) {
    scene.setView(view, 640, 360);
    double widest = 0.0;
    for (double time = 0.0; time <= scene.seconds(); time += 0.1) {
      scene.setTime(time);
      for (const Vec3& p : scene.pose(0)) {
        const ScreenPoint at = scene.screenPoint(p, 640, 360);
        widest = std::max({widest, std::abs(at.x - 320) / 320, std::abs(at.y - 180) / 180});
      }
    }
    EXPECT_LT(widest, 1.0);
    EXPECT_GT(widest, 0.7);
  }
}

TEST(Scene, FrontAndBackSeeTheWalkFromItsTwoEnds) {
  Scene scene;
  scene.setMotions({motionOf(tinyClip(31), red)});  // along +x
  scene.setView(View::Front, 300, 300);
  EXPECT_LT(scene.camera().forward().x(), -0.9F);
  scene.setView(View::Back, 300, 300);
  EXPECT_GT(scene.camera().forward().x(), 0.9F);
  scene.setView(View::Top, 300, 300);
  EXPECT_LT(scene.camera().forward().y(), -0.999F);
  EXPECT_GT(scene.camera().right().x(), 0.999F);
}

TEST(Scene, AFollowingCameraKeepsTheWalkerInPlace) {
  Scene scene;
  scene.setMotions({motionOf(tinyClip(101), red)});
  scene.setFollow(true);
  scene.setView(View::Side, 400, 300);
  scene.setTime(3.0);
  const ScreenPoint before = scene.screenPoint(scene.pose(0)[0], 400, 300);
  scene.setTime(7.0);
  const ScreenPoint after = scene.screenPoint(scene.pose(0)[0], 400, 300);
  EXPECT_NEAR(before.x, after.x, 0.5);
  scene.setFollow(false);
  scene.setTime(3.0);
  EXPECT_GT(std::abs(scene.screenPoint(scene.pose(0)[0], 400, 300).x - after.x), 50.0);
}

TEST(Scene, WithoutPerspectiveTheMiddleKeepsItsSize) {
  Scene scene;
  scene.setMotions({motionOf(tinyClip(2), red)});
  scene.setView(View::Side, 400, 300);
  const Vec3 middle = scene.camera().target, up = middle + Vec3(0, 0.3F, 0);
  const auto height = [&] {
    return scene.screenPoint(middle, 400, 300).y - scene.screenPoint(up, 400, 300).y;
  };
  const double before = height();
  scene.setOrthographic(true);
  EXPECT_NEAR(height(), before, 0.02 * before);
  scene.setOrthographic(false);
  EXPECT_NEAR(height(), before, 0.02 * before);
}

TEST(Scene, TheMouseTurnsShiftsAndZooms) {
  Scene scene;
  scene.setMotions({motionOf(tinyClip(2), red)});
  scene.setView(View::ThreeQuarter, 400, 300);
  const Camera start = scene.camera();
  scene.orbit(0.5, 0.2);
  EXPECT_LT((scene.camera().target - start.target).norm(), 1e-4F);
  EXPECT_NEAR((scene.camera().eye - start.target).norm(), (start.eye - start.target).norm(), 1e-3);
  EXPECT_GT(scene.camera().eye.y(), start.eye.y());
  scene.orbit(0.0, -9.0);
  EXPECT_GT(scene.camera().eye.y(), 0.0F) << "never from below the floor";
  scene.orbit(0.0, 9.0);
  EXPECT_LT(scene.camera().forward().y(), -0.999F);
  scene.orbit(0.7, 0.0);  // straight down it still turns
  EXPECT_LT(scene.camera().forward().y(), -0.999F);

  scene.setView(View::ThreeQuarter, 400, 300);
  const Vec3 looked = scene.camera().target;
  scene.pan(40, -25, 300);
  EXPECT_NEAR(scene.screenPoint(looked, 400, 300).x, 240.0, 0.5);
  EXPECT_NEAR(scene.screenPoint(looked, 400, 300).y, 125.0, 0.5);
  const float away = (scene.camera().eye - scene.camera().target).norm();
  scene.zoom(2.0);
  EXPECT_NEAR((scene.camera().eye - scene.camera().target).norm(), away / 2, 1e-3);
}

TEST(Scene, WhatCannotBeShownIsRefusedAndChangesNothing) {
  Scene scene;
  scene.setMotions({motionOf(tinyClip(4), red)});
  EXPECT_THROW(scene.setMotions({SceneMotion{}}), InputError);
  SceneMotion coloured = motionOf(tinyClip(4), red);
  coloured.frameColours = {red, blue};
  EXPECT_THROW(scene.setMotions({coloured}), InputError);
  Clip broken = tinyClip(3);
  broken.positions[4].x() = NAN;
  EXPECT_THROW(scene.setMotions({motionOf(broken, red)}), InputError);
  EXPECT_EQ(scene.motions().size(), 1U);
  EXPECT_EQ(scene.motions()[0].clip->frameCount(), 4);
  Skeleton plain;
  plain.names = {"a", "b"};
  plain.parents = {-1, 0};
  plain.offsets = {Vec3(0, 1, 0), Vec3(0, 0.3F, 0)};
  Clip stick;
  stick.skeleton = std::make_shared<const Skeleton>(plain);
  stick.fps = 10.0;
  stick.positions = {Vec3(0, 1, 0), Vec3(0, 1.3F, 0)};
  scene.setMotions({motionOf(stick, red)});
  EXPECT_THROW(scene.setOptions({.placement = Placement::RootAligned}), InputError);
  EXPECT_EQ(scene.options().placement, Placement::World);
}

}  // namespace
}  // namespace marey::render
