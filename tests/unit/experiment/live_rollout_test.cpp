// A motion steered frame by frame.
#include <gtest/gtest.h>

#include "base/error.h"
#include "experiment/sample_set.h"
#include "model/sampler.h"

namespace marey {
namespace {

constexpr double kFps = 20.0;

/// Poses depend on the latent, on all controls in sight and on the pose before.
class MemoryModel : public MotionModel, public FrameGenerator, public DensityEstimator {
 public:
  explicit MemoryModel(int lookahead = 1) {
    m_info.poseDim = 6;
    m_info.controlDim = 3;
    m_info.context = 2;
    m_info.lookahead = lookahead;
    m_info.latent.width = 6;
    m_info.optionSchema = {temperatureOption(m_info.latent.width)};
    m_info.density = DensityKind::Exact;
    m_info.features.fps = kFps;
    auto body = std::make_shared<Skeleton>();
    body->names = {"Hips", "Head"};
    body->parents = {-1, 0};
    body->offsets = {{0, 1, 0}, {0, 0.5F, 0}};
    m_info.skeleton = body;
  }
  const ModelInfo& info() const override { return m_info; }
  const FrameGenerator* rollout() const override { return this; }
  const DensityEstimator* density() const override { return this; }
  RolloutState start(int batch, const Matrix&) const override {
    return {Matrix(Matrix::Zero(batch, m_info.poseDim))};
  }
  Matrix sampleFrame(RolloutState& state, const Matrix& window,
                     const Matrix& latent) const override {
    auto& pose = std::any_cast<Matrix&>(state.value);
    pose = 0.5F * pose + latent;
    for (long i = 0; i < window.cols(); ++i)
      pose.col(i % pose.cols()) += static_cast<float>(i + 1) * window.col(i);
    return pose;
  }
  std::vector<SequenceScore> observeMany(std::span<RolloutState>,
                                         std::span<const ObservedSequence> sequences,
                                         const std::function<void()>&) const override {
    std::vector<SequenceScore> out;
    for (const ObservedSequence& s : sequences)
      out.push_back({*s.poses, std::vector<double>(static_cast<size_t>(s.poses->rows()))});
    return out;
  }
  TensorFile save() const override { return {}; }

