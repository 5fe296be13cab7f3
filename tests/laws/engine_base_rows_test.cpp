// The engine's bases alone against the plain ones in double precision, on rows that a model made:
// both compute in double, so that what lies between them is the rounding of what the engine gives
// out.
#include <algorithm>

#include <gtest/gtest.h>

#include "base/random.h"
#include "model/gradient/model_bench.h"
#include "model/gradient/weights.h"
#include "moglow/engine_base.h"
#include "moglow/family.h"
#include "moglow/pose_base.h"
#include "nn/torch/torch.h"

namespace marey::moglow {
namespace {

constexpr long kRows = 300;

/// Half a unit in the last place of a float, and what some hundred operations in double precision
/// leave of numbers up to `size`.
double limitOf(double value, double size) {
  return 0x1p-24 * std::abs(value) + 1024 * 0x1p-53 * size;
}

struct Holder : torch::nn::Module {
  explicit Holder(const std::shared_ptr<PoseBase>& base) { register_module("base", base); }
};

/// A stored model, its base twice, and rows of history, control and pose.
struct Bases {
  TensorFile file;
  ModelInfo info;
  Config config;
  std::shared_ptr<PoseBase> plain;
  std::unique_ptr<const EngineBase> engine;
  torch::Tensor history, control, pose;  ///< float32

  /// Rows are of a body that is `size` times as large as the one that the model makes.
  explicit Bases(const std::string& name, float size = 1.f)
      : file(readTensorFile(MAREY_SOURCE_DIR "/resources/" + name)),
        info(loadCommon(file, name)),
        config(configFromJson(info.config, name)) {
    const BodyFacts body = bodyFacts(info.skeleton.get(), info.standardiser);
    plain = makePoseBase(config, body);
    TensorFile own;
    for (const auto& [key, tensor] : file.tensors)
      if (key.starts_with("weights/base.")) own.tensors[key] = tensor;
    Holder holder(plain);
    loadWeights(holder, own, name);
    plain->to(torch::kFloat64);
    engine = makeEngineBase(config, body, file, "base");
    makeRows(name, size);
  }

  /// Frames of motions that the model makes, each with those before it.
  void makeRows(const std::string& name, float size) {
    const auto model = family().load(file, name, {});
    constexpr int kMotions = 10;
    const long d = info.poseDim, c = info.controlDim, tau = config.tau,
               window = tau + 1 + config.lookahead;
    const auto units = [](const std::vector<float>& v) { return torch::tensor(v); };
    const auto& s = info.standardiser;
    RolloutState state = model->rollout()->start(kMotions, {});
    std::vector<torch::Tensor> frames, controls;
    for (uint32_t t = 0; t < kRows / kMotions + tau; ++t) {
      Matrix control(kMotions, window * c), latent(kMotions, d);
      fillNormal({.seed = 3, .frame = t, .stage = RandomStage::Test},
                 {control.data(), static_cast<size_t>(control.size())});
      fillNormal({.seed = 4, .frame = t, .stage = RandomStage::Test},
                 {latent.data(), static_cast<size_t>(latent.size())});
      auto standard = torch::from_blob(control.data(), {kMotions, window, c}).clone() * 0.5;
      auto metres = standard * units(s.controlStd) + units(s.controlMean);
      std::copy_n(metres.contiguous().data_ptr<float>(), control.size(), control.data());
      Matrix pose = model->rollout()->sampleFrame(state, control, latent);
      frames.push_back((size * torch::from_blob(pose.data(), {kMotions, d}) - units(s.poseMean)) /
                       units(s.poseStd));
      controls.push_back(standard.flatten(1));
    }
    std::vector<torch::Tensor> histories, now, windows;
    for (size_t t = static_cast<size_t>(tau); t < frames.size(); ++t) {
      histories.push_back(
          torch::cat(std::vector<torch::Tensor>(frames.begin() + static_cast<long>(t) - tau,
                                                frames.begin() + static_cast<long>(t)),
                     1));
      now.push_back(frames[t]);
      windows.push_back(controls[t]);
    }
    history = torch::cat(histories).contiguous();
    pose = torch::cat(now).contiguous();
    control = torch::cat(windows).contiguous();
  }

