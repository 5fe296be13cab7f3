// The yardstick, observation noise, and what is said of a likelihood.
#include "model/likelihood.h"

#include <cmath>
#include <numbers>

#include "tiny_run.h"
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/random.h"
#include "model/linear_gaussian.h"

namespace marey {
namespace {

/// One value per pose: x_t = 0.5 x_{t-1} + 0.3 c_t + noise of 0.02, control white.
FeatureSequence wave(int frames, uint64_t seed) {
  FeatureSequence out{.name = "wave", .pose = Matrix(frames, 1), .control = Matrix(frames, 1)};
  float x = 0.f;
  for (int t = 0; t < frames; ++t) {
    const auto c = static_cast<float>(normalAt(
        {.seed = seed, .sample = 1, .stage = RandomStage::Test}, static_cast<uint32_t>(t)));
    const double e = normalAt({.seed = seed, .stage = RandomStage::Test}, static_cast<uint32_t>(t));
    x = 0.5f * x + 0.3f * c + 0.02f * static_cast<float>(e);
    out.pose(t, 0) = x;
    out.control(t, 0) = c;
  }
  return out;
}

TEST(LinearGaussian, FindsTheLawThatMadeTheData) {
  // 20,000 frames: the slope's standard error is below 0.002, the variance's is 1 %.
  const auto model = fitLinearGaussian({wave(20000, 1)}, 1, 0.01);
  EXPECT_NEAR(model.weight(0, 0), 0.5, 0.01);
  EXPECT_NEAR(model.weight(0, 1), 0.3, 0.01);
  EXPECT_NEAR(model.factor(0, 0), std::hypot(0.02, 0.01), 0.001) << "the floor adds its variance";
  EXPECT_EQ(model.floorDirections, 0);
  EXPECT_EQ(fitLinearGaussian({wave(20000, 1)}, 1, 0.03).floorDirections, 1);
}

TEST(LinearGaussian, GivesTheMeanOfTheLogDensityOverTheNoise) {
  LinearGaussian model{.order = 1, .floorM = 0.03};
  model.weight = Eigen::MatrixXd::Zero(1, 3);
  model.weight(0, 0) = 0.5;
  model.bias = Eigen::VectorXd::Constant(1, 0.1);
  model.factor = Eigen::MatrixXd::Constant(1, 1, 0.05);
  FeatureSequence s{.name = "two", .pose = Matrix(2, 1), .control = Matrix::Zero(2, 1)};
  s.pose << 1.f, 0.7f;
  // Error 0.7 - 0.5 - 0.1 = 0.1, two deviations; E[(0.1 + n)^2] = 0.01 + 0.0009.
  const double expected =
      -0.5 * std::log(2.0 * std::numbers::pi) - std::log(0.05) - 0.5 * (0.01 + 0.0009) / 0.0025;
  const auto nats = logDensity(model, s, 1);
  ASSERT_EQ(nats.size(), 1U);
  EXPECT_NEAR(nats[0], expected, 1e-6);  // float poses
}

TEST(LinearGaussian, IsStoredWhole) {
  const auto model = fitLinearGaussian({wave(500, 2)}, 2, 0.01);
  TensorFile file;
  store(model, file);
  const auto again = loadLinearGaussian(file, 1, 1, 0.01, {}, "file");
  ASSERT_TRUE(again);
  EXPECT_EQ(again->order, 2);
  EXPECT_EQ(logDensity(*again, wave(50, 3), 2), logDensity(model, wave(50, 3), 2));
  EXPECT_EQ(loadLinearGaussian(TensorFile{}, 1, 1, 0.01, {}, "file"), nullptr);
  EXPECT_THROW(loadLinearGaussian(file, 2, 1, 0.01, {}, "file"), InputError);
  EXPECT_THROW(fitLinearGaussian({wave(2, 1)}, 2, 0.01), InputError);
}

TEST(ObservationNoise, ComesInOppositePairsAndDependsOnTheFrameAlone) {
  const ObservationNoise noise{5e-4, 4};
  const Matrix all = observationNoise(noise, 0, 0, 400, 63);
  EXPECT_EQ(observationNoise(noise, 0, 100, 50, 63), Matrix(all.middleRows(100, 50)));
  EXPECT_EQ(observationNoise(noise, 1, 0, 400, 63), Matrix(-all));
  EXPECT_NE(observationNoise(noise, 2, 0, 400, 63), all);
  // 25,200 values: the standard error of their deviation is 0.45 %.
  const double deviation = std::sqrt(all.cast<double>().squaredNorm() / (400 * 63));
  EXPECT_NEAR(deviation, 5e-4, 4 * 0.0045 * 5e-4);
  EXPECT_EQ(observationNoiseFromJson(toJson(noise), "m").draws, 4);
  EXPECT_THROW(observationNoiseFromJson({{"floor_mm", 0.5}, {"draws", 3}}, "m"), InputError);
}

/// Each value of a pose is normal about the last frame's, with a scale of its own.
class RandomWalk : public MotionModel, public DensityEstimator {
 public:
  RandomWalk(double scale, ObservationNoise noise) : m_scale(scale) {
    m_info.poseDim = 6;
    m_info.controlDim = 3;
    m_info.context = 1;
    m_info.latent.width = 6;
    m_info.density = DensityKind::Exact;
    m_info.observation = noise;
    m_info.standardiser = {std::vector<float>(6, 0.f), std::vector<float>(6, 1.f),
                           std::vector<float>(3, 0.f), std::vector<float>(3, 1.f)};
  }
  const ModelInfo& info() const override { return m_info; }
  const DensityEstimator* density() const override { return this; }
  RolloutState start(int, const Matrix& history) const override { return {history}; }
  std::vector<SequenceScore> observeMany(std::span<RolloutState> states,
                                         std::span<const ObservedSequence> sequences,
                                         const std::function<void()>&) const override {
    std::vector<SequenceScore> out;
    for (size_t i = 0; i < sequences.size(); ++i)
      out.push_back(against(states[i], *sequences[i].poses,
                            sequences[i].targets ? *sequences[i].targets : *sequences[i].poses));
    return out;
  }
  TensorFile save() const override { return {}; }

