// Models with a base below the flow ('MG+') on the engine: as the plain path has them, and the same
// bits for any batch, position in it, company and number of threads.
#include <algorithm>
#include <map>
#include <string>

#include "laws/engine_support.h"
#include <gtest/gtest.h>

#include "base/random.h"
#include "model/model_bench.h"
#include "moglow/family.h"
#include "nn/threads.h"

namespace marey {
namespace {

/// Few: a base picks regimes and holds feet by thresholds, and once two paths differ in such a
/// choice they are two motions.
constexpr int kFrames = 8;
constexpr uint32_t kWatched = 7;  ///< the sample that appears in every batch

/// The base's tensors are zero until they are fitted: here they move every pose.
TensorFile linearFile() {
  TensorFile file = randomModel(
      {{"pose_dim", 12}, {"tau", 4}, {"steps", 2}, {"hidden", 20}, {"pose_base", "linear"}},
      "linear", moglow::family(), 1);
  for (const char* name : {"weights/base.weight", "weights/base.bias"}) {
    Tensor& tensor = file.tensors.at(name);
    auto values = tensor.toFloats();
    fillNormal({.seed = 8, .stage = RandomStage::Test}, values);
    for (float& v : values) v *= 0.05f;
    tensor = Tensor::fromFloats(tensor.shape, values.data());
  }
  return file;
}

TensorFile fileOf(const std::string& name) {
  if (name == "linear") return linearFile();
  const std::string resources = MAREY_SOURCE_DIR "/resources/";
  return readTensorFile(resources +
                        (name == "demo" ? "demo/demo.marey" : "models/moglow-plus-small.marey"));
}

std::unique_ptr<MotionModel> modelOf(const std::string& name, Execution execution) {
  return moglow::family().load(fileOf(name), name, {.execution = execution});
}

/// Noise around the control that the model was trained on.
void fillControl(const ModelInfo& info, uint32_t sample, uint32_t frame, std::span<float> out) {
  fillNormal({.seed = 3, .sample = sample, .frame = frame, .stage = RandomStage::Test}, out);
  const Standardiser& s = info.standardiser;
  if (s.empty()) return;
  for (size_t i = 0; i < out.size(); ++i) {
    const size_t j = i % s.controlMean.size();
    out[i] = s.controlMean[j] + 0.5f * s.controlStd[j] * out[i];
  }
}

/// What a sample gets depends on its number alone.
std::vector<Matrix> rollout(const MotionModel& model, const std::vector<uint32_t>& samples) {
  const ModelInfo& info = model.info();
  const auto rows = static_cast<long>(samples.size());
  RolloutState state = model.start(static_cast<int>(rows), {});
  std::vector<Matrix> out;
  for (uint32_t t = 0; t < kFrames; ++t) {
    Matrix control(rows, (info.context + 1L + info.lookahead) * info.controlDim),
        latent(rows, info.poseDim);
    for (long b = 0; b < rows; ++b) {
      const uint32_t sample = samples[static_cast<size_t>(b)];
      fillControl(info, sample, t, {control.row(b).data(), static_cast<size_t>(control.cols())});
      fillNormal({.seed = 4, .sample = sample, .frame = t, .stage = RandomStage::Test},
                 {latent.row(b).data(), static_cast<size_t>(latent.cols())});
    }
    out.push_back(model.sampleFrame(state, control, latent));
  }
  return out;
}

std::vector<uint32_t> samplesWith(uint32_t count, size_t place) {
  std::vector<uint32_t> out(count);
  for (uint32_t i = 0; i < count; ++i) out[i] = 100 + i;
  out[place] = kWatched;
  return out;
}

/// Poses that the model itself made, and a control.
std::vector<Sequence> sequencesOf(const MotionModel& model, const std::vector<uint32_t>& samples) {
  const ModelInfo& info = model.info();
  const auto frames = rollout(model, samples);
  std::vector<Sequence> out;
  for (size_t b = 0; b < samples.size(); ++b) {
    const long length = kFrames - static_cast<long>(b % 3);
    Sequence s{Matrix(length, info.poseDim),
               Matrix(length + info.context + info.lookahead, info.controlDim)};
    for (long t = 0; t < length; ++t)
      s.poses.row(t) = frames[static_cast<size_t>(t)].row(static_cast<long>(b));
    fillControl(info, samples[b], 1000,
                {s.controls.data(), static_cast<size_t>(s.controls.size())});
    out.push_back(std::move(s));
  }
  return out;
}

/// Sets the threads and puts one per core back.
class Threads {
 public:
  explicit Threads(int count) { nn::configureThreads(count, true); }
  ~Threads() { nn::configureThreads(0, true); }
};

class Bases : public testing::TestWithParam<std::string> {};

TEST_P(Bases, SamplesAsThePlainPathDoes) {
  const auto fast = modelOf(GetParam(), Execution::Engine),
             plain = modelOf(GetParam(), Execution::Reference);
  const auto samples = samplesWith(37, 5);
  const auto got = rollout(*fast, samples), wanted = rollout(*plain, samples);
  for (size_t t = 0; t < got.size(); ++t) {
    ASSERT_TRUE(wanted[t].allFinite());
    const float size = std::max(1.f, wanted[t].cwiseAbs().maxCoeff());
    EXPECT_LT((got[t] - wanted[t]).cwiseAbs().maxCoeff(), 5e-5f * size) << "frame " << t;
  }
  EXPECT_GT((wanted.back().row(0) - wanted.back().row(1)).cwiseAbs().maxCoeff(), 1e-3f)
      << "samples are all the same";
}

/// From the plain path's past, so that a choice in which the two once differ does not go on: every
/// frame alone has to be the same.
TEST_P(Bases, MakesEveryOfFiftyFramesFromThePlainPathsPast) {
  const auto fast = modelOf(GetParam(), Execution::Engine),
             plain = modelOf(GetParam(), Execution::Reference);
  const ModelInfo& info = plain->info();
  const long window = info.context + 1L + info.lookahead;
  for (const uint32_t sample : {1u, 2u, 3u}) {
    RolloutState led = fast->start(1, {}), leading = plain->start(1, {});
    for (uint32_t t = 0; t < 50; ++t) {
      Matrix control(window, info.controlDim), latent(1, info.poseDim);
      fillControl(info, sample, t, {control.data(), static_cast<size_t>(control.size())});
      fillNormal({.seed = 4, .sample = sample, .frame = t, .stage = RandomStage::Test},
                 {latent.data(), static_cast<size_t>(latent.size())});
      const Matrix row = Eigen::Map<const Matrix>(control.data(), 1, control.size());
      RolloutState fork = led, leadingFork = leading;
      const Matrix wanted = plain->sampleFrame(leadingFork, row, latent);
      ASSERT_TRUE(wanted.allFinite()) << "frame " << t;
      const Matrix got = fast->sampleFrame(fork, row, latent);
      EXPECT_LT((got - wanted).cwiseAbs().maxCoeff(),
                1e-5f * std::max(1.f, wanted.cwiseAbs().maxCoeff()))
          << "sample " << sample << ", frame " << t;
      fast->observe(led, wanted, control);
      plain->observe(leading, wanted, control);
    }
  }
}

TEST_P(Bases, ScoresAsThePlainPathDoes) {
  const auto fast = modelOf(GetParam(), Execution::Engine),
             plain = modelOf(GetParam(), Execution::Reference);
  const auto sequences = sequencesOf(*fast, samplesWith(9, 0));
  const auto got = scoresOf(*fast, sequences), wanted = scoresOf(*plain, sequences);
  for (size_t b = 0; b < got.size(); ++b)
    for (size_t t = 0; t < wanted[b].loglikNats.size(); ++t) {
      const double nats = wanted[b].loglikNats[t];
      EXPECT_NEAR(got[b].loglikNats[t], nats, 1e-5 * std::max(100.0, std::abs(nats)))
          << "sequence " << b << ", frame " << t;
    }
}

TEST_P(Bases, ASampleIsTheSameBitsInAnyBatchAtAnyPlaceForAnyNumberOfThreads) {
  const auto model = modelOf(GetParam(), Execution::Engine);
  const auto alone = rollout(*model, {kWatched});
  for (const int threads : {1, 2, 4}) {
    const Threads set(threads);
    // Around the 32 rows of a block, and past two of them.
    for (const uint32_t batch : {3u, 33u, 70u})
      for (const size_t place : {size_t{0}, size_t{batch} - 1}) {
        const auto together = rollout(*model, samplesWith(batch, place));
        for (size_t t = 0; t < alone.size(); ++t)
          ASSERT_EQ(Matrix(together[t].row(static_cast<long>(place))), alone[t])
              << batch << " samples, place " << place << ", frame " << t << ", threads " << threads;
      }
  }
}

TEST_P(Bases, AScoreIsTheSameBitsInAnyCompanyForAnyNumberOfThreads) {
  const auto model = modelOf(GetParam(), Execution::Engine);
  const auto company = sequencesOf(*model, samplesWith(41, 10));
  const auto alone = scoresOf(*model, {company[10]}).front();
  for (const int threads : {1, 2, 4}) {
    const Threads set(threads);
    const auto among = scoresOf(*model, company)[10];
    EXPECT_EQ(among.latent, alone.latent) << threads << " threads";
    EXPECT_EQ(among.loglikNats, alone.loglikNats) << threads << " threads";
  }
}

INSTANTIATE_TEST_SUITE_P(Engine, Bases, testing::Values("linear", "demo", "plus_small"));

}  // namespace
}  // namespace marey
