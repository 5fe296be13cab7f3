// The observation floor of bases, and what it makes of clips that a model without one cannot score.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "model/likelihood.h"
#include "moglow/family.h"
#include "moglow/linear_base.h"
#include "motion/walker.h"
#include "nn/flow/flow.h"
#include "nn/torch/torch.h"

namespace marey {
namespace {

using moglow::BaseInput;

TEST(ObservationFloor, NoDirectionOfALinearBaseIsNarrowerThanIt) {
  moglow::Config config;
  config.poseDim = 6;
  config.tau = 3;
  config.poseBase = "linear";
  moglow::LinearBase base(config);
  const auto random = at::TensorOptions().dtype(torch::kFloat32);
  torch::manual_seed(3);
  const BaseInput input{torch::randn({500, 18}, random), torch::randn({500, 12}, random), {}};
  // Two of six directions move; the others repeat the last pose, exactly.
  auto poses = input.history.narrow(1, 12, 6).clone();
  poses.narrow(1, 0, 2) += 0.3 * torch::randn({500, 2}, random);
  const auto floor = torch::tensor({0.05f, 0.05f, 0.1f, 0.02f, 0.01f, 0.2f});
  base.fit(poses, input, floor);
  const auto foresight =
      base.foresee({input.history.narrow(0, 0, 1), input.control.narrow(0, 0, 1), {}});
  auto e = torch::zeros({1, 6}).requires_grad_(true);
  const auto x = base.toPose(e, foresight);
  std::vector<torch::Tensor> rows;
  for (int64_t d = 0; d < 6; ++d)
    rows.push_back(torch::autograd::grad({x[0][d]}, {e}, {}, true)[0].squeeze(0));
  // In units of the floor; a random direction, and the narrowest one.
  const auto widths = torch::linalg_svdvals(torch::stack(rows) / floor.unsqueeze(1));
  EXPECT_GE(widths.min().item<double>(), 0.999);
  EXPECT_LE(widths.min().item<double>(), 1.1) << "what does not move lies on the floor";
}

class ShippedWalker : public testing::Test {
 protected:
  static const MotionModel& model() {
    static const auto loaded = loadModel(MAREY_SOURCE_DIR "/resources/demo/demo.marey", families());
    return *loaded;
  }
  static std::vector<ModelFamily>& families() {
    static std::vector<ModelFamily> all{moglow::family()};
    return all;
  }
  static Clip walker() { return walkerDataSet(1, 8.0, 90210, 20.0).front().clip; }
  static double nats(const Clip& clip) { return scoreClip(model(), clip).meanNatsPerFrame(); }
  static int jointNamed(const Clip& clip, const std::string& name) {
    const auto& names = clip.skeleton->names;
    return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
  }
  /// Everything below a joint, itself included, moves along its bone.
  static Clip withLongerBone(Clip clip, int joint, float metres) {
    const auto& parents = clip.skeleton->parents;
    const auto parent = [&](int j) { return parents[static_cast<size_t>(j)]; };
    std::vector<int> moved{joint};
    for (int j = joint + 1; j < clip.jointCount(); ++j)
      if (std::find(moved.begin(), moved.end(), parent(j)) != moved.end()) moved.push_back(j);
    for (int t = 0; t < clip.frameCount(); ++t) {
      const Vec3 along = (clip.at(t, joint) - clip.at(t, parent(joint))).normalized();
      for (const int j : moved) clip.frame(t)[static_cast<size_t>(j)] += metres * along;
    }
    return clip;
  }
};

TEST_F(ShippedWalker, ABoneAMillimetreLongerCostsTensOfNatsAtMost) {
  const Clip clip = walker();
  const double natural = nats(clip);
  for (const char* joint : {"LeftForeArm", "LeftLeg", "RightHand"}) {
    const int j = jointNamed(clip, joint);
    ASSERT_LT(j, clip.jointCount()) << joint;
    const double cost = natural - nats(withLongerBone(clip, j, 0.001f));
    EXPECT_LT(std::abs(cost), 30.0) << joint;
  }
}

TEST_F(ShippedWalker, AnotherActorCostsTensOfNats) {
  // Everything as large as it is times a factor, the way that it went included.
  const Clip clip = walker();
  const double natural = nats(clip);
  for (const float size : {1.05f, 0.95f, 1.2f, 0.8f}) {
    Clip other = clip;
    for (int t = 0; t < other.frameCount(); ++t)
      for (Vec3& joint : other.frame(t)) joint *= size;
    EXPECT_LT(std::abs(natural - nats(other)), 100.0) << size;
  }
}

TEST_F(ShippedWalker, LimbsOfOtherProportionsCostTensOfNats) {
  const Clip clip = walker();
  const double natural = nats(clip);
  for (const char* joint : {"LeftForeArm", "LeftLeg", "Head"})
    EXPECT_LT(natural - nats(withLongerBone(clip, jointNamed(clip, joint), 0.01f)), 100.0) << joint;
}

TEST_F(ShippedWalker, TheWorstFrameIsThatOfAFaultThatCanBeSeen) {
  Clip clip = walker();
  const int frame = 90, hand = jointNamed(clip, "LeftHand");
  ASSERT_LT(hand, clip.jointCount());
  clip.frame(frame)[static_cast<size_t>(hand)] += Vec3(0.f, 0.05f, 0.f);
  const ClipScore score = scoreClip(model(), clip);
  const auto worst = std::min_element(score.loglikNats.begin(), score.loglikNats.end());
  const long found = score.firstFrame + (worst - score.loglikNats.begin());
  // The next frame has the fault in its history, from which it is foreseen.
  EXPECT_GE(found, frame);
  EXPECT_LE(found, frame + 1);
  ASSERT_EQ(score.oddestJoint.size(), score.loglikNats.size());
  EXPECT_EQ(score.oddestJoint[static_cast<size_t>(found - score.firstFrame)], hand);
}

}  // namespace
}  // namespace marey