 private:
  SequenceScore against(RolloutState& state, const Matrix& poses, const Matrix& targets) const {
    auto& last = std::any_cast<Matrix&>(state.value);
    SequenceScore out{.latent = Matrix(poses.rows(), poses.cols()), .loglikNats = {}};
    for (long t = 0; t < poses.rows(); ++t) {
      out.latent.row(t) = (targets.row(t) - last) / static_cast<float>(m_scale);
      out.loglikNats.push_back(-0.5 * out.latent.row(t).cast<double>().squaredNorm() -
                               6 * (std::log(m_scale) + 0.5 * std::log(2.0 * std::numbers::pi)));
      last = poses.row(t);
    }
    return out;
  }

  ModelInfo m_info;
  double m_scale;
};

FeatureSequence still(int frames) {
  return {.name = "still", .pose = Matrix::Ones(frames, 6), .control = Matrix::Zero(frames, 3)};
}

TEST(Scorer, NoScaleBelowTheFloorGainsAnything) {
  // A still clip: without a floor a density a thousand times as sharp gains 6 ln 1000 nats.
  const auto nats = [](double scale, ObservationNoise noise) {
    return scoreSequence(RandomWalk(scale, noise), still(200)).meanNatsPerFrame();
  };
  EXPECT_NEAR(nats(5e-7, {}) - nats(5e-4, {}), 6 * std::log(1000.0), 1e-6);
  const ObservationNoise floor{5e-4, 4};
  const double at = nats(5e-4, floor);
  EXPECT_LT(nats(2.5e-4, floor), at);
  EXPECT_LT(nats(5e-7, floor), at - 1e5);
  // 2 x 199 x 6 values of noise: E[n^2] is known to 2.9 %, which is 0.09 nats here.
  const double expected = -3.0 - 6 * (std::log(0.05) + 0.5 * std::log(2.0 * std::numbers::pi));
  EXPECT_NEAR(at, expected, 4 * 0.09) << "nats per frame, poses in centimetres";
}

TEST(Scorer, AClipThatIsTooShortIsLeftEmptyAmongOthersAndRefusedAlone) {
  const RandomWalk model(0.1, {});
  const std::vector<FeatureSequence> both{still(1), still(5)};
  Progress progress;
  const auto scores = scoreSequences(model, both, false, progress);
  EXPECT_TRUE(scores[0].tooShort());
  EXPECT_EQ(scores[0].frames, 1);
  EXPECT_EQ(scores[1].loglikNats.size(), 4U);
  EXPECT_THROW(scoreSequence(model, both[0]), InputError);
}

TEST(Likelihood, ComparesFramesThatEveryModelScoresAndNamesWhatIsTooShort) {
  const RandomWalk model(0.1, {5e-4, 4});
  ClipScore whole{.name = "long", .frames = 6, .firstFrame = 1, .loglikNats = {1, 2, 3, 4, 5}};
  whole.linearGaussianNats = {0, 0, 1, 1, 1};
  ClipScore brief{.name = "brief", .frames = 3, .firstFrame = 1, .loglikNats = {100, 100}};
  brief.linearGaussianNats = {9, 9};
  const std::vector<ClipScore> scores{whole, brief, {.name = "none", .frames = 1, .firstFrame = 1}};
  const auto s = summarise(model.info(), scores, 3);
  EXPECT_EQ(s.clips, 1);
  EXPECT_EQ(s.frames, 3);
  EXPECT_DOUBLE_EQ(s.nats, 4.0);
  EXPECT_DOUBLE_EQ(s.linearGaussian, 1.0);
  ASSERT_EQ(s.tooShort.size(), 2U);
  EXPECT_EQ(s.tooShort[0].name, "brief");
  EXPECT_EQ(s.tooShort[0].needed, 4);
  EXPECT_EQ(tooShortText(s),
            "2 of 3 clips are too short to score (fewer than 4 frames): brief, none");
  EXPECT_TRUE(std::isnan(summarise(model.info(), {}, 1).nats));
}

TEST(Likelihood, SaysWhetherTheNumberHangsOnTheFloor) {
  ModelInfo info{.poseDim = 63, .density = DensityKind::Exact};
  EXPECT_TRUE(floorText(info).starts_with("No floor"));
  info.observation = {5e-4, 4};
  info.provenance = {{"floor_directions", 20.0}};
  // 20 (-ln 0.05 - 0.5 ln 2 pi - 0.5) = 31.5
  EXPECT_NE(floorText(info).find("20 of 63 directions lie on it and supply about 32 nats"),
            std::string::npos)
      << floorText(info);
  const std::vector<ClipScore> one{{.name = "c", .frames = 2, .firstFrame = 1, .loglikNats = {86}}};
  const auto s = summarise(info, one, 1);
  EXPECT_DOUBLE_EQ(s.effectiveDimensions, 43.0);
  EXPECT_DOUBLE_EQ(s.natsPerEffectiveDimension, 2.0);
}

TEST(Trainer, StoresTheFloorTheYardstickAndWhatLiesOnIt) {
  const test::TempFolder folder;
  TrainRequest request = test::tinyRequest(folder / "run");
  request.config["model"].erase("observation_floor_mm");
  request.steps = 3;
  const auto model =
      moglow::family().load(readTensorFile(test::trainTiny(request).last), "tiny", {});
  const ModelInfo& info = model->info();
  EXPECT_EQ(info.observation, (ObservationNoise{5e-4, kObservationDraws}));
  ASSERT_TRUE(info.yardstick);
  EXPECT_EQ(info.yardstick->order, 3);
  EXPECT_EQ(info.config.at("observation_floor_mm"), 0.5);
  const double on = floorDirectionsOf(info);
  EXPECT_GE(on, 0.0);
  EXPECT_LE(on, 63.0);
  const ClipScore score = scoreClip(*model, test::walkerClips(1, 2.0, 6).front());
  EXPECT_EQ(score.linearGaussianNats.size(), score.loglikNats.size());
}

}  // namespace
}  // namespace marey
