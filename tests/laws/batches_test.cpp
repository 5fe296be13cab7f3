#include "model/gradient/batches.h"

#include <set>

#include <gtest/gtest.h>

namespace marey {
namespace {

/// Frame t of a sequence has pose (base + t) and control -(base + t).
FeatureSequence ramp(const std::string& name, int frames, float base) {
  FeatureSequence out{.name = name, .pose = Matrix(frames, 2), .control = Matrix(frames, 1)};
  for (int t = 0; t < frames; ++t) {
    out.pose.row(t).setConstant(base + static_cast<float>(t));
    out.control(t, 0) = -(base + static_cast<float>(t));
  }
  return out;
}

const Standardiser kPlain{{0.f, 0.f}, {1.f, 1.f}, {0.f}, {1.f}};

std::vector<FeatureSequence> manyRamps() {
  std::vector<FeatureSequence> out;
  for (int i = 0; i < 7; ++i) out.push_back(ramp("clip" + std::to_string(i), 10, 100.f * i));
  return out;
}

std::set<std::string> recordings(const std::vector<FeatureSequence>& sequences) {
  std::set<std::string> out;
  for (const auto& s : sequences) out.insert(s.name.substr(0, s.name.find('|')));
  return out;
}

TEST(Batches, AShortClipIsPaddedWithItsLastFrameAndMasked) {
  const Batches batches({ramp("short", 3, 10.f)}, kPlain, 5, 5, torch::kCPU);
  ASSERT_EQ(batches.windowCount(), 1);
  const auto batch = batches.inOrder(0, 1);
  EXPECT_TRUE(batch.mask.equal(torch::tensor({{1.f, 1.f, 1.f, 0.f, 0.f}})));
  EXPECT_TRUE(batch.pose.select(-1, 0).equal(torch::tensor({{10.f, 11.f, 12.f, 12.f, 12.f}})));
  EXPECT_TRUE(
      batch.control.select(-1, 0).equal(torch::tensor({{-10.f, -11.f, -12.f, -12.f, -12.f}})));
}

TEST(Batches, ValuesAreStandardised) {
  const Standardiser s{{10.f, 11.f}, {2.f, 4.f}, {-10.f}, {5.f}};
  const auto batch = Batches({ramp("a", 2, 10.f)}, s, 2, 1, torch::kCPU).inOrder(0, 1);
  EXPECT_TRUE(batch.pose.equal(torch::tensor({{{0.f, -0.25f}, {0.5f, 0.f}}})));
  EXPECT_TRUE(batch.control.equal(torch::tensor({{{0.f}, {-0.2f}}})));
}

/// A control that may be left out: its value, and whether it is there, beside one that may not.
TEST(Batches, ControlThatMayBeLeftOutIsHiddenInAShareOfTheWindows) {
  FeatureSpec spec{.fps = 20.0};
  spec.control = {ControlChannel{},
                  {.name = "beat", .kind = ControlKind::Array, .optional = true, .values = {"0"}}};
  std::vector<FeatureSequence> clips = manyRamps();
  for (FeatureSequence& clip : clips) clip.control = Matrix::Ones(10, spec.controlWidth());
  const Standardiser plain{
      {0.f, 0.f}, {1.f, 1.f}, std::vector<float>(5, 0.f), std::vector<float>(5, 1.f)};
  const auto hidden = [&](double share, int64_t step) {
    Batches batches(clips, plain, 10, 10, torch::kCPU);
    batches.hideControl(spec, share);
    const auto control = batches.forStep(3, step, 7).control;
    EXPECT_TRUE(control.narrow(-1, 0, 3).eq(1.f).all().item<bool>()) << "root motion stays";
    const auto seen = control.narrow(-1, 3, 2);
    // All of a window or nothing of it, and value and presence together.
    EXPECT_TRUE(seen.eq(seen.select(1, 0).select(-1, 0).view({7, 1, 1})).all().item<bool>());
    return 7 - static_cast<int>(seen.select(1, 0).select(-1, 0).sum().item<float>());
  };
  EXPECT_EQ(hidden(0.0, 0), 0);
  EXPECT_EQ(hidden(1.0, 0), 7);
  int half = 0;
  for (int64_t step = 0; step < 60; ++step) half += hidden(0.5, step);
  EXPECT_NEAR(half / 420.0, 0.5, 0.1) << "four deviations of 420 throws";
  EXPECT_EQ(hidden(0.5, 7), hidden(0.5, 7)) << "the same again for a resumed run";
}

TEST(Batches, AnEpochShowsEveryWindowOnceInAnotherOrderEachTime) {
  Batches batches(manyRamps(), kPlain, 10, 10, torch::kCPU);
  std::vector<std::vector<float>> epochs;
  for (int64_t epoch = 0; epoch < 2; ++epoch) {
    const auto pose = batches.forStep(3, epoch, 7).pose.select(-1, 0).select(-1, 0).contiguous();
    epochs.emplace_back(pose.data_ptr<float>(), pose.data_ptr<float>() + 7);
    EXPECT_EQ(std::set<float>(epochs.back().begin(), epochs.back().end()),
              (std::set<float>{0, 100, 200, 300, 400, 500, 600}));
  }
  EXPECT_NE(epochs[0], epochs[1]);
}

TEST(Batches, TheBatchOfAStepDoesNotDependOnTheStepsBefore) {
  Batches walked(manyRamps(), kPlain, 4, 2, torch::kCPU), fresh = walked;
  for (int64_t step = 0; step < 9; ++step) walked.forStep(1, step, 3);
  EXPECT_TRUE(walked.forStep(1, 9, 3).pose.equal(fresh.forStep(1, 9, 3).pose));
  EXPECT_FALSE(fresh.forStep(1, 9, 3).pose.equal(fresh.forStep(2, 9, 3).pose));
}

TEST(Batches, UsableFramesHaveTheirContextAndLookaheadInTheSameClip) {
  const Batches batches({ramp("a", 5, 0.f), ramp("b", 4, 50.f)}, kPlain, 4, 4, torch::kCPU);
  const auto frames = batches.frames(2, 1);
  EXPECT_TRUE(frames.usable.equal(torch::tensor({2, 3, 7}, torch::kInt64)));
}

TEST(Batches, ValidationHoldsAClipOutWithAllItsAugmentedVersions) {
  std::vector<FeatureSequence> all;
  for (const char* tail : {"", "|mirror", "|reverse", "|mirror|reverse"})
    for (const auto& s : manyRamps()) {
      all.push_back(s);
      all.back().name += tail;
    }
  const auto [train, valid] = splitValidation(all, 0.3);  // 2 of 7
  EXPECT_EQ(valid.size(), 2u);                            // as recorded only
  EXPECT_EQ(train.size(), 20u);
  for (const auto& name : recordings(valid)) EXPECT_FALSE(recordings(train).contains(name)) << name;
  EXPECT_EQ(recordings(train).size() + recordings(valid).size(), 7u);
}

TEST(Batches, AShareOfLessThanOneClipHoldsNothingOut) {
  const auto [train, valid] = splitValidation(manyRamps(), 0.1);
  EXPECT_EQ(train.size(), 7u);
  EXPECT_TRUE(valid.empty());
}

}  // namespace
}  // namespace marey
