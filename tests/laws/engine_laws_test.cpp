// The engine against the plain libtorch path, on random shapes; and what it promises beyond that:
// the same bits for any batch, position in it and number of threads.
#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <string>

#include "laws/engine_support.h"
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/job.h"
#include "base/random.h"
#include "model/gradient/model_bench.h"
#include "moglow/family.h"
#include "nn/torch/threads.h"

namespace marey {
namespace {

constexpr int kFrames = 50;

/// A whole number from `low` to `high`: number `index` of a stream.
int choose(uint32_t stream, uint32_t index, int low, int high) {
  const double u = uniformAt({.seed = 5, .sample = stream, .stage = RandomStage::Test}, index);
  return low + static_cast<int>(u * (high - low + 1));
}

/// Everything that the family lets one choose.
Json randomConfig(uint32_t number) {
  const char* cells[] = {"lstm", "gru", "feedforward"};
  Json out = {{"cell", cells[number % 3]},
              {"pose_dim", choose(number, 0, 2, 40)},
              {"control_dim", choose(number, 1, 1, 4)},
              {"tau", choose(number, 2, 1, 6)},
              {"lookahead", choose(number, 3, 0, 4)},
              {"steps", choose(number, 4, 1, 5)},
              {"hidden", choose(number, 5, 1, 70)},
              {"lstm_layers", choose(number, 6, 1, 3)},
              {"lu", choose(number, 7, 0, 1) == 1}};
  if (number % 2 == 1) {
    out["base"] = "student_t";
    out["df"] = 3.0 + choose(number, 8, 0, 40);
  }
  return out;
}

std::unique_ptr<MotionModel> modelOf(const TensorFile& file, const LoadOptions& options = {}) {
  return moglow::family().load(file, "random", options);
}

TensorFile fileOf(const Json& config, uint64_t seed = 1) {
  return randomModel(config, "random", moglow::family(), seed);
}

Matrix noise(uint32_t sample, uint32_t frame, long rows, long columns) {
  Matrix out(rows, columns);
  fillNormal({.seed = 3, .sample = sample, .frame = frame, .stage = RandomStage::Test},
             {out.data(), static_cast<size_t>(out.size())});
  return out;
}

long windowWidth(const ModelInfo& info) {
  return static_cast<long>(info.context + 1 + info.lookahead) * info.controlDim;
}

/// Frames of some samples as one batch; what a sample gets depends on its number alone.
std::vector<Matrix> rollout(const MotionModel& model, const std::vector<uint32_t>& samples,
                            int frames = kFrames) {
  const ModelInfo& info = model.info();
  const auto rows = static_cast<long>(samples.size());
  const auto rowsOf = [&](uint32_t what, int frame, long columns) {
    Matrix out(rows, columns);
    for (long b = 0; b < rows; ++b)
      out.row(b) = noise(3 * samples[static_cast<size_t>(b)] + what, static_cast<uint32_t>(frame),
                         1, columns);
    return out;
  };
  RolloutState state =
      model.rollout()->start(static_cast<int>(rows), rowsOf(0, 1000, info.context * info.poseDim));
  std::vector<Matrix> out;
  for (int t = 0; t < frames; ++t)
    out.push_back(model.rollout()->sampleFrame(state, rowsOf(1, t, windowWidth(info)),
                                               rowsOf(2, t, info.poseDim)));
  return out;
}

/// What a truth's draws make of the same samples, [frame][draw].
std::vector<std::vector<Matrix>> drawsOf(const Truth& truth, const std::vector<uint32_t>& samples,
                                         int frames = kFrames) {
  std::vector<std::vector<Matrix>> out(static_cast<size_t>(frames));
  for (uint32_t draw = 1; draw <= Truth::kDraws; ++draw) {
    auto rolled = rollout(truth.changed(draw), samples, frames);
    for (size_t t = 0; t < out.size(); ++t) out[t].push_back(std::move(rolled[t]));
  }
  return out;
}

/// So many samples or sequences are compared with the truth: it is slow.
constexpr size_t kCompared = 6;

/// Every row that has a truth is within the limits of rounding.
void expectTrue(const Matrix& got, const Matrix& truth, const std::vector<Matrix>& draws,
                const std::string& what) {
  ASSERT_GE(got.rows(), truth.rows());
  ASSERT_TRUE(got.allFinite()) << what;
  const Eigen::VectorXf off = (got.topRows(truth.rows()) - truth).cwiseAbs().rowwise().maxCoeff(),
                        limits = rowLimits(truth, draws);
  for (long b = 0; b < off.size(); ++b) EXPECT_LE(off(b), limits(b)) << what << " row " << b;
  EXPECT_LT(limits.maxCoeff(), 1e-2f * std::max(1.f, truth.cwiseAbs().maxCoeff()))
      << "limits that everything keeps: " << what;
}

Sequence sequenceOf(const ModelInfo& info, uint32_t sample, long frames) {
  return {noise(sample, 1, frames, info.poseDim),
          noise(sample, 2, frames + info.context + info.lookahead, info.controlDim)};
}

void expectNear(const Matrix& a, const Matrix& b, double tolerance, const std::string& what) {
  ASSERT_EQ(a.rows(), b.rows());
  ASSERT_TRUE(a.allFinite()) << what;
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), tolerance) << what;
}

