#include "motion/skeleton_fit.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "motion/kinematics.h"
#include "motion/pose_solver.h"
#include "motion/rotation.h"
#include "motion/walker.h"

namespace marey {
namespace {

Clip walker(double seconds, double fps = 20.0) {
  return walkerDataSet(1, seconds, 3, fps).front().clip;
}

Clip positionsOnly(Clip clip) {
  clip.transforms.reset();
  return clip;
}

double largestDistance(const Clip& a, const Clip& b) {
  double out = 0.0;
  for (size_t i = 0; i < a.positions.size(); ++i)
    out = std::max<double>(out, (a.positions[i] - b.positions[i]).norm());
  return out;
}

/// Repeatable noise in [-size, size].
float noise(size_t i, float size) {
  return size *
         static_cast<float>(
             2.0 * std::remainder(43758.5453 * std::sin(12.9898 * static_cast<double>(i)), 1.0));
}

/// A chain of one joint per offset.
Clip chain(const std::vector<Vec3>& offsets, const std::vector<std::vector<Vec3>>& frames) {
  Skeleton s;
  for (size_t j = 0; j < offsets.size(); ++j) {
    s.names.push_back("joint" + std::to_string(j));
    s.parents.push_back(static_cast<int>(j) - 1);
  }
  s.offsets = offsets;
  Clip clip;
  clip.name = "chain";
  clip.fps = 20.0;
  clip.skeleton = std::make_shared<const Skeleton>(std::move(s));
  for (const auto& frame : frames)
    clip.positions.insert(clip.positions.end(), frame.begin(), frame.end());
  return clip;
}

double cost(const SkeletonFit& fit) {
  double out = 0.0;
  for (const double rms : fit.residual.rmsM) out += rms * rms;
  return out;
}

TEST(SkeletonFit, PositionsThatASkeletonReachesAreReached) {
  const Clip clip = walker(6.0);
  const SkeletonFit fit = fitSkeleton(positionsOnly(clip));
  EXPECT_EQ(*fit.skeleton, *clip.skeleton);
  EXPECT_LT(fit.residual.largestM(), 2e-6);
  const Clip fitted = withFit(positionsOnly(clip), fit);
  EXPECT_LT(largestDistance(clip, fitted), 2e-6);
  for (size_t i = 0; i < fit.transforms.translations.size(); ++i) {
    const size_t joint = i % fit.skeleton->names.size();
    if (joint != 0) {
      ASSERT_EQ(fit.transforms.translations[i], fit.skeleton->offsets[joint]);
    }
  }
}

TEST(SkeletonFit, RotationsThatPositionsShowAreFound) {
  const Clip clip = walker(6.0);
  const SkeletonFit fit = fitSkeleton(positionsOnly(clip));
  const std::vector<Quat> truth = globalRotations(*clip.skeleton, *clip.transforms);
  const std::vector<Quat> found = globalRotations(*fit.skeleton, fit.transforms);
  const PoseSolver solver(*clip.skeleton);
  int observed = 0;
  for (size_t i = 0; i < truth.size(); ++i) {
    if (solver.observed(static_cast<int>(i % clip.skeleton->names.size())) != Observed::Rotation)
      continue;
    ++observed;
    ASSERT_LT(truth[i].angularDistance(found[i]), 1e-3f) << i;
  }
  EXPECT_GE(observed, 2 * clip.frameCount()) << "hips and chest have three children each";
}

/// Two joints whose bone is 1 m while the positions are 1.3 m apart: the error is shared, 0.15 m
/// each.
TEST(SkeletonFit, TheResidualOfABoneThatIsTooLongIsSharedByItsEnds) {
  const Clip clip = chain({Vec3(0, 0, 0), Vec3(0, 1, 0)},
                          {{Vec3(0, 0, 0), Vec3(1.3f, 0, 0)}, {Vec3(2, 0, 0), Vec3(2, 0, 1.3f)}});
  const SkeletonFit fit = fitSkeleton(clip);
  EXPECT_EQ(fit.residual.joints, clip.skeleton->names);
  EXPECT_EQ(fit.residual.frames, (std::vector<int>{2, 2}));
  for (int j = 0; j < 2; ++j) {
    EXPECT_NEAR(fit.residual.rmsM[static_cast<size_t>(j)], 0.15, 1e-6);
    EXPECT_NEAR(fit.residual.maxM[static_cast<size_t>(j)], 0.15, 1e-6);
  }
  const Clip fitted = withFit(clip, fit);
  EXPECT_LT((fitted.at(0, 0) - Vec3(0.15f, 0, 0)).norm(), 1e-6f);
  EXPECT_LT((fitted.at(0, 1) - Vec3(1.15f, 0, 0)).norm(), 1e-6f);
  EXPECT_LT((fitted.at(1, 1) - Vec3(2, 0, 1.15f)).norm(), 1e-6f);
}

TEST(SkeletonFit, RmsAndMaximumAreOverFrames) {
  // The second frame fits exactly: RMS = 0.15 / sqrt 2, maximum 0.15.
  const Clip clip = chain({Vec3(0, 0, 0), Vec3(0, 1, 0)},
                          {{Vec3(0, 0, 0), Vec3(1.3f, 0, 0)}, {Vec3(2, 0, 0), Vec3(2, 0, 1)}});
  const SkeletonFit fit = fitSkeleton(clip);
  EXPECT_NEAR(fit.residual.rmsM[1], 0.15 / std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(fit.residual.maxM[1], 0.15, 1e-6);
  EXPECT_NEAR(fit.residual.largestM(), 0.15, 1e-6);
}

/// No small turn of any joint and no small shift of the root brings noisy positions nearer.
TEST(SkeletonFit, NoNeighbouringPoseIsNearer) {
  Clip clip = positionsOnly(walker(1.0));
  for (size_t i = 0; i < clip.positions.size(); ++i)
    clip.positions[i] +=
        Vec3(noise(3 * i, 0.03f), noise(3 * i + 1, 0.03f), noise(3 * i + 2, 0.03f));
  const SkeletonFit fit = fitSkeleton(clip);
  EXPECT_GT(fit.residual.largestM(), 0.01);
  EXPECT_LT(fit.residual.largestM(), 0.06);
  const auto costAt = [&](const JointTransforms& transforms) {
    const std::vector<Vec3> at = forwardKinematics(*fit.skeleton, transforms);
    double out = 0.0;
    for (size_t i = 0; i < at.size(); ++i)
      out += (at[i] - clip.positions[i]).cast<double>().squaredNorm();
    return out;
  };
  const double least = costAt(fit.transforms);
  EXPECT_NEAR(least, cost(fit) * clip.frameCount(), 1e-6);
  // The first frame: later ones are held near those before.
  const size_t frame = 0;
  for (size_t j = 0; j < fit.skeleton->names.size(); ++j)
    for (int axis = 0; axis < 3; ++axis)
      for (const float step : {-0.01f, 0.01f}) {
        JointTransforms turned = fit.transforms;
        turned.rotations[frame + j] =
            turned.rotations[frame + j] * Quat(Eigen::AngleAxisf(step, Vec3::Unit(axis)));
        EXPECT_GT(costAt(turned), least - 1e-7) << j << " axis " << axis;
      }
  for (int axis = 0; axis < 3; ++axis)
    for (const float step : {-0.001f, 0.001f}) {
      JointTransforms moved = fit.transforms;
      moved.translations[frame][axis] += step;
      EXPECT_GT(costAt(moved), least) << axis;
    }
}

/// A trunk whose shoulders, 3 cm beside its long axis, err by up to 2 cm along each axis: the twist
/// that follows from them alone jumps by tens of degrees.
TEST(SkeletonFit, RotationsThatPositionsShowBadlyDoNotJump) {
  Skeleton s;
  s.names = {"hips", "left", "right", "chest", "head", "leftArm", "rightArm"};
  s.parents = {-1, 0, 0, 0, 3, 3, 3};
  s.offsets = {Vec3::Zero(),     Vec3(0.1f, 0, 0),      Vec3(-0.1f, 0, 0),     Vec3(0, 0.2f, 0),
               Vec3(0, 0.2f, 0), Vec3(0.03f, 0.15f, 0), Vec3(-0.03f, 0.15f, 0)};
  Clip clip;
  clip.name = "trunk";
  clip.fps = 20.0;
  clip.skeleton = std::make_shared<const Skeleton>(s);
  const std::vector<Vec3> rest = restPositions(s);
  for (int t = 0; t < 60; ++t)
    for (size_t j = 0; j < rest.size(); ++j) {
      const size_t i = 3 * clip.positions.size();
      const float size = j >= 5 ? 0.02f : 0.0f;
      const Eigen::AngleAxisf turn(0.05f * static_cast<float>(t), Vec3::UnitY());
      clip.positions.push_back(
          turn * (rest[j] + Vec3(noise(i, size), noise(i + 1, size), noise(i + 2, size))));
    }
  const SkeletonFit fit = fitSkeleton(clip);
  EXPECT_LT(fit.residual.largestM(), 0.035);
  double largest = 0.0, alone = 0.0;
  const std::vector<Quat> world = globalRotations(s, fit.transforms);
  for (int t = 1; t < 60; ++t) {
    const auto chest = static_cast<size_t>(t) * rest.size() + 3;
    largest = std::max<double>(largest, world[chest].angularDistance(world[chest - rest.size()]));
    const auto twist = [&clip](int frame) {
      const Vec3 across = clip.at(frame, 5) - clip.at(frame, 6);
      return std::atan2(-across.z(), across.x());
    };
    alone = std::max<double>(alone, std::abs(std::remainder(twist(t) - twist(t - 1), 2 * M_PI)));
  }
  EXPECT_GT(alone, 0.5) << "the shoulders alone jump";
  EXPECT_LT(largest, 0.4 * alone) << alone;
  // And the chest stays behind the turning hips by little.
  const size_t last = 59 * rest.size();
  EXPECT_LT(world[last].angularDistance(world[last + 3]), 0.15f);
}

/// An arm that circles through the place opposite to its rest: world directions change by 3
/// degrees a frame, and so may the rotation.
TEST(SkeletonFit, AnArmThroughTheOppositeOfItsRestDoesNotFlip) {
  std::vector<std::vector<Vec3>> frames;
  for (int t = 0; t <= 240; ++t) {
    const double angle = t * M_PI / 60.0;
    const Vec3 hand(static_cast<float>(std::sin(angle)), static_cast<float>(std::cos(angle)),
                    0.02f * static_cast<float>(std::sin(0.37 * t)));
    frames.push_back({Vec3::Zero(), hand.normalized(), 2.0f * hand.normalized()});
  }
  const Clip clip = chain({Vec3::Zero(), Vec3(0, 1, 0), Vec3(0, 1, 0)}, frames);
  const SkeletonFit fit = fitSkeleton(clip);
  EXPECT_LT(fit.residual.largestM(), 1e-6);
  for (size_t i = 3; i < fit.transforms.rotations.size(); ++i) {
    const Quat &before = fit.transforms.rotations[i - 3], &now = fit.transforms.rotations[i];
    ASSERT_GT(now.dot(before), 0.0f) << i;
    ASSERT_LT(now.angularDistance(before), 0.2f) << "joint " << i % 3 << " frame " << i / 3;
  }
}

/// Twist that a loop of the arm leaves behind fades while the arm rests.
TEST(SkeletonFit, TwistFadesAtRest) {
  std::vector<std::vector<Vec3>> frames;
  const auto add = [&frames](double azimuth, double height) {
    const Vec3 hand(static_cast<float>(std::cos(height) * std::cos(azimuth)),
                    static_cast<float>(std::sin(height)),
                    static_cast<float>(std::cos(height) * std::sin(azimuth)));
    frames.push_back({Vec3::Zero(), hand});
  };
  for (int t = 0; t <= 40; ++t) add(t * M_PI / 20.0, M_PI / 4.0);
  for (int t = 0; t < 60; ++t) add(0.0, M_PI / 4.0);
  const Clip clip = chain({Vec3::Zero(), Vec3(1, 0, 0)}, frames);
  const SkeletonFit fit = fitSkeleton(clip);
  const Quat last = fit.transforms.rotations[fit.transforms.rotations.size() - 2];
  const Quatd plain = shortestArc(Vec3d(1, 0, 0), clip.at(clip.frameCount() - 1, 1).cast<double>());
  EXPECT_LT(last.cast<double>().angularDistance(plain), 0.02);
}

TEST(SkeletonFit, LimbsTurnWithTheBodyTheyHangOn) {
  // A person who turns about the vertical: no joint turns against its parent.
  Clip clip = positionsOnly(walker(1.0));
  const std::vector<Vec3> first(clip.frame(0).begin(), clip.frame(0).end());
  for (int t = 0; t < clip.frameCount(); ++t)
    for (int j = 0; j < clip.jointCount(); ++j)
      clip.frame(t)[static_cast<size_t>(j)] =
          Eigen::AngleAxisf(0.3f * static_cast<float>(t), Vec3::UnitY()) *
          first[static_cast<size_t>(j)];
  const SkeletonFit fit = fitSkeleton(clip);
  const auto width = static_cast<size_t>(clip.jointCount());
  for (size_t i = width; i < fit.transforms.rotations.size(); ++i) {
    if (i % width != 0) {
      ASSERT_LT(fit.transforms.rotations[i].angularDistance(fit.transforms.rotations[i - width]),
                2e-3f)
          << fit.residual.joints[i % width];
    }
  }
}

TEST(SkeletonFit, ASkeletonWithoutOffsetsIsMeasured) {
  Clip clip = positionsOnly(walker(2.0));
  Skeleton bare = *clip.skeleton;
  for (Vec3& offset : bare.offsets) offset.setZero();
  clip.skeleton = std::make_shared<const Skeleton>(bare);
  const SkeletonFit fit = fitSkeleton(clip);
  EXPECT_LT(fit.residual.largestM(), 1e-5);
  EXPECT_EQ(fit.skeleton->offsets, withOffsetsFrom(clip)->offsets);
}

TEST(SkeletonFit, JointsOnOnePlaceAndSingleJointsAreNoTrouble) {
  const Clip alone = chain({Vec3::Zero()}, {{Vec3(1, 2, 3)}, {Vec3(2, 2, 3)}});
  EXPECT_EQ(fitSkeleton(alone).transforms.translations[1], Vec3(2, 2, 3));
  // Bones of one metre, all joints on one place: the ends share the error of the chain.
  const Clip heap = chain({Vec3::Zero(), Vec3(0, 1, 0)}, {{Vec3(1, 0, 0), Vec3(1, 0, 0)}});
  const SkeletonFit fit = fitSkeleton(heap);
  EXPECT_NEAR(fit.residual.largestM(), 0.5, 1e-6);
  // A zero bone in the middle.
  const Clip bent = chain({Vec3::Zero(), Vec3::Zero(), Vec3(0, 1, 0)},
                          {{Vec3::Zero(), Vec3::Zero(), Vec3(1, 0, 0)}});
  EXPECT_LT(fitSkeleton(bent).residual.largestM(), 1e-6);
}

TEST(SkeletonFit, ResidualsOfClipsArePooledOverTheirFrames) {
  const FitResidual a{{"hips", "head"}, {0.1, 0.0}, {0.2, 0.0}, {1, 1}};
  const FitResidual b{{"hips", "tail"}, {0.5, 0.3}, {0.7, 0.4}, {3, 3}};
  const FitResidual both = pooled(a, b);
  EXPECT_EQ(both.joints, (std::vector<std::string>{"hips", "head", "tail"}));
  EXPECT_NEAR(both.rmsM[0], std::sqrt((0.01 + 3 * 0.25) / 4), 1e-12);
  EXPECT_EQ(both.maxM, (std::vector<double>{0.7, 0.0, 0.4}));
  EXPECT_EQ(both.frames, (std::vector<int>{4, 1, 3}));
}

TEST(SkeletonFit, TheSameClipGivesTheSameBits) {
  const Clip clip = positionsOnly(walker(2.0));
  const SkeletonFit a = fitSkeleton(clip), b = fitSkeleton(clip);
  for (size_t i = 0; i < a.transforms.rotations.size(); ++i)
    ASSERT_EQ(a.transforms.rotations[i].coeffs(), b.transforms.rotations[i].coeffs());
}

TEST(SkeletonFit, NanIsRefusedByFrameAndJoint) {
  Clip clip = positionsOnly(walker(1.0));
  clip.frame(3)[2].x() = NAN;
  try {
    fitSkeleton(clip);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("frame 4"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace marey
