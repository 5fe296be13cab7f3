// The same recipe gives the same motions, bit for bit: in pieces of any size, however often, on any
// thread, with any number of threads, in a document that is run.
#include <functional>
#include <thread>

#include "families.h"
#include <gtest/gtest.h>

#include "experiment/demo_resources.h"
#include "experiment/run.h"
#include "model/sampler.h"
#include "nn/torch/threads.h"

namespace marey {
namespace {

constexpr int kSamples = 23;

std::unique_ptr<MotionModel> demo() {
  return modelFamilies().front().load(parseTensorFile(demoModel(), "demo"), "demo", {});
}

SampleRecipe recipe() {
  return {.system = {.name = "demo", .model = "demo.marey", .temperature = 0.8},
          .path = {.name = "turn", .path = "preset:turn-left", .seconds = 2.0},
          .samples = kSamples,
          .seed = 7};
}

void expectSame(const SampledMotion& got, const SampledMotion& wanted, const std::string& what) {
  EXPECT_EQ(got.clip->positions, wanted.clip->positions) << what;
  EXPECT_EQ(got.score.loglikNats, wanted.score.loglikNats) << what;
  EXPECT_EQ(got.score.latentNorm, wanted.score.latentNorm) << what;
}

void expectSame(const SampleSet& got, const SampleSet& wanted, const std::string& what) {
  ASSERT_EQ(got.motions.size(), wanted.motions.size()) << what;
  for (size_t i = 0; i < got.motions.size(); ++i)
    expectSame(got.motions[i], wanted.motions[i], what + ", motion " + std::to_string(i));
}

SampleSet drawn(const MotionModel& model, int chunk = 0) {
  Progress progress;
  return drawSampleSet(model, recipe(), progress, chunk);
}

TEST(SameBits, InPiecesOfAnySizeHoweverOftenOnAnyThread) {
  const auto model = demo();
  const SampleSet wanted = drawn(*model);
  for (const int threads : {1, 2, 3}) {
    nn::configureThreads(threads, true);
    for (const int chunk : {0, 1, 10, 23})
      for (const bool elsewhere : {false, true}) {
        SampleSet got;
        if (elsewhere)
          std::thread([&] { got = drawn(*model, chunk); }).join();
        else
          got = drawn(*model, chunk);
        expectSame(got, wanted,
                   std::to_string(threads) + " threads, pieces of " + std::to_string(chunk));
      }
  }
  nn::configureThreads(0, true);
  expectSame(drawn(*demo()), wanted, "a model that is read anew");
}

TEST(SameBits, OfTwoThatAreDrawnAtTheSameTime) {
  const auto model = demo();
  const SampleSet wanted = drawn(*model);
  SampleSet a, b;
  std::thread first([&] { a = drawn(*model, 3); }), second([&] { b = drawn(*model, 10); });
  first.join();
  second.join();
  expectSame(a, wanted, "first");
  expectSame(b, wanted, "second");
}

TEST(SameBits, OfEveryNumberOfSamplesUpToSixty) {
  const auto model = demo();
  SampleRequest request = requestOf(*model, recipe());
  request.path.resize(6);
  request.samples = 60;
  Progress progress;
  const auto wanted = sampleSequences(*model, request, progress);
  for (int count = 1; count < 60; ++count) {
    request.samples = count;
    const auto got = sampleSequences(*model, request, progress);
    for (size_t b = 0; b < got.size(); ++b)
      ASSERT_EQ(got[b].pose, wanted[b].pose) << count << " samples, number " << b;
  }
}

TEST(SameBits, InADocumentThatIsRun) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("same_bits_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  writeTensorFile(folder / "demo.marey", parseTensorFile(demoModel(), "demo"));
  const SampleRecipe one = recipe();
  Progress progress;
  const auto result = runExperiment({.natural = {"walker:2,3,1"},
                                     .systems = {one.system},
                                     .paths = {one.path},
                                     .samples = one.samples,
                                     .seed = one.seed,
                                     .folder = folder},
                                    modelFamilies(), progress);
  std::filesystem::remove_all(folder);
  const SampleSet wanted = drawn(*demo(), 10);
  const PathSamples& got = result.systems.front().paths.at("turn");
  ASSERT_EQ(got.clips.size(), wanted.motions.size());
  for (size_t i = 0; i < got.clips.size(); ++i)
    expectSame({got.clips[i], got.scores[i]}, wanted.motions[i], std::to_string(i));
}

}  // namespace
}  // namespace marey
