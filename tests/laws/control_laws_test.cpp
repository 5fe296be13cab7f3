// What holds of any family and any control: it is trained, sampled and scored with all of it, and
// with what may be left out left out.
#include <cmath>

#include "../unit/base/support.h"
#include "law_models.h"
#include "task/live_rollout.h"

#include "base/error.h"
#include "model/sampler.h"
#include "model/scorer.h"

namespace marey {
namespace {

using test::law::allFamilies;
using test::law::allSystems;
using test::law::controlledData;
using test::law::requestOf;
using test::law::systemName;
using test::law::walksWithBeat;

SampleRequest asked(const std::string& type) {
  SampleRequest out{.path = {}, .samples = 2, .seed = 3, .warmUpS = 0.5};
  for (int t = 0; t < 20; ++t) out.path.push_back({0.01 * t, 0.05 * t, 0.03 * t});
  out.control.annotations.labels = {{.label = type}};
  out.control.annotations.signals = walksWithBeat(1, 2.0, 5).front().annotations.signals;
  return out;
}

class ControlLaws : public testing::TestWithParam<ModelFamily> {
 protected:
  /// Null where the family refuses such control, which names it.
  std::unique_ptr<MotionModel> made() const {
    const test::TempFolder folder;
    TrainRequest request = requestOf(GetParam(), folder / "run");
    if (request.steps) request.steps = 4;
    Progress progress;
    try {
      const TrainResult result = train(controlledData(), request, allFamilies(), progress);
      return loadModel(result.last.string(), allFamilies());
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("control"), std::string::npos) << e.what();
      return nullptr;
    }
  }
};

Matrix firstOf(const MotionModel& model, const SampleRequest& request) {
  Progress progress;
  return sampleSequences(model, request, progress).front().pose;
}

TEST_P(ControlLaws, EveryKindTakesEffectAndMayBeLeftOutWhereItMay) {
  const auto model = made();
  if (!model) return;
  const auto& layout = model->info().features.control;
  EXPECT_EQ(layout, controlledData().options.features.control);
  ASSERT_GE(channelNamed(layout, "type")->values.size(), 2U);
  const std::string one = layout[2].values[0], other = layout[2].values[1];
  const Matrix plain = firstOf(*model, asked(one));
  EXPECT_TRUE(plain.allFinite());
  EXPECT_TRUE(firstOf(*model, asked(one)) == plain);
  EXPECT_FALSE(firstOf(*model, asked(other)) == plain);
  for (const char* name : {"path", "beat"}) {
    SampleRequest without = asked(one);
    without.control.leftOut = {name};
    const Matrix found = firstOf(*model, without);
    EXPECT_TRUE(found.allFinite()) << name;
    EXPECT_FALSE(found == plain) << name;
  }
  SampleRequest silent = asked(one);  // a signal that nobody gives is left out as well
  silent.control.annotations.signals.clear();
  SampleRequest without = asked(one);
  without.control.leftOut = {"beat"};
  EXPECT_TRUE(firstOf(*model, silent) == firstOf(*model, without));
}

TEST_P(ControlLaws, ABodyIsAskedForAndMoves) {
  const auto model = made();
  if (!model) return;
  SampleRequest request = asked(model->info().features.control[2].values[0]);
  const Matrix plain = firstOf(*model, request);
  auto tall = std::make_shared<Skeleton>(*model->info().skeleton);
  for (auto& offset : tall->offsets) offset *= 1.2F;
  request.control.body = tall;
  EXPECT_FALSE(firstOf(*model, request) == plain);
  Progress progress;
  EXPECT_EQ(*sampleClips(*model, request, progress).front().skeleton, *tall);
}

TEST_P(ControlLaws, WhatMustBeThereIsAskedFor) {
  const auto model = made();
  if (!model) return;
  SampleRequest request = asked("");
  request.control.annotations.labels.clear();
  EXPECT_THROW(firstOf(*model, request), InputError);
  request.control.annotations.labels = {{.label = "no such type"}};
  EXPECT_THROW(firstOf(*model, request), InputError);
}

TEST_P(ControlLaws, AClipIsFollowedAndScoredWithItsOwn) {
  const auto model = made();
  if (!model) return;
  Progress progress;
  const auto clip = walksWithBeat(3, 3.0, 2).back();
  const SampleRequest along = requestAlongClip(*model, clip, false);
  EXPECT_TRUE(
      controlOf(model->info(), along).isApprox(featuresOf(model->info(), clip).control, 1e-4F));
  const auto score = scoreClips(*model, {&clip, 1}, false, progress).front();
  EXPECT_EQ(std::isfinite(score.meanNatsPerFrame()), model->density() != nullptr);
}

/// Steering along a straight way asks for what a path asks for, also where the type changes.
TEST_P(ControlLaws, SteeringIsTheSameControl) {
  const auto owned = made();
  if (!owned || !owned->rollout()) return;
  const std::shared_ptr<const MotionModel> model(std::shared_ptr<const MotionModel>(), owned.get());
  const auto& types = model->info().features.control[2].values;
  SampleRequest request = asked(types[0]);
  request.samples = 1;
  request.control.leftOut = {"beat"};
  request.control.annotations.labels = {{0.0, 0.5, types[0]}, {.fromS = 0.5, .label = types[1]}};
  request.path.clear();
  for (int t = 0; t < 20; ++t) request.path.push_back({0.0, 0.05 * t, 0.0});
  const LiveCommand before{.forwardMS = 1.0, .type = types[0]};
  LiveOptions options{.seed = 3, .warmUpS = 0.5, .smoothingS = 0.0, .begin = before};
  options.leftOut = {"beat"};
  LiveRollout rollout(model, options);
  for (int t = 0; t < 20; ++t) {
    LiveCommand command = before;
    if (t >= 10) command.type = types[1];
    rollout.advance(command);
  }
  const Matrix wanted = controlOf(model->info(), request);
  EXPECT_TRUE(rollout.sequence().control.isApprox(wanted, 1e-4F));
  EXPECT_TRUE(rollout.sequence().pose.isApprox(firstOf(*model, request), 1e-3F));
}

INSTANTIATE_TEST_SUITE_P(Every, ControlLaws, testing::ValuesIn(allSystems()),
                         [](const auto& info) { return systemName(info.param); });

/// What one system may refuse, the example of every family takes.
TEST(ControlledData, TrainsTheExampleOfEveryFamily) {
  Progress progress;
  for (const ModelFamily& family : allFamilies()) {
    const test::TempFolder folder;
    TrainRequest request = requestOf(family, folder / "run");
    if (request.steps) request.steps = 1;
    EXPECT_NO_THROW(train(controlledData(), request, allFamilies(), progress)) << family.name;
  }
}

/// The mean and deviation of what is there, not of the zeros of what is not.
TEST(ControlledData, IsStandardisedOverWhatIsThere) {
  auto clips = walksWithBeat(4, 4.0, 2);
  clips[0].annotations.signals.clear();
  for (size_t i = 1; i < clips.size(); ++i)
    for (float& v : clips[i].annotations.signals["beat"].values) v += 10.F;
  PrepareOptions options{.mirror = false, .reverse = false};
  options.features.control = {ControlChannel{},
                              {.name = "beat", .kind = ControlKind::Array, .optional = true}};
  Progress progress;
  const DataSet set = prepareDataSet(clips, {}, options, progress);
  EXPECT_NEAR(set.standardiser.controlMean[3], 10.0, 0.2);
  EXPECT_NEAR(set.standardiser.controlStd[3], std::sqrt(0.5), 0.05);
  EXPECT_EQ(set.standardiser.controlStd[4], 1.F) << "of the presence";
  EXPECT_EQ(set.train[0].control(5, 4), 0.F);
  EXPECT_EQ(set.train[0].control(5, 3), set.standardiser.controlMean[3]);
  EXPECT_EQ(set.train[1].control(5, 4), 1.F);
}

TEST(ControlledData, KeepsEveryBodyAndComesBackFromItsFile) {
  auto clips = walksWithBeat(3, 4.0, 2);
  auto tall = std::make_shared<Skeleton>(*clips[0].skeleton);
  for (auto& offset : tall->offsets) offset *= 1.2F;
  clips[2].skeleton = tall;
  for (Vec3& p : clips[2].positions) p *= 1.2F;
  clips[2].transforms.reset();
  PrepareOptions options{.mirror = true, .reverse = false};
  options.features.control = controlledData().options.features.control;
  Progress progress;
  const DataSet set = prepareDataSet(clips, {}, options, progress);
  const auto at = columnsOf(set.options.features.control, 20.0);
  EXPECT_NEAR(set.train[2].control(0, at[3].end() - 1),
              1.2 * set.train[0].control(0, at[3].end() - 1), 1e-4)
      << "the height of its hips";
  const test::TempFolder folder;
  writeDataSet(folder / "data.marey", set);
  const DataSet back = readDataSet(folder / "data.marey");
  EXPECT_EQ(back.options.features, set.options.features);
  ASSERT_EQ(back.train.size(), set.train.size());
  for (size_t i = 0; i < back.train.size(); ++i) {
    ASSERT_TRUE(back.train[i].body) << i;
    EXPECT_EQ(*back.train[i].body, *set.train[i].body) << i;
    EXPECT_TRUE(back.train[i].control == set.train[i].control) << i;
  }
  EXPECT_FALSE(*back.train[2].body == *back.train[0].body);
}

}  // namespace
}  // namespace marey