 private:
  ModelInfo m_info;
};

// 1/16 m per frame: exact in binary, so that the path's differences give the same control.
constexpr LiveCommand kStraight{.forwardMS = 1.25};

std::vector<std::vector<Vec3>> walked(const std::vector<LiveCommand>& commands,
                                      const LiveOptions& options) {
  LiveRollout rollout(std::make_shared<MemoryModel>(), options);
  std::vector<std::vector<Vec3>> out;
  for (const LiveCommand& command : commands) out.push_back(rollout.advance(command));
  return out;
}

TEST(LiveRollout, EqualsTheSamplerUnderAConstantCommand) {
  const auto model = std::make_shared<MemoryModel>();
  constexpr int kFrames = 30;
  SampleRequest request;
  for (int t = 0; t < kFrames; ++t) request.path.push_back({0.0, 0.0625 * t, 0.0});
  request.seed = 9;
  request.firstSample = 3;
  request.temperature = 0.7;
  Progress progress;
  const FeatureSequence sampled = sampleSequences(*model, request, progress).front();
  const Clip clip = sampledClip(*model, sampled);

  LiveRollout rollout(model, {.seed = 9, .sample = 3, .temperature = 0.7, .begin = kStraight});
  for (int t = 0; t < kFrames; ++t) {
    const std::vector<Vec3> frame = rollout.advance(kStraight);
    ASSERT_EQ(frame.size(), 2u);
    for (int j = 0; j < 2; ++j)
      EXPECT_EQ(frame[static_cast<size_t>(j)], clip.at(t, j)) << "frame " << t << ", joint " << j;
  }
  EXPECT_EQ(rollout.frameCount(), kFrames);
  EXPECT_EQ(rollout.sequence().pose, sampled.pose);
  EXPECT_EQ(rollout.sequence().control, sampled.control);
}

TEST(LiveRollout, IsTheSameForTheSameSeedAndCommands) {
  std::vector<LiveCommand> commands(25, kStraight);
  for (size_t t = 10; t < 20; ++t) commands[t] = {.sidewaysMS = -0.4, .turnRadS = 0.8};
  EXPECT_EQ(walked(commands, {.seed = 2}), walked(commands, {.seed = 2}));
  EXPECT_NE(walked(commands, {.seed = 2}), walked(commands, {.seed = 3}));
  auto others = commands;
  others[12].turnRadS = 0.0;
  const auto a = walked(commands, {.seed = 2}), b = walked(others, {.seed = 2});
  EXPECT_TRUE(std::equal(a.begin(), a.begin() + 12, b.begin()));
  EXPECT_NE(a[12], b[12]);
}

TEST(LiveRollout, FollowsTheCommandWithItsTimeConstant) {
  LiveRollout rollout(std::make_shared<MemoryModel>(0), {.smoothingS = 0.5});
  for (int t = 0; t < 11; ++t) rollout.advance({.forwardMS = 1.0});
  const Matrix control = rollout.sequence().control;
  // After 0.55 s, 1 - exp(-1.1) of the way.
  EXPECT_NEAR(control(10, 1) * kFps, 1.0 - std::exp(-1.1), 1e-5);
  EXPECT_EQ(control.col(0).cwiseAbs().maxCoeff(), 0.0F);
}

TEST(LiveRollout, StartsWhereItIsToldAndWalksAlongItsHeading) {
  // Heading pi/2 faces +X, left is -Z.
  constexpr double kQuarter = 1.5707963267948966;
  LiveRollout rollout(std::make_shared<MemoryModel>(),
                      {.smoothingS = 0.0, .start = {2.0, 1.0, kQuarter}});
  rollout.advance(kStraight);
  EXPECT_EQ(rollout.root().x, 2.0);
  for (int t = 0; t < 16; ++t) rollout.advance(kStraight);
  EXPECT_NEAR(rollout.root().x, 3.0, 1e-6);
  EXPECT_NEAR(rollout.root().z, 1.0, 1e-6);
  rollout.advance({.sidewaysMS = 2.0});
  EXPECT_NEAR(rollout.root().z, 0.9, 1e-6);
}

TEST(LiveRollout, LeavesAPathThatPassesWhereItWalked) {
  LiveRollout rollout(std::make_shared<MemoryModel>(), {});
  std::vector<RootFrame> roots;
  for (int t = 0; t < 40; ++t) {
    rollout.advance({.forwardMS = 1.0, .turnRadS = t < 20 ? 1.0 : -0.5});
    roots.push_back(rollout.root());
  }
  const auto path = samplePath(rollout.walkedPath(), kFps, "test");
  ASSERT_EQ(path.size(), roots.size());
  for (size_t t = 0; t < path.size(); ++t) {
    EXPECT_NEAR(path[t].x, roots[t].x, 1e-6);
    EXPECT_NEAR(path[t].z, roots[t].z, 1e-6);
    EXPECT_NEAR(path[t].heading, roots[t].heading, 1e-6);
  }
}

TEST(LiveRollout, FacingAsideLeavesTheWayAsItIs) {
  LiveRollout ahead(std::make_shared<MemoryModel>(), {.smoothingS = 0.0});
  LiveRollout aside(std::make_shared<MemoryModel>(), {.smoothingS = 0.0});
  constexpr double kLeft = 1.0;
  for (int t = 0; t < 40; ++t) {
    ahead.advance(kStraight);
    aside.advance({.forwardMS = 1.25, .facingRad = t < 1 ? 0.0 : kLeft});
  }
  EXPECT_NEAR(aside.root().heading, kLeft, 1e-5);
  EXPECT_NEAR(aside.root().x, ahead.root().x, 1e-4);
  EXPECT_NEAR(aside.root().z, ahead.root().z, 1e-4);
}

TEST(LiveRollout, ItsSteeringGivesTheSameMotionAgain) {
  const auto model = std::make_shared<MemoryModel>();
  LiveRollout live(model, {.seed = 5, .temperature = 0.8});
  for (int t = 0; t < 25; ++t)
    live.advance({.forwardMS = t < 9 ? 0.0 : 1.1, .turnRadS = t > 15 ? 0.5 : 0.0});
  SampleRecipe recipe;
  recipe.system.temperature = 0.8;
  recipe.seed = 5;
  recipe.fps = kFps;
  recipe.steering = std::make_shared<const Steering>(live.steering());
  Progress progress;
  const SampleSet again = drawSampleSet(*model, recipe, progress);
  ASSERT_EQ(again.motions.size(), 1U);
  EXPECT_EQ(again.motions.front().clip->positions, sampledClip(*model, live.sequence()).positions);
  EXPECT_EQ(toJson(recipe)["steering"]["commands"].size(), 3U) << "runs of equal commands";
  recipe.samples = 2;
  const SampleSet two = drawSampleSet(*model, recipe, progress);
  EXPECT_NE(two.motions[1].clip->positions, two.motions[0].clip->positions);
}

}  // namespace
}  // namespace marey
