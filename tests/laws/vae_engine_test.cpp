// The autoencoder's engine against its plain libtorch path, on random shapes; and what it promises
// beyond that: the same bits in any company and for any number of threads.
#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "laws/engine_support.h"
#include "vae/family.h"
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/job.h"
#include "base/random.h"
#include "model/gradient/model_bench.h"
#include "nn/torch/threads.h"

namespace marey {
namespace {

const std::string kNetwork = "weights/";

/// A whole number from `low` to `high`: number `index` of a stream.
int choose(uint32_t stream, uint32_t index, int low, int high) {
  const double u = uniformAt({.seed = 6, .sample = stream, .stage = RandomStage::Test}, index);
  return low + static_cast<int>(u * (high - low + 1));
}

/// Everything that the family lets one choose of a model's shape.
Json randomConfig(uint32_t number) {
  return {{"pose_dim", choose(number, 0, 1, 40)},
          {"control_dim", choose(number, 1, 1, 4)},
          {"hidden", choose(number, 2, 1, 70)},
          {"layers", choose(number, 3, 1, 3)},
          {"latent", choose(number, 4, 1, 5)},
          {"decoder", number % 2 ? "gaussian" : "deterministic"}};
}

TensorFile fileOf(const Json& config, uint64_t seed = 1) {
  TensorFile out = randomModel(config, "random", vae::family(), seed);
  const auto pose = config.value("pose_dim", 63), control = config.value("control_dim", 3);
  const auto store = [&](const std::string& name, int size, uint32_t stream, float low) {
    std::vector<float> values;
    for (int i = 0; i < size; ++i)
      values.push_back(low + static_cast<float>(uniformAt(
                                 {.seed = seed, .sample = stream, .stage = RandomStage::Test},
                                 static_cast<uint32_t>(i))));
    out.tensors["standardiser/" + name] = Tensor::fromFloats({size}, values.data());
  };
  store("pose_mean", pose, 1, -0.5f);
  store("pose_std", pose, 2, 0.1f);
  store("control_mean", control, 3, -0.5f);
  store("control_std", control, 4, 0.1f);
  return out;
}

std::unique_ptr<MotionModel> modelOf(const TensorFile& file, const LoadOptions& options = {}) {
  return vae::family().load(file, "random", options);
}

Matrix noise(uint32_t sample, uint32_t what, long rows, long columns) {
  Matrix out(rows, columns);
  fillNormal({.seed = 3, .sample = sample, .frame = what, .stage = RandomStage::Test},
             {out.data(), static_cast<size_t>(out.size())});
  return out;
}

/// What a clip gets depends on its number alone.
ClipRequest clipOf(const ModelInfo& info, uint32_t number, long frames) {
  const bool perClip = info.latent.per == LatentSpec::Per::Clip;
  return {{},
          noise(number, 1, frames, info.controlDim),
          noise(number, 2, perClip ? 1 : frames, info.latent.width)};
}

std::vector<ClipRequest> clipsOf(const ModelInfo& info, uint32_t number) {
  std::vector<ClipRequest> out;
  const int count = choose(number, 10, 1, 40);
  for (int i = 0; i < count; ++i)
    out.push_back(clipOf(info, 100 + static_cast<uint32_t>(i),
                         choose(number, 20 + static_cast<uint32_t>(i), 1, 60)));
  return out;
}

std::vector<Matrix> posesOf(const MotionModel& model, std::span<const ClipRequest> requests) {
  return model.wholeClip()->generate(requests, [] {});
}

/// Sets the threads and puts one per core back.
class Threads {
 public:
  explicit Threads(int count) { nn::configureThreads(count, true); }
  ~Threads() { nn::configureThreads(0, true); }
};

void expectTrue(const Matrix& got, const Matrix& truth, const std::vector<Matrix>& draws,
                const std::string& what) {
  ASSERT_EQ(got.rows(), truth.rows());
  ASSERT_TRUE(got.allFinite()) << what;
  const Eigen::VectorXf off = (got - truth).cwiseAbs().rowwise().maxCoeff(),
                        limits = rowLimits(truth, draws);
  for (long t = 0; t < off.size(); ++t) EXPECT_LE(off(t), limits(t)) << what << " frame " << t;
  EXPECT_LT(limits.maxCoeff(), 1e-2f * std::max(1.f, truth.cwiseAbs().maxCoeff()))
      << "limits that everything keeps: " << what;
}

class RandomVae : public testing::TestWithParam<uint32_t> {};

TEST_P(RandomVae, MakesWhatThePlainPathMakesForAnyNumberOfThreads) {
  const Json config = randomConfig(GetParam());
  const TensorFile file = fileOf(config, GetParam());
  const auto fast = modelOf(file);
  const auto clips = clipsOf(fast->info(), GetParam());
  const auto compared = std::span(clips).first(std::min<size_t>(6, clips.size()));
  nn::configureThreads(1, true);
  const Truth truth(file, vae::family(), kNetwork);
  const auto wanted = posesOf(truth.exact(), compared);
  std::vector<std::vector<Matrix>> draws(compared.size());
  for (uint32_t draw = 1; draw <= Truth::kDraws; ++draw) {
    auto made = posesOf(truth.changed(draw), compared);
    for (size_t i = 0; i < made.size(); ++i) draws[i].push_back(std::move(made[i]));
  }
  const auto plain = posesOf(*modelOf(file, {.execution = Execution::Reference}), compared);
  for (size_t i = 0; i < wanted.size(); ++i)
    expectTrue(plain[i], wanted[i], draws[i], "plain " + config.dump());
  std::vector<Matrix> before;
  for (const int threads : {1, 2, 4}) {
    const Threads set(threads);
    const auto got = posesOf(*fast, clips);
    ASSERT_EQ(got.size(), clips.size());
    for (size_t i = 0; i < wanted.size(); ++i)
      expectTrue(got[i], wanted[i], draws[i], config.dump());
    if (!before.empty()) {
      EXPECT_EQ(got, before) << threads << " threads: " << config.dump();
    }
    before = got;
  }
}

INSTANTIATE_TEST_SUITE_P(Vae, RandomVae, testing::Range(0u, 10u));

const TensorFile& wideFile(const std::string& decoder) {
  static const TensorFile plain = fileOf({{"hidden", 75}, {"decoder", "deterministic"}}),
                          noisy = fileOf({{"hidden", 75}, {"decoder", "gaussian"}});
  return decoder == "gaussian" ? noisy : plain;
}

class Decoders : public testing::TestWithParam<std::string> {};

TEST_P(Decoders, AClipIsTheSameBitsInAnyCompanyAtAnyPlace) {
  const auto model = modelOf(wideFile(GetParam()));
  const ClipRequest one = clipOf(model->info(), 7, 33);
  const Matrix alone = posesOf(*model, {&one, 1}).front();
  for (const long batch : {2L, 11L, 26L})
    for (const long place : {0L, batch / 2, batch - 1}) {
      std::vector<ClipRequest> company;
      for (long i = 0; i < batch; ++i)
        company.push_back(
            i == place ? one : clipOf(model->info(), 50 + static_cast<uint32_t>(i), 1 + 2 * i));
      EXPECT_EQ(posesOf(*model, company)[static_cast<size_t>(place)], alone)
          << batch << " clips, place " << place;
    }
}

/// More frames than are made together.
TEST_P(Decoders, AClipIsTheSameBitsAmongSoManyThatTheyGoInGroups) {
  const auto model = modelOf(wideFile(GetParam()));
  std::vector<ClipRequest> many;
  for (uint32_t i = 0; i < 180; ++i) many.push_back(clipOf(model->info(), i, 100 + i % 7));
  const auto together = posesOf(*model, many);
  for (const size_t i : {size_t{0}, size_t{90}, size_t{179}})
    EXPECT_EQ(posesOf(*model, {&many[i], 1}).front(), together[i]) << i;
}

TEST_P(Decoders, EveryFrameHangsOnAllOfTheControlAndOnTheLatent) {
  const auto model = modelOf(wideFile(GetParam()));
  const ClipRequest one = clipOf(model->info(), 7, 12);
  ClipRequest later = one, other = one;
  later.controls.row(11) *= 2.f;
  other.latents(0, 1) += 1.f;
  const Matrix poses = posesOf(*model, {&one, 1}).front();
  EXPECT_NE(Matrix(posesOf(*model, {&later, 1}).front().row(0)), Matrix(poses.row(0)));
  const Matrix changed = posesOf(*model, {&other, 1}).front();
  for (const long t : {0L, 11L}) EXPECT_NE(Matrix(changed.row(t)), Matrix(poses.row(t)));
}

TEST_P(Decoders, SavesTheTensorsItWasLoadedFrom) {
  const TensorFile& file = wideFile(GetParam());
  for (const Execution execution : {Execution::Engine, Execution::Reference}) {
    const auto model = modelOf(file, {.execution = execution});
    const TensorFile saved = model->save();
    ASSERT_EQ(saved.tensors.size(), file.tensors.size());
    for (const auto& [name, tensor] : file.tensors) {
      EXPECT_EQ(saved.tensors.at(name).bytes, tensor.bytes) << name;
      EXPECT_EQ(saved.tensors.at(name).shape, tensor.shape) << name;
    }
  }
  EXPECT_THROW(modelOf(file, {.execution = Execution::Exact})->save(), InputError);
}

TEST_P(Decoders, TakesExactlyTheTensorsOfTheNetwork) {
  const TensorFile& file = wideFile(GetParam());
  for (const Execution execution : {Execution::Engine, Execution::Reference}) {
    for (const auto& [name, tensor] : file.tensors) {
      if (!name.starts_with(kNetwork)) continue;
      TensorFile changed = file;
      changed.tensors.erase(name);
      EXPECT_THROW(modelOf(changed, {.execution = execution}), InputError) << name;
      changed = file;
      changed.tensors[name].shape.push_back(1);
      EXPECT_THROW(modelOf(changed, {.execution = execution}), InputError) << name;
    }
    TensorFile more = file;
    more.tensors["weights/more"] = file.tensors.begin()->second;
    EXPECT_THROW(modelOf(more, {.execution = execution}), InputError);
  }
}

TEST_P(Decoders, RoundedWeightsComeClose) {
  const TensorFile& file = wideFile(GetParam());
  const ClipRequest one = clipOf(modelOf(file)->info(), 7, 20);
  const Matrix full = posesOf(*modelOf(file), {&one, 1}).front(),
               rounded = posesOf(*modelOf(file, {.weights = WeightPrecision::BFloat16}), {&one, 1})
                             .front();
  const float difference = (full - rounded).cwiseAbs().maxCoeff();
  EXPECT_LT(difference, 0.05f);
  EXPECT_GT(difference, 1e-7f) << "nothing was rounded";
}

TEST_P(Decoders, RefusesShapesThatDoNotFit) {
  for (const Execution execution : {Execution::Engine, Execution::Reference}) {
    const auto model = modelOf(wideFile(GetParam()), {.execution = execution});
    const ClipRequest good = clipOf(model->info(), 1, 5);
    const auto refuses = [&](const std::function<void(ClipRequest&)>& change) {
      ClipRequest bad = good;
      change(bad);
      EXPECT_THROW(posesOf(*model, {&bad, 1}), InputError);
    };
    EXPECT_NO_THROW(posesOf(*model, {&good, 1}));
    refuses([](ClipRequest& r) { r.controls = Matrix(0, 3); });
    refuses([](ClipRequest& r) { r.controls = Matrix::Zero(5, 4); });
    refuses([](ClipRequest& r) { r.latents = Matrix::Zero(2, r.latents.cols()); });
    refuses([](ClipRequest& r) { r.latents = Matrix::Zero(r.latents.rows(), 1); });
    refuses([](ClipRequest& r) { r.history = Matrix::Zero(1, 63); });
  }
}

TEST_P(Decoders, AStoppedGenerationEndsWithinAFewFrames) {
  const auto model = modelOf(wideFile(GetParam()));
  const ClipRequest one = clipOf(model->info(), 1, 400);
  int calls = 0;
  EXPECT_THROW(model->wholeClip()->generate({&one, 1},
                                            [&] {
                                              if (++calls == 5) throw CancelledError();
                                            }),
               CancelledError);
  EXPECT_EQ(calls, 5);
  calls = 0;
  model->wholeClip()->generate({&one, 1}, [&] { ++calls; });
  // Two layers, both ways: at least once for every eight frames of each.
  EXPECT_GE(calls, 2 * 2 * 400 / 8);
}

INSTANTIATE_TEST_SUITE_P(Vae, Decoders, testing::Values("deterministic", "gaussian"));

TEST(VaeModel, SaysThatItIsNoRolloutAndHasNoDensity) {
  for (const char* decoder : {"deterministic", "gaussian"}) {
    const auto model = modelOf(wideFile(decoder));
    EXPECT_FALSE(model->info().causal);
    EXPECT_FALSE(model->info().deterministic());
    EXPECT_EQ(model->info().context, 0);
    EXPECT_EQ(model->info().density, DensityKind::None);
    EXPECT_EQ(model->rollout(), nullptr);
    EXPECT_EQ(model->density(), nullptr);
    EXPECT_THROW(requireRollout(*model), InputError);
    EXPECT_THROW(requireDensity(*model), InputError);
  }
  const LatentSpec plain = modelOf(wideFile("deterministic"))->info().latent,
                   noisy = modelOf(wideFile("gaussian"))->info().latent;
  EXPECT_EQ(plain, (LatentSpec{.width = 2, .per = LatentSpec::Per::Clip}));
  EXPECT_EQ(noisy, (LatentSpec{.width = 2 + 63, .per = LatentSpec::Per::Frame}));
}

/// Noise of the learnt size is added to each channel, in units of the motion.
TEST(VaeModel, AGaussianDecoderAddsTheNoiseOfEveryFrame) {
  TensorFile file = wideFile("gaussian");
  std::vector<float> logVariance(63);
  for (size_t j = 0; j < 63; ++j) logVariance[j] = -2.f + 0.05f * static_cast<float>(j);
  file.tensors["weights/log_variance"] = Tensor::fromFloats({63}, logVariance.data());
  const auto model = modelOf(file);
  const auto& std = model->info().standardiser.poseStd;
  const ClipRequest noisy = clipOf(model->info(), 3, 10);
  ClipRequest calm = noisy;
  calm.latents.rightCols(63).setZero();
  calm.latents.bottomLeftCorner(9, 2).setZero();  // of the first frame alone
  const Matrix with = posesOf(*model, {&noisy, 1}).front(),
               without = posesOf(*model, {&calm, 1}).front();
  for (long t = 0; t < 10; ++t)
    for (long j = 0; j < 63; ++j) {
      const auto at = static_cast<size_t>(j);
      const double expected = std::exp(0.5 * logVariance[at]) * std[at] * noisy.latents(t, 2 + j);
      // Four roundings of values below 4 and of the two results.
      EXPECT_NEAR(with(t, j) - without(t, j), expected,
                  8.0 * 0x1p-24 * (4.0 + std::abs(with(t, j)) + std::abs(without(t, j))))
          << t << " " << j;
    }
}

}  // namespace
}  // namespace marey