/// Sets the threads and puts one per core back.
class Threads {
 public:
  explicit Threads(int count) { nn::configureThreads(count, true); }
  ~Threads() { nn::configureThreads(0, true); }
};

std::vector<uint32_t> firstSamples(uint32_t count) {
  std::vector<uint32_t> out(count);
  for (uint32_t i = 0; i < count; ++i) out[i] = i;
  return out;
}

class RandomModel : public testing::TestWithParam<uint32_t> {};

TEST_P(RandomModel, SamplesAsThePlainPathDoesForAnyNumberOfThreads) {
  const uint32_t number = GetParam();
  const Json config = randomConfig(number);
  const TensorFile file = fileOf(config, number);
  const auto fast = modelOf(file);
  const Truth truth(file);
  const auto samples = firstSamples(static_cast<uint32_t>(choose(number, 9, 1, 130)));
  nn::configureThreads(1, true);
  const auto compared = firstSamples(static_cast<uint32_t>(std::min(kCompared, samples.size())));
  const auto wanted = rollout(truth.exact(), compared);
  const auto draws = drawsOf(truth, compared);
  std::vector<Matrix> before;
  for (const int threads : {1, 2, 4}) {
    const Threads set(threads);
    const auto got = rollout(*fast, samples);
    double size = 0.0;
    for (size_t t = 0; t < got.size(); ++t) {
      expectTrue(got[t], wanted[t], draws[t], config.dump() + " frame " + std::to_string(t));
      size = std::max<double>(size, wanted[t].cwiseAbs().maxCoeff());
    }
    EXPECT_GT(size, 0.1) << "nothing was sampled";
    if (!before.empty()) {
      EXPECT_EQ(got, before) << threads << " threads: " << config.dump();
    }
    before = got;
  }
}

