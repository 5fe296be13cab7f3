// What holds of any task with any family: a model that can do it does, one that cannot says why.
#include <cmath>

#include "families.h"
#include "law_models.h"
#include "task/pose_error.h"
#include "task/task.h"
#include "toy_family.h"

#include "base/error.h"

namespace marey {
namespace {

using test::law::allSystems;
using test::law::systemName;
using test::law::walks;

/// A request that has something for every task.
TaskRequest requestFor(const MotionModel& model, const Clip& clip) {
  TaskRequest out{.clip = clip, .path = {}, .samples = 2, .seed = 4};
  const FeatureSequence features = featuresOf(model.info(), clip);
  out.knownJoints = Matrix::Ones(features.frameCount(), clip.jointCount());
  out.knownJoints.rightCols(3).setZero();
  out.noiseM = 0.02;
  out.steering.emplace();
  out.steering->commands.assign(30, LiveCommand{.forwardMS = 1.0});
  return out;
}

class TaskLaws : public testing::TestWithParam<std::tuple<Task, ModelFamily>> {
 protected:
  const Task& task() const { return std::get<0>(GetParam()); }
  std::unique_ptr<MotionModel> model() const {
    const ModelFamily& family = std::get<1>(GetParam());
    return family.load(test::law::madeBy(family).file, "law.marey", {});
  }
};

TEST_P(TaskLaws, IsDoneOrRefusedWithAReason) {
  const auto one = model();
  const Clip clip = walks(1, 3.0, 8).front();
  Progress progress;
  const TaskRequest request = requestFor(*one, clip);
  if (!task().whyNot(*one).empty()) {
    EXPECT_THROW(runTask(task(), *one, request, progress), InputError);
    return;
  }
  const TaskOutcome outcome = runTask(task(), *one, request, progress);
  ASSERT_EQ(outcome.motions.size(), 2U);
  for (const Clip& motion : outcome.motions) {
    validate(motion);
    EXPECT_EQ(motion.skeleton->names, clip.skeleton->names);
    EXPECT_EQ(motion.frameCount(),
              outcome.reference ? outcome.reference->frameCount() : motion.frameCount());
  }
  const TaskOutcome again = runTask(task(), *one, request, progress);
  EXPECT_TRUE(again.motions[1].positions == outcome.motions[1].positions);
}

TEST_P(TaskLaws, CanBeCancelled) {
  const auto one = model();
  if (!task().whyNot(*one).empty()) return;
  std::stop_source stop;
  stop.request_stop();
  Progress cancelled({}, stop.get_token());
  const TaskRequest request = requestFor(*one, walks(1, 3.0, 8).front());
  EXPECT_THROW(runTask(task(), *one, request, cancelled), CancelledError);
}

std::vector<Task> allTasks() {
  return {tasks().begin(), tasks().end()};
}

INSTANTIATE_TEST_SUITE_P(Every, TaskLaws,
                         testing::Combine(testing::ValuesIn(allTasks()),
                                          testing::ValuesIn(allSystems())),
                         [](const auto& info) {
                           return std::get<0>(info.param).name + "_" +
                                  systemName(std::get<1>(info.param));
                         });

TEST(Tasks, AreFoundByName) {
  for (const Task& task : tasks()) EXPECT_EQ(taskNamed(task.name).title, task.title);
  EXPECT_THROW(taskNamed("dance"), InputError);
}

/// The reference of a prediction is the clip itself after the seed frames, and its first frame goes
/// on from the last of them.
TEST(Predict, IsJudgedByWhatCame) {
  const Clip clip = walks(1, 3.0, 8).front();
  Progress progress;
  for (const ModelFamily& family : allSystems()) {
    const auto model = family.load(test::law::madeBy(family).file, "law.marey", {});
    const Task& predict = taskNamed("predict");
    if (!predict.whyNot(*model).empty()) continue;
    TaskRequest request{.clip = clip, .path = {}, .samples = 1, .seedFrames = 20};
    const TaskOutcome outcome = runTask(predict, *model, request, progress);
    const Clip rest = sliceFrames(clip, 20, clip.frameCount());
    EXPECT_LT(poseError({&rest, 1}, *outcome.reference).meanCm, 0.01) << systemName(family);
    EXPECT_LT((outcome.motions[0].at(0, 0) - clip.at(20, 0)).norm(), 0.3F) << systemName(family);
    request.seedFrames = model->info().context - 1;
    if (request.seedFrames > 0) {
      EXPECT_THROW(runTask(predict, *model, request, progress), InputError);
    }
    request.seedFrames = clip.frameCount();
    EXPECT_THROW(runTask(predict, *model, request, progress), InputError);
    request = {.clip = clip, .path = {}, .seedFrames = 20, .seconds = 0.5};
    EXPECT_EQ(runTask(predict, *model, request, progress).motions[0].frameCount(), 10);
    for (int t = 0; t < 15; ++t) request.path.push_back({5.0, 0.05 * t, 0.0});
    const TaskOutcome free = runTask(predict, *model, request, progress);
    EXPECT_FALSE(free.reference);
    EXPECT_EQ(free.motions[0].frameCount(), 15);
  }
}

/// Steering goes the way that it was told, each sample on its own latents.
TEST(Steer, GoesWhereItIsTold) {
  const Clip clip = walks(1, 3.0, 8).front();
  Progress progress;
  for (const ModelFamily& family : allSystems()) {
    const auto model = family.load(test::law::madeBy(family).file, "law.marey", {});
    if (!taskNamed("steer").whyNot(*model).empty()) continue;
    TaskRequest request = requestFor(*model, clip);
    request.steering->options.smoothingS = 0.0;
    request.steering->options.begin = request.steering->commands.front();
    const TaskOutcome outcome = runTask(taskNamed("steer"), *model, request, progress);
    ASSERT_EQ(outcome.motions[0].frameCount(), 30) << systemName(family);
    EXPECT_FALSE(outcome.reference);
    const auto root = rootPath(outcome.motions[0], {.rootSigmaS = 0.0, .facingSigmaS = 0.0});
    EXPECT_NEAR(root.back().z - root.front().z, 29 * 0.05, 0.5) << systemName(family);
    if (model->info().deterministic()) continue;
    EXPECT_FALSE(outcome.motions[0].positions == outcome.motions[1].positions);
  }
}

/// The toy's poses lie in a plane of two directions: noise off that plane goes.
TEST(Denoise, TakesNoiseOutOfWhatAModelKnows) {
  const auto family = test::toyFamily();
  const auto model = family.load(test::law::madeBy(family).file, "law.marey", {});
  Progress progress;
  const Task& denoise = taskNamed("denoise");
  TaskRequest request{.clip = walks(1, 3.0, 8).front(), .path = {}, .seed = 4};
  const Clip own = runTask(denoise, *model, request, progress).motions.front();
  EXPECT_FALSE(runTask(denoise, *model, request, progress).reference);
  request.clip = own;  // of the toy's own poses, nearly
  request.noiseM = 0.05;
  const TaskOutcome outcome = runTask(denoise, *model, request, progress);
  ASSERT_TRUE(outcome.reference && outcome.without);
  const double before = poseError({&*outcome.without, 1}, *outcome.reference).meanCm;
  // The mean length of a normal vector of three values: sqrt(8 / pi) deviations.
  EXPECT_NEAR(before, 5.0 * std::sqrt(8.0 / M_PI), 0.2);
  EXPECT_LT(poseError(outcome.motions, *outcome.reference).meanCm, 0.5 * before);
}

TEST(Complete, KeepsWhatIsKnown) {
  const auto family = test::toyFamily();
  const auto model = family.load(test::law::madeBy(family).file, "law.marey", {});
  const Clip clip = walks(1, 3.0, 8).front();
  Progress progress;
  const TaskRequest request = requestFor(*model, clip);
  const TaskOutcome outcome = runTask(taskNamed("complete"), *model, request, progress);
  for (int j = 0; j < clip.jointCount() - 3; ++j)
    EXPECT_LT((outcome.motions[0].at(7, j) - clip.at(7, j)).norm(), 1e-4F) << j;
  EXPECT_GT(
      (outcome.motions[0].at(7, clip.jointCount() - 1) - clip.at(7, clip.jointCount() - 1)).norm(),
      1e-4F);
  // Joints hidden at random: better filled in than held.
  TaskRequest random{.clip = outcome.motions[0], .path = {}, .seed = 4};
  EXPECT_THROW(runTask(taskNamed("complete"), *model, random, progress), InputError);
  random.missing = 0.5;
  const TaskOutcome guessed = runTask(taskNamed("complete"), *model, random, progress);
  EXPECT_GT(poseError({&*guessed.without, 1}, *guessed.reference).meanCm, 0.0);
  TaskRequest odd = request;
  odd.knownJoints = Matrix::Ones(3, 2);
  EXPECT_THROW(runTask(taskNamed("complete"), *model, odd, progress), InputError);
}

}  // namespace
}  // namespace marey
