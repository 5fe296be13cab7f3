// Sampling and scoring.
#include "model/sampler.h"

#include <cmath>
#include <numeric>

#include "tiny_run.h"
#include <gtest/gtest.h>

#include "base/error.h"
#include "model/scorer.h"
#include "motion/path.h"

namespace marey {
namespace {

/// A model that gives every latent it receives back as the pose.
class EchoModel : public MotionModel, public FrameGenerator {
 public:
  explicit EchoModel(double df = 0.0) {
    m_info.latent = {.width = 5, .degreesOfFreedom = df};
    m_info.poseDim = 5;
    m_info.controlDim = 3;
    m_info.context = 2;
    m_info.lookahead = 1;
  }
  const ModelInfo& info() const override { return m_info; }
  const FrameGenerator* rollout() const override { return this; }
  RolloutState start(int, const Matrix& history) const override { return {history}; }
  Matrix sampleFrame(RolloutState&, const Matrix& window, const Matrix& latent) const override {
    windows.push_back(window);
    return latent;
  }
  TensorFile save() const override { return {}; }

  mutable std::vector<Matrix> windows;

 private:
  ModelInfo m_info;
};

SampleRequest straight(int frames, int samples) {
  SampleRequest out;
  for (int t = 0; t < frames; ++t) out.path.push_back({0.0, 0.05 * t, 0.0});
  out.samples = samples;
  out.seed = 4;
  out.warmUpS = 0.5;
  return out;
}

std::vector<FeatureSequence> sampled(const MotionModel& model, const SampleRequest& request) {
  Progress progress;
  return sampleSequences(model, request, progress);
}

TEST(Latents, AreTheSameBitsForAnyBatchSize) {
  const EchoModel model;
  const auto five = sampled(model, straight(12, 5));
  for (int b = 0; b < 5; ++b) {
    SampleRequest one = straight(12, 1);
    one.firstSample = b;
    const auto alone = sampled(model, one);
    EXPECT_EQ(alone[0].pose, five[static_cast<size_t>(b)].pose);
    EXPECT_EQ(alone[0].name, five[static_cast<size_t>(b)].name);
  }
  EXPECT_NE(five[0].pose, five[1].pose);
}

TEST(Latents, DependOnSeedSampleAndFrame) {
  const auto draw = [](uint64_t seed, int sample, int frame) {
    std::vector<float> out(4);
    drawLatent(seed, sample, frame, 1.0, 0.0, out);
    return out;
  };
  EXPECT_EQ(draw(1, 2, 3), draw(1, 2, 3));
  EXPECT_NE(draw(1, 2, 3), draw(2, 2, 3));
  EXPECT_NE(draw(1, 2, 3), draw(1, 3, 3));
  EXPECT_NE(draw(1, 2, 3), draw(1, 2, 4));
}

double variance(double temperature, double df) {
  double squares = 0.0;
  std::vector<float> latent(4);
  for (int frame = 0; frame < 20000; ++frame) {
    drawLatent(1, 0, frame, temperature, df, latent);
    for (const float v : latent) squares += static_cast<double>(v) * v;
  }
  return squares / 80000.0;
}

TEST(Latents, HaveTheVarianceOfTheirBaseDistribution) {
  EXPECT_NEAR(variance(1.0, 0.0), 1.0, 0.02);
  EXPECT_NEAR(variance(0.5, 0.0), 0.25, 0.005);
  EXPECT_NEAR(variance(1.0, 10.0), 10.0 / 8.0, 0.04);  // df / (df - 2)
}

TEST(Latents, AtTemperatureZeroAreZero) {
  EXPECT_EQ(variance(0.0, 0.0), 0.0);
}

TEST(Sampler, AFrameSeesTheControlAroundIt) {
  const EchoModel model;
  SampleRequest request = straight(4, 1);
  request.warmUpS = 0.0;
  for (int t = 0; t < 4; ++t) request.path[static_cast<size_t>(t)].z = t * t;  // steps 1, 3, 5
  sampled(model, request);
  ASSERT_EQ(model.windows.size(), 4u);
  const auto forward = [&](size_t frame) {
    std::vector<float> out;
    for (long k = 0; k < 4; ++k) out.push_back(model.windows[frame](0, 3 * k + 1));
    return out;
  };
  // Two frames of context, the present one and one of lookahead; ends are repeated.
  EXPECT_EQ(forward(0), (std::vector<float>{1, 1, 1, 1}));
  EXPECT_EQ(forward(2), (std::vector<float>{1, 1, 3, 5}));
  EXPECT_EQ(forward(3), (std::vector<float>{1, 3, 5, 5}));
}

TEST(Sampler, TheWarmUpIsDroppedAndItsLatentsAreItsOwn) {
  const EchoModel model;
  SampleRequest cold = straight(30, 1), warm = straight(20, 1);
  cold.warmUpS = 0.0;
  warm.warmUpS = 0.5;  // 10 frames
  EXPECT_EQ(sampled(model, warm)[0].pose, Matrix(sampled(model, cold)[0].pose.bottomRows(20)));
}

TEST(Sampler, PosesOfAModelDoNotDependOnTheBatchSize) {
  const auto five = sampled(test::tinyModel(), straight(20, 5));
  SampleRequest one = straight(20, 1);
  one.firstSample = 3;
  const auto alone = sampled(test::tinyModel(), one);
  EXPECT_LT((alone[0].pose - five[3].pose).cwiseAbs().maxCoeff(), 1e-4f);
  EXPECT_GT((alone[0].pose - five[2].pose).cwiseAbs().maxCoeff(), 1e-2f);
}

TEST(Sampler, SampledClipsFollowThePathExactly) {
  SampleRequest request = straight(40, 1);
  request.path = presetPath("turn-left", 2.0, 20.0);
  Progress progress;
  const auto features = sampleSequences(test::tinyModel(), request, progress);
  const auto trajectory = trajectoryFromControl(features[0].control, features[0].start);
  for (size_t t = 0; t < trajectory.size(); ++t) {
    EXPECT_NEAR(trajectory[t].x, request.path[t].x, 1e-5);
    EXPECT_NEAR(trajectory[t].z, request.path[t].z, 1e-5);
  }
  EXPECT_EQ(sampleClips(test::tinyModel(), request, progress)[0].frameCount(),
            static_cast<int>(request.path.size()));
}

TEST(Sampler, AStartFromAClipTakesItsFirstFramesAsHistory) {
  const Clip clip = test::walkerClips(1, 2.0, 5).front();
  const auto features = extractFeatures(clip, test::tinyModel().info().features);
  const auto request = requestAlongClip(test::tinyModel(), clip, true);
  EXPECT_EQ(request.startPoses, Matrix(features.pose.topRows(3)));
  EXPECT_EQ(static_cast<int>(request.path.size()), features.frameCount() - 3);
  const auto trajectory = trajectoryFromControl(features.control, features.start);
  EXPECT_EQ(request.path[0].z, trajectory[3].z);
  const EchoModel echo;
  auto other = request;
  other.startPoses = Matrix::Zero(2, 4);
  EXPECT_THROW(sampled(echo, other), InputError);
  EXPECT_TRUE(sampled(test::tinyModel(), request)[0].pose.allFinite());
}

TEST(Sampler, ClipsThatDoNotSuitTheModelAreRefused) {
  const Clip clip = test::walkerClips(1, 2.0, 5).front();
  EXPECT_THROW(requestAlongClip(test::tinyModel(), sliceFrames(clip, 0, 4), true), InputError);
  EXPECT_NO_THROW(requestAlongClip(test::tinyModel(), sliceFrames(clip, 0, 5), true));
  Clip few = clip;
  auto skeleton = std::make_shared<Skeleton>(*clip.skeleton);
  skeleton->names.pop_back();
  skeleton->parents.pop_back();
  skeleton->offsets.pop_back();
  few.skeleton = skeleton;
  few.positions.resize(20 * 40);
  few.transforms.reset();
  EXPECT_THROW(requestAlongClip(test::tinyModel(), few, true), InputError);
  EXPECT_NO_THROW(requestAlongClip(test::tinyModel(), few, false)) << "the path alone is followed";
  EXPECT_THROW(scoreClip(test::tinyModel(), few), InputError);
  EXPECT_THROW(scoreClip(test::tinyModel(), sliceFrames(clip, 0, 3)), InputError);
}

TEST(Sampler, NoPathOrNoSampleIsRefused) {
  EXPECT_THROW(sampled(test::tinyModel(), straight(0, 1)), InputError);
  EXPECT_THROW(sampled(test::tinyModel(), straight(5, 0)), InputError);
}

TEST(Scorer, ALongClipScoredInPiecesIsTheSameAsInOne) {
  const MotionModel& model = test::tinyModel();
  const auto clip = test::walkerClips(1, 32.0, 6).front();
  const auto f = extractFeatures(clip, model.info().features);
  ASSERT_GT(f.frameCount(), 600);
  const auto score = scoreSequence(model, f, true);
  EXPECT_EQ(score.firstFrame, 3);
  Matrix history(1, 3 * f.pose.cols());
  for (int t = 0; t < 3; ++t) history.middleCols(t * f.pose.cols(), f.pose.cols()) = f.pose.row(t);
  Matrix control(f.control.rows() + 1, 3);  // one frame of lookahead
  control << f.control, f.control.bottomRows(1);
  RolloutState state = model.density()->start(1, history);
  const auto whole = model.density()->observe(state, f.pose.bottomRows(f.pose.rows() - 3), control);
  ASSERT_EQ(score.loglikNats.size(), whole.loglikNats.size());
  for (size_t t = 0; t < whole.loglikNats.size(); ++t) {
    EXPECT_NEAR(score.loglikNats[t], whole.loglikNats[t], 1e-3);
    EXPECT_NEAR(score.latentNorm[t], whole.latent.row(static_cast<long>(t)).norm(), 1e-3);
  }
}

TEST(Scorer, TheStandardisedDensityDiffersByTheLogDeterminantOfTheStandardiser) {
  const Clip clip = test::walkerClips(1, 2.0, 6).front();
  const auto centimetres = scoreClip(test::tinyModel(), clip);
  const auto plain = scoreClip(test::tinyModel(), clip, true);
  double logDet = 0.0;
  for (const float s : test::tinyData().standardiser.poseStd)
    logDet -= std::log(100.0 * static_cast<double>(s));
  ASSERT_LT(logDet, -1.0);
  for (size_t t = 0; t < centimetres.loglikNats.size(); ++t)
    EXPECT_NEAR(centimetres.loglikNats[t], plain.loglikNats[t] + logDet, 1e-9);
  EXPECT_NEAR(centimetres.bitsPerDimension, -centimetres.meanNatsPerFrame() / std::log(2.0) / 63.0,
              1e-12);
}

TEST(Scorer, ASampleScoredAgainHasTheLatentsThatMadeIt) {
  // Sampling and scoring are two pieces of code; the latents tie them together.
  const MotionModel& model = test::tinyModel();
  SampleRequest request = requestAlongClip(model, test::walkerClips(1, 2.0, 5).front(), true);
  request.temperature = 0.5;
  FeatureSequence f = sampled(model, request)[0];
  Matrix pose(f.pose.rows() + 3, 63), control(f.pose.rows() + 3, 3);
  pose << request.startPoses, f.pose;
  control << request.startControl, f.control;
  f.pose = pose;
  f.control = control;
  const auto score = scoreSequence(model, f);
  std::vector<float> latent(63);
  for (int t = 0; t < 10; ++t) {
    drawLatent(request.seed, 0, t, 0.5, 0.0, latent);
    const double norm =
        std::sqrt(std::inner_product(latent.begin(), latent.end(), latent.begin(), 0.0));
    EXPECT_NEAR(score.latentNorm[static_cast<size_t>(t)], norm, 1e-2) << t;
  }
}

}  // namespace
}  // namespace marey
