// What every representation promises, over the whole list.
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/random.h"
#include "motion/kinematics.h"
#include "motion/representation/representation.h"
#include "motion/roles.h"
#include "motion/rotation.h"
#include "motion/walker.h"

namespace marey {
namespace {

constexpr double kFps = 20.0;
constexpr int kFrames = 60;

double drawn(uint64_t seed, uint32_t index) {
  return 2.0 * uniformAt({.seed = seed, .stage = RandomStage::Latent}, index) - 1.0;
}

/// A body of the walker's tree whose bones, axes of joints and motion are random. `symmetric`: both
/// sides have bones of the same length and mirrored directions.
std::shared_ptr<const Skeleton> randomSkeleton(uint64_t seed, bool symmetric) {
  auto out = std::make_shared<Skeleton>(*walkerSkeleton());
  const auto mirror = rolesOf(*out).mirror;
  for (int j = 1; j < out->jointCount(); ++j) {
    const auto at = static_cast<size_t>(j);
    const auto n = static_cast<uint32_t>(j);
    if (symmetric && mirror[at] < j) {
      const auto& other = out->offsets[static_cast<size_t>(mirror[at])];
      out->offsets[at] = {-other.x(), other.y(), other.z()};
      continue;
    }
    out->offsets[at] += 0.1f * Vec3(static_cast<float>(drawn(seed, 3 * n)),
                                    static_cast<float>(drawn(seed, 3 * n + 1)),
                                    static_cast<float>(drawn(seed, 3 * n + 2)));
    if (symmetric && mirror[at] == j) out->offsets[at].x() = 0.f;
  }
  return out;
}

/// Every joint turns about its own axis, up to 2 rad to each side; the body walks a curve.
Clip randomClip(std::shared_ptr<const Skeleton> skeleton, uint64_t seed, int frames = kFrames) {
  Clip out{.name = "random", .skeleton = skeleton, .fps = kFps};
  JointTransforms local;
  for (int t = 0; t < frames; ++t)
    for (int j = 0; j < skeleton->jointCount(); ++j) {
      const auto n = static_cast<uint32_t>(j);
      const Vec3d axis =
          Vec3d(drawn(seed, 500 + 5 * n), drawn(seed, 501 + 5 * n), drawn(seed, 502 + 5 * n))
              .normalized();
      const double phase = std::numbers::pi * drawn(seed, 503 + 5 * n);
      const double size = (j == 0 ? 0.3 : 2.0) * drawn(seed, 504 + 5 * n);
      const Quatd turn(Eigen::AngleAxisd(size * std::sin(0.15 * t + phase), axis));
      const Quatd heading = j == 0 ? axisRotation(1, 0.03 * t) : Quatd::Identity();
      local.rotations.push_back((heading * turn).cast<float>());
      local.translations.push_back(
          j == 0 ? Vec3(0.02f * static_cast<float>(t), 0.9f, 0.05f * static_cast<float>(t))
                 : skeleton->offsets[static_cast<size_t>(j)]);
    }
  out.positions = forwardKinematics(*skeleton, local);
  out.transforms = std::move(local);
  return out;
}

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double out = a.size() == b.size() ? 0.0 : 1e9;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    out = std::max(out, (a[i] - b[i]).cast<double>().norm());
  return out;
}

class EveryRepresentation : public testing::TestWithParam<std::string> {
 protected:
  const Representation& poses() const { return representationNamed(GetParam(), {}); }
  FeatureSpec spec() const { return {.layout = GetParam(), .fps = kFps}; }
  /// The skeleton with whatever rest pose the representation wants.
  std::shared_ptr<const Skeleton> skeletonOf(const Clip& clip) const {
    return poses().skeletonOf({clip}, spec());
  }
  Clip back(const FeatureSequence& f, const std::shared_ptr<const Skeleton>& skeleton) const {
    return rebuildMotion(f.pose, f.control, f.start, skeleton, spec());
  }
};

std::vector<std::string> names() {
  std::vector<std::string> out;
  for (const Representation& r : representations()) out.push_back(r.name);
  return out;
}

INSTANTIATE_TEST_SUITE_P(Laws, EveryRepresentation, testing::ValuesIn(names()),
                         [](const auto& info) {
                           std::string out = info.param;
                           std::erase(out, '-');
                           return out;
                         });

TEST_P(EveryRepresentation, HasAsManyChannelsAsValuesAndNamesEachOnce) {
  const Clip clip = randomClip(randomSkeleton(1, false), 1);
  const auto channels = poses().channels(*clip.skeleton);
  EXPECT_EQ(poses().width(*clip.skeleton), static_cast<int>(channels.size()));
  EXPECT_EQ(extractFeatures(clip, spec()).pose.cols(), static_cast<long>(channels.size()));
  EXPECT_EQ(poses().joints(static_cast<int>(channels.size())), clip.jointCount());
  EXPECT_EQ(poses().joints(static_cast<int>(channels.size()) + 1), -1);
  std::set<std::string> seen;
  for (const Channel& channel : channels) {
    EXPECT_TRUE(seen.insert(channel.name).second) << channel.name;
    ASSERT_GE(channel.joint, 0);
    ASSERT_LT(channel.joint, clip.jointCount());
    EXPECT_TRUE(channel.unit() == "m" || channel.unit() == "rad");
  }
}

TEST_P(EveryRepresentation, GivesMotionBackWithinItsStatedError) {
  for (const uint64_t seed : {1, 2, 3}) {
    const Clip clip = randomClip(randomSkeleton(seed, false), seed);
    const auto skeleton = skeletonOf(clip);
    const FeatureSequence f = extractFeatures(clip, spec(), skeleton);
    EXPECT_EQ(f.fitM, 0.0);
    const Clip again = back(f, skeleton);
    EXPECT_EQ(again.fps, kFps);
    EXPECT_LT(farthest(again.positions, clip.positions), poses().roundTripM);
    ASSERT_EQ(again.transforms.has_value(), poses().rotations);
    if (!again.transforms) continue;
    const auto own = globalRotations(*clip.skeleton, *clip.transforms);
    const auto found = globalRotations(*again.skeleton, *again.transforms);
    for (size_t i = 0; i < own.size(); ++i)
      ASSERT_LT(angleBetween(own[i].cast<double>(), found[i].cast<double>()), 1e-5);
    EXPECT_LT(farthest(forwardKinematics(*again.skeleton, *again.transforms), again.positions),
              1e-6);
  }
}

TEST_P(EveryRepresentation, EncodesWhatItDecodedAsTheSameValues) {
  const Clip clip = randomClip(randomSkeleton(4, false), 4);
  const auto skeleton = skeletonOf(clip);
  const FeatureSequence f = extractFeatures(clip, spec(), skeleton);
  // The root's own frames: those of the decoded clip would be filtered once more.
  const auto trajectory = trajectoryFromControl(f.control, f.start);
  const Clip again = poses().decode(f.pose, trajectory, skeleton);
  Clip named = again;
  named.fps = kFps;
  const Matrix twice = poses().encode(poses().ready(named, *skeleton).clip, *skeleton, trajectory);
  EXPECT_LT((twice - f.pose).cwiseAbs().maxCoeff(), 2e-5f);
}

TEST_P(EveryRepresentation, PosesDoNotKnowWhereTheBodyIsOrLooks) {
  const Clip clip = randomClip(randomSkeleton(5, false), 5);
  Clip moved = clip;
  const Quat turn = axisRotation(1, 2.5).cast<float>();
  const Vec3 shift(3.f, 0.f, -2.f);
  for (Vec3& p : moved.positions) p = turn * p + shift;
  const auto width = static_cast<size_t>(clip.jointCount());
  for (size_t i = 0; i < moved.transforms->rotations.size(); i += width) {
    moved.transforms->rotations[i] = turn * moved.transforms->rotations[i];
    moved.transforms->translations[i] = turn * moved.transforms->translations[i] + shift;
  }
  const auto skeleton = skeletonOf(clip);
  EXPECT_LT(
      (extractFeatures(moved, spec(), skeleton).pose - extractFeatures(clip, spec(), skeleton).pose)
          .cwiseAbs()
          .maxCoeff(),
      2e-5f);
}

TEST_P(EveryRepresentation, MirroredTwiceIsItself) {
  for (const bool symmetric : {true, false}) {
    const Clip clip = randomClip(randomSkeleton(6, symmetric), 6);
    const auto skeleton = skeletonOf(clip);
    const FeatureSequence f = extractFeatures(clip, spec(), skeleton);
    const auto twice = mirrored(mirrored(f, spec(), *skeleton), spec(), *skeleton);
    EXPECT_LT((twice.pose - f.pose).cwiseAbs().maxCoeff(), 2e-5f) << symmetric;
    EXPECT_EQ(twice.control, f.control);
  }
}

TEST_P(EveryRepresentation, AMirroredMotionIsTheWorldMirroredWithLeftAndRightSwapped) {
  const Clip clip = randomClip(randomSkeleton(7, true), 7);
  const auto mirror = rolesOf(*clip.skeleton).mirror;
  const auto skeleton = skeletonOf(clip);
  const Clip other =
      back(mirrored(extractFeatures(clip, spec(), skeleton), spec(), *skeleton), skeleton);
  for (int t = 0; t < clip.frameCount(); ++t)
    for (int j = 0; j < clip.jointCount(); ++j) {
      const Vec3 p = clip.at(t, mirror[static_cast<size_t>(j)]);
      ASSERT_LT((other.at(t, j) - Vec3(-p.x(), p.y(), p.z())).norm(), 1e-4f) << t << " " << j;
    }
}

TEST_P(EveryRepresentation, AReversedMotionIsTheWorldBackwards) {
  const Clip clip = randomClip(randomSkeleton(8, false), 8);
  const auto skeleton = skeletonOf(clip);
  const FeatureSequence f = extractFeatures(clip, spec(), skeleton);
  const Clip reversed = back(timeReversed(f, spec()), skeleton);
  for (int t = 0; t < kFrames; ++t)
    for (int j = 0; j < clip.jointCount(); ++j)
      ASSERT_LT((reversed.at(t, j) - clip.at(kFrames - 1 - t, j)).norm(), 1e-4f);
}

TEST_P(EveryRepresentation, TakesClipsWithoutRotations) {
  std::vector<RootFrame> path;
  for (int t = 0; t < 80; ++t) path.push_back({.x = 0.0, .z = 0.06 * t, .heading = 0.0});
  Clip clip = walk(path, {.seed = 3, .fps = kFps}).clip;
  clip.transforms.reset();
  const auto skeleton = skeletonOf(clip);
  const FeatureSequence f = extractFeatures(clip, spec(), skeleton);
  const Clip again = back(f, skeleton);
  EXPECT_LT(farthest(again.positions, clip.positions), f.fitM + 1e-4);
  EXPECT_LT(f.fitM, 1e-3) << "the walker's bones are constant";
}

TEST(Representations, AreKnownByFormerNamesToo) {
  EXPECT_EQ(representationNamed("positions", {}).name, "root-positions");
  EXPECT_EQ(representationNamed("root-positions", {}).name, "root-positions");
  EXPECT_EQ(representationNamed("joint-expmap", {}).name, "joint-expmap");
  try {
    representationNamed("six-d", {.path = "data.marey"});
    FAIL();
  } catch (const InputError& fault) {
    const std::string text = fault.what();
    EXPECT_NE(text.find("data.marey"), std::string::npos) << text;
    EXPECT_NE(text.find("root-positions, joint-expmap"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace marey