  Foresight truth() const {
    return plain->foresee({history.to(torch::kFloat64), control.to(torch::kFloat64), {}});
  }
  std::vector<RowForesight> foresee(torch::Tensor& features) const {
    std::vector<RowForesight> out;
    engine->foresee(history.size(0), history.data_ptr<float>(), control.data_ptr<float>(),
                    features.data_ptr<float>(), features.size(1), out);
    return out;
  }
};

/// Every value within the limit; `size`: of the largest number that went into a row.
void expectRounded(const torch::Tensor& got, const torch::Tensor& truth, double size,
                   const std::string& what) {
  ASSERT_EQ(got.sizes(), truth.sizes());
  const auto a = got.to(torch::kFloat64).contiguous(), b = truth.contiguous();
  ASSERT_TRUE(b.isfinite().all().item<bool>());
  const double *x = a.data_ptr<double>(), *y = b.data_ptr<double>();
  for (long i = 0; i < a.numel(); ++i)
    ASSERT_LE(std::abs(x[i] - y[i]), limitOf(y[i], size))
        << what << " " << i << ": " << x[i] << " for " << y[i];
}

class BaseRows : public testing::TestWithParam<std::string> {};

TEST_P(BaseRows, AreThoseOfThePlainBaseInDoublePrecision) {
  const torch::NoGradGuard guard;
  const Bases b(GetParam(), 1.1f);
  const Foresight truth = b.truth();
  auto features = torch::empty({b.history.size(0), truth.features.size(1)});
  const auto seen = b.foresee(features);
  expectRounded(features, truth.features, 1e4, "feature");

  const auto wanted = b.plain->toInnovation(b.pose.to(torch::kFloat64), truth);
  auto innovation = torch::empty_like(b.pose);
  std::vector<double> logDet(seen.size());
  b.engine->toInnovation(seen, b.pose.data_ptr<float>(), innovation.data_ptr<float>(),
                         logDet.data());
  // A centimetre over the smallest scale of the density is as large as residuals become.
  const double size = 1e3 * wanted.value.abs().max().item<double>();
  expectRounded(innovation, wanted.value, size, "innovation");
  for (size_t i = 0; i < logDet.size(); ++i)
    ASSERT_NEAR(logDet[i], wanted.logDet[static_cast<int64_t>(i)].item<double>(), 1e-8) << i;

  auto latent = torch::empty_like(b.pose), pose = torch::empty_like(b.pose);
  fillNormal({.seed = 5, .stage = RandomStage::Test},
             {latent.data_ptr<float>(), static_cast<size_t>(latent.numel())});
  b.engine->toPose(seen, latent.data_ptr<float>(), pose.data_ptr<float>());
  expectRounded(pose, b.plain->toPose(latent.to(torch::kFloat64), truth), 1e4, "pose");
}

TEST_P(BaseRows, PosesAndInnovationsAreInverses) {
  const Bases b(GetParam());
  auto features = torch::empty({b.history.size(0), b.truth().features.size(1)});
  const auto seen = b.foresee(features);
  auto latent = torch::empty_like(b.pose), pose = torch::empty_like(b.pose),
       back = torch::empty_like(b.pose), again = torch::empty_like(b.pose);
  fillNormal({.seed = 5, .stage = RandomStage::Test},
             {latent.data_ptr<float>(), static_cast<size_t>(latent.numel())});
  std::vector<double> logDet(seen.size());
  b.engine->toPose(seen, latent.data_ptr<float>(), pose.data_ptr<float>());
  b.engine->toInnovation(seen, pose.data_ptr<float>(), back.data_ptr<float>(), logDet.data());
  b.engine->toPose(seen, back.data_ptr<float>(), again.data_ptr<float>());
  // Poses pass as floats: the way there and back is that of their rounding.
  EXPECT_LT((again - pose).abs().max().item<float>(), 1e-5f);
}

TEST_P(BaseRows, ARowIsTheSameBitsAlone) {
  const Bases b(GetParam());
  const long width = b.truth().features.size(1);
  auto together = torch::empty({b.history.size(0), width}), alone = torch::empty({1, width});
  b.foresee(together);
  std::vector<RowForesight> seen;
  for (const long row : {0L, 1L, 7L, kRows - 1}) {
    b.engine->foresee(1, b.history[row].data_ptr<float>(), b.control[row].data_ptr<float>(),
                      alone.data_ptr<float>(), width, seen);
    EXPECT_TRUE(torch::equal(alone[0], together[row])) << row;
  }
}

INSTANTIATE_TEST_SUITE_P(Engine, BaseRows,
                         testing::Values("demo/demo.marey", "models/moglow-plus-small.marey"));

}  // namespace
}  // namespace marey::moglow