TEST_P(RandomModel, ScoresAsThePlainPathDoesForAnyNumberOfThreads) {
  const uint32_t number = GetParam();
  const Json config = randomConfig(number);
  const TensorFile file = fileOf(config, number);
  const auto fast = modelOf(file);
  const Truth truth(file);
  std::vector<Sequence> sequences;
  const int count = choose(number, 10, 1, 40);
  for (int i = 0; i < count; ++i)
    sequences.push_back(sequenceOf(fast->info(), 100 + static_cast<uint32_t>(i),
                                   choose(number, 20 + static_cast<uint32_t>(i), 1, kFrames)));
  nn::configureThreads(1, true);
  const std::vector<Sequence> compared(
      sequences.begin(),
      sequences.begin() + static_cast<long>(std::min(kCompared, sequences.size())));
  const auto wanted = scoresOf(truth.exact(), compared);
  const auto draws = scoreDrawsOf(truth, compared);
  std::vector<SequenceScore> before;
  for (const int threads : {1, 2, 4}) {
    const Threads set(threads);
    const auto got = scoresOf(*fast, sequences);
    ASSERT_EQ(got.size(), sequences.size());
    for (size_t i = 0; i < before.size(); ++i) {
      EXPECT_EQ(got[i].latent, before[i].latent) << config.dump();
      EXPECT_EQ(got[i].loglikNats, before[i].loglikNats) << config.dump();
    }
    before = got;
    for (size_t i = 0; i < wanted.size(); ++i) {
      std::vector<Matrix> latents;
      for (const auto& draw : draws) latents.push_back(draw[i].latent);
      expectTrue(got[i].latent, wanted[i].latent, latents, config.dump());
      ASSERT_EQ(got[i].loglikNats.size(), wanted[i].loglikNats.size());
      for (size_t t = 0; t < got[i].loglikNats.size(); ++t)
        EXPECT_LE(std::abs(got[i].loglikNats[t] - wanted[i].loglikNats[t]),
                  natsLimit(wanted, draws, i, t))
            << config.dump();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Engine, RandomModel, testing::Range(0u, 18u));

// ---- The same bits

/// Wide enough for several panels, deep enough for every part.
const TensorFile& wideFile(const std::string& cell) {
  static std::map<std::string, TensorFile> files;
  if (!files.contains(cell))
    files[cell] = fileOf({{"cell", cell},
                          {"tau", 3},
                          {"lookahead", 1},
                          {"steps", 3},
                          {"hidden", 75},
                          {"lstm_layers", 2}});
  return files.at(cell);
}

class Cells : public testing::TestWithParam<std::string> {};

TEST_P(Cells, ASampleIsTheSameBitsInAnyBatchAtAnyPlace) {
  const auto model = modelOf(wideFile(GetParam()));
  const auto alone = rollout(*model, {7}, 12);
  for (const uint32_t batch : {2u, 5u, 11u, 12u, 13u, 37u, 120u}) {
    auto samples = firstSamples(batch);
    // First, last and in the middle.
    for (const size_t place : {size_t{0}, samples.size() - 1, samples.size() / 2}) {
      auto with = samples;
      with[place] = 7;
      const auto together = rollout(*model, with, 12);
      for (size_t t = 0; t < alone.size(); ++t)
        EXPECT_EQ(Matrix(together[t].row(static_cast<long>(place))), alone[t])
            << batch << " samples, place " << place << ", frame " << t;
    }
  }
}

TEST_P(Cells, AScoreIsTheSameBitsInAnyCompanyAndInPieces) {
  const auto model = modelOf(wideFile(GetParam()));
  const Sequence one = sequenceOf(model->info(), 1, 40);
  const SequenceScore alone = scoresOf(*model, {one}).front();
  std::vector<Sequence> company;
  for (uint32_t i = 0; i < 31; ++i)
    company.push_back(i == 9 ? one
                             : sequenceOf(model->info(), 10 + i, 1 + 3 * static_cast<long>(i)));
  const SequenceScore among = scoresOf(*model, company)[9];
  EXPECT_EQ(among.latent, alone.latent);
  EXPECT_EQ(among.loglikNats, alone.loglikNats);
  RolloutState state = model->rollout()->start(1, {});
  const long context = model->info().context, ahead = model->info().lookahead;
  for (const auto& [begin, count] : {std::pair{0L, 1L}, {1L, 17L}, {18L, 22L}}) {
    const auto piece =
        model->density()->observe(state, one.poses.middleRows(begin, count),
                                  one.controls.middleRows(begin, context + count + ahead));
    EXPECT_EQ(piece.latent, Matrix(alone.latent.middleRows(begin, count)));
  }
}

TEST_P(Cells, WhatWasSampledHasTheLatentsThatMadeIt) {
  const auto model = modelOf(wideFile(GetParam()));
  const ModelInfo& info = model->info();
  const Matrix controls = noise(1, 1, 20 + info.context + info.lookahead, info.controlDim);
  Matrix poses(20, info.poseDim), latents(20, info.poseDim);
  RolloutState state = model->rollout()->start(1, {}), scored = model->rollout()->start(1, {});
  for (long t = 0; t < 20; ++t) {
    const Matrix window =
        Eigen::Map<const Eigen::RowVectorXf>(controls.row(t).data(), windowWidth(info));
    latents.row(t) = noise(2, static_cast<uint32_t>(t), 1, info.poseDim);
    poses.row(t) = model->rollout()->sampleFrame(state, window, latents.row(t));
  }
  const auto score = model->density()->observe(scored, poses, controls);
  expectNear(score.latent, latents, 1e-4, GetParam());
  // Both stand at the same place now.
  const Matrix window = noise(4, 4, 1, windowWidth(info)), z = noise(5, 5, 1, info.poseDim);
  expectNear(model->rollout()->sampleFrame(scored, window, z),
             model->rollout()->sampleFrame(state, window, z), 1e-4, GetParam());
}

TEST_P(Cells, ACopiedStateGoesItsOwnWay) {
  const auto model = modelOf(wideFile(GetParam()));
  const ModelInfo& info = model->info();
  const auto frame = [&](RolloutState& state, uint32_t which) {
    return model->rollout()->sampleFrame(state, noise(which, 0, 2, windowWidth(info)),
                                         noise(which, 1, 2, info.poseDim));
  };
  RolloutState state = model->rollout()->start(2, {});
  frame(state, 1);
  RolloutState fork = state;
  frame(fork, 9);
  const Matrix after = frame(state, 2);
  RolloutState fresh = model->rollout()->start(2, {});
  frame(fresh, 1);
  EXPECT_EQ(frame(fresh, 2), after);
  EXPECT_NE(frame(fork, 3), frame(state, 3));
}

INSTANTIATE_TEST_SUITE_P(Engine, Cells, testing::Values("lstm", "gru", "feedforward"));

// ---- Models as files

TEST(EngineModel, SavesTheTensorsItWasLoadedFrom) {
  for (const char* cell : {"lstm", "gru", "feedforward"}) {
    const TensorFile& file = wideFile(cell);
    const TensorFile saved = modelOf(file)->save();
    ASSERT_EQ(saved.tensors.size(), file.tensors.size());
    for (const auto& [name, tensor] : file.tensors) {
      EXPECT_EQ(saved.tensors.at(name).bytes, tensor.bytes) << name;
      EXPECT_EQ(saved.tensors.at(name).shape, tensor.shape) << name;
    }
  }
}

TEST(EngineModel, KnowsEveryTensorThatTheNetworkHas) {
  // Both loaders are strict: each takes exactly the tensors that it expects.
  for (uint32_t number = 0; number < 12; ++number) {
    TensorFile file = fileOf(randomConfig(number), number);
    for (const Execution execution : {Execution::Engine, Execution::Reference}) {
      EXPECT_NO_THROW(modelOf(file, {.execution = execution}));
      for (const auto& [name, tensor] : fileOf(randomConfig(number), number).tensors) {
        TensorFile without = file;
        without.tensors.erase(name);
        EXPECT_THROW(modelOf(without, {.execution = execution}), InputError) << name;
      }
      TensorFile more = file;
      more.tensors["weights/base.more"] = file.tensors.begin()->second;
      EXPECT_THROW(modelOf(more, {.execution = execution}), InputError);
    }
  }
}

TEST(EngineModel, RefusesASingularLinearLayer) {
  TensorFile file = fileOf({{"steps", 1}, {"hidden", 4}, {"lu", false}});
  const std::vector<float> zeros(63 * 63, 0.f);
  file.tensors["weights/flow.step0_linear.weight"] = Tensor::fromFloats({63, 63}, zeros.data());
  EXPECT_THROW(modelOf(file), InputError);
}

TEST(EngineModel, RoundedWeightsComeCloseAndAreNotSaved) {
  const TensorFile& file = wideFile("lstm");
  const auto full = modelOf(file), rounded = modelOf(file, {.weights = WeightPrecision::BFloat16});
  const auto wanted = rollout(*full, firstSamples(3), 10),
             got = rollout(*rounded, firstSamples(3), 10);
  const float difference = (wanted.back() - got.back()).cwiseAbs().maxCoeff();
  EXPECT_LT(difference, 0.1f);
  EXPECT_GT(difference, 1e-6f) << "nothing was rounded";
  EXPECT_THROW(rounded->save(), InputError);
  // Rounded once, the weights are those of a model of its own.
  TensorFile narrow = file;
  for (auto& [name, tensor] : narrow.tensors) {
    if (name.find("weight_") == std::string::npos && name.find("out_weight") == std::string::npos)
      continue;
    auto values = tensor.toFloats();
    for (float& v : values) {
      const auto bits = std::bit_cast<uint32_t>(v);
      v = std::bit_cast<float>((bits + 0x7FFFu + ((bits >> 16) & 1u)) & 0xFFFF0000u);
    }
    tensor = Tensor::fromFloats(tensor.shape, values.data());
  }
  const Truth truth(narrow);
  expectTrue(got.back(), rollout(truth.exact(), firstSamples(3), 10).back(),
             drawsOf(truth, firstSamples(3), 10).back(), "rounded weights");
}

TEST(EngineModel, RefusesShapesThatDoNotFit) {
  const auto model = modelOf(wideFile("lstm"));
  const ModelInfo& info = model->info();
  RolloutState state = model->rollout()->start(2, {});
  EXPECT_THROW(model->rollout()->start(2, Matrix::Zero(2, 5)), InputError);
  EXPECT_THROW(model->rollout()->sampleFrame(state, Matrix::Zero(2, windowWidth(info) + 1),
                                             Matrix::Zero(2, info.poseDim)),
               InputError);
  EXPECT_THROW(model->rollout()->sampleFrame(state, Matrix::Zero(2, windowWidth(info)),
                                             Matrix::Zero(1, info.poseDim)),
               InputError);
  EXPECT_THROW(model->density()->observe(state, Matrix::Zero(4, info.poseDim), Matrix::Zero(8, 3)),
               InputError);
}

TEST(EngineModel, AStoppedScoringEndsWithinAFewFrames) {
  const auto model = modelOf(wideFile("lstm"));
  const Sequence sequence = sequenceOf(model->info(), 1, 400);
  RolloutState state = model->rollout()->start(1, {});
  const ObservedSequence observed{&sequence.poses, &sequence.controls};
  int calls = 0;
  EXPECT_THROW(model->density()->observeMany({&state, 1}, {&observed, 1},
                                             [&] {
                                               if (++calls == 5) throw CancelledError();
                                             }),
               CancelledError);
  EXPECT_EQ(calls, 5);
  calls = 0;
  state = model->rollout()->start(1, {});
  model->density()->observeMany({&state, 1}, {&observed, 1}, [&] { ++calls; });
  // Three steps of two layers: at least once for every eight frames of each.
  EXPECT_GE(calls, 3 * 2 * 400 / 8);
}

}  // namespace
}  // namespace marey
