// Units of pose values: what is a length, what a floor is for an angle, and what a likelihood of
// both is, against numbers by hand.
#include "model/pose_units.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/random.h"
#include "model/likelihood.h"
#include "model/linear_gaussian.h"
#include "motion/rotation.h"

namespace marey {
namespace {

std::shared_ptr<const Skeleton> oneJoint() {
  auto out = std::make_shared<Skeleton>();
  out->names = {"Hips"};
  out->parents = {-1};
  out->offsets = {Vec3::Zero()};
  return out;
}

/// Poses of one joint: three lengths and three angles.
ModelInfo rotationInfo() {
  ModelInfo out{.poseDim = 6, .controlDim = 3, .context = 1, .density = DensityKind::Exact};
  out.latent.width = 6;
  out.features.layout = "joint-expmap";
  out.skeleton = oneJoint();
  out.observation = {5e-4, 4};
  out.standardiser = {std::vector<float>(6, 0.f),
                      {0.1f, 0.1f, 0.1f, 0.5f, 0.5f, 0.5f},
                      std::vector<float>(3, 0.f),
                      std::vector<float>(3, 1.f)};
  return out;
}

TEST(PoseUnits, LengthsAreShownInCentimetresAndAnglesInRadians) {
  const ModelInfo info = rotationInfo();
  EXPECT_EQ(likelihoodUnit(info), "nats per frame, cm and rad");
  EXPECT_EQ(natsUnit(likelihoodUnit(info)), "nats, cm and rad");
  EXPECT_EQ(likelihoodUnit(FeatureSpec{}), "nats per frame, cm");
  // d(standardised) / d(shown): 1 / (0.1 * 100) for a length, 1 / 0.5 for an angle.
  EXPECT_NEAR(toShownPerFrame(info.standardiser, channelsOf(info)),
              3 * std::log(1.0 / 10.0) + 3 * std::log(2.0), 1e-6);
  EXPECT_EQ(toShownPerFrame({}, channelsOf(info)), 0.0);
}

TEST(PoseUnits, AnAnglesFloorMovesAPointAQuarterOfAMetreAwayByTheFloor) {
  const auto scales = floorScales(channelsOf(rotationInfo()));
  EXPECT_EQ(scales, (std::vector<double>{1, 1, 1, 4, 4, 4}));
  const Quatd turn = expMap(Vec3d(0.0, 5e-4 * scales[3], 0.0));
  EXPECT_NEAR((turn * Vec3d(0.25, 0.0, 0.0) - Vec3d(0.25, 0.0, 0.0)).norm(), 5e-4, 1e-9);
  EXPECT_NE(floorText(rotationInfo()).find("0.5 mm and 0.002 rad"), std::string::npos);
}

TEST(PoseUnits, ModelsWithoutASkeletonHaveLengths) {
  ModelInfo info;
  info.poseDim = 5;
  EXPECT_EQ(floorScales(channelsOf(info)), std::vector<double>(5, 1.0));
  info.features.layout = "joint-expmap";
  EXPECT_THROW(requireFittingPoses(info, "model"), InputError);
}

TEST(PoseUnits, PosesOfAnotherWidthThanTheSkeletonsAreRefused) {
  ModelInfo info = rotationInfo();
  EXPECT_NO_THROW(requireFittingPoses(info, "model"));
  info.poseDim = 9;
  EXPECT_THROW(requireFittingPoses(info, "model"), InputError);
}

/// x_t ~ N(x_{t-1}, s^2) of standardised poses.
class RandomWalk : public MotionModel, public DensityEstimator {
 public:
  explicit RandomWalk(double scale) : m_info(rotationInfo()), m_scale(scale) {}
  const ModelInfo& info() const override { return m_info; }
  const DensityEstimator* density() const override { return this; }
  RolloutState start(int, const Matrix& history) const override { return {history}; }
  std::vector<SequenceScore> observeMany(std::span<RolloutState> states,
                                         std::span<const ObservedSequence> sequences,
                                         const std::function<void()>&) const override {
    std::vector<SequenceScore> out;
    for (size_t i = 0; i < sequences.size(); ++i) {
      const Matrix& last = std::any_cast<Matrix&>(states[i].value);
      const auto std = Eigen::Map<const Eigen::RowVectorXf>(m_info.standardiser.poseStd.data(), 6);
      out.emplace_back();
      for (long t = 0; t < sequences[i].poses->rows(); ++t) {
        const Eigen::RowVectorXd error =
            ((sequences[i].targets->row(t) - last).array() / std.array()).cast<double>();
        out.back().loglikNats.push_back(
            -0.5 * error.squaredNorm() / (m_scale * m_scale) -
            6 * (std::log(m_scale) + 0.5 * std::log(2.0 * std::numbers::pi)));
      }
      out.back().latent = Matrix::Zero(sequences[i].poses->rows(), 6);
    }
    return out;
  }
  TensorFile save() const override { return {}; }

 private:
  ModelInfo m_info;
  double m_scale;
};

TEST(PoseUnits, ScoresSeeAnglesThroughNoiseOfTheirOwnSize) {
  FeatureSequence still{
      .name = "still", .pose = Matrix::Ones(400, 6), .control = Matrix::Zero(400, 3)};
  const ClipScore score = scoreSequence(RandomWalk(0.004), still);
  EXPECT_EQ(score.unit, "nats per frame, cm and rad");
  // Noise of 0.0005 / 0.1 = 0.005 deviations on lengths, 0.002 / 0.5 = 0.004 on angles.
  const double quadratic = 0.5 * (3 * 0.005 * 0.005 + 3 * 0.004 * 0.004) / (0.004 * 0.004);
  const double expected = -quadratic -
                          6 * (std::log(0.004) + 0.5 * std::log(2.0 * std::numbers::pi)) +
                          3 * std::log(1.0 / 10.0) + 3 * std::log(2.0);
  // 2 x 399 x 6 independent squares: the mean of each kind is known to sqrt(2 / 2394) = 2.9 %.
  EXPECT_NEAR(score.meanNatsPerFrame(), expected, 4 * 0.029 * quadratic);
  EXPECT_EQ(scoreSequence(RandomWalk(0.004), still, true).unit, kStandardisedUnit);
}

FeatureSequence noise(int frames, const std::vector<double>& scale) {
  FeatureSequence out{.name = "noise", .pose = Matrix(frames, 2), .control = Matrix(frames, 1)};
  for (int t = 0; t < frames; ++t) {
    const auto at = static_cast<uint32_t>(3 * t);
    const RandomKey key{.seed = 5, .stage = RandomStage::Test};
    const double a = normalAt(key, at), b = 0.4 * a + 0.01 * normalAt(key, at + 1);
    out.pose(t, 0) = static_cast<float>(a * scale[0]);
    out.pose(t, 1) = static_cast<float>(b * scale[1]);
    out.control(t, 0) = static_cast<float>(normalAt(key, at + 2));
  }
  return out;
}

TEST(PoseUnits, TheYardstickIsTheSameInOtherUnits) {
  const std::vector<double> scale{1.0, 4.0};
  const auto plain = fitLinearGaussian({noise(3000, {1.0, 1.0})}, 1, 0.02);
  const auto scaled = fitLinearGaussian({noise(3000, scale)}, 1, 0.02, scale);
  EXPECT_EQ(plain.floorDirections, 1) << "b follows a within 0.01";
  EXPECT_EQ(scaled.floorDirections, 1);
  const auto a = logDensity(plain, noise(50, {1.0, 1.0}), 1);
  const auto b = logDensity(scaled, noise(50, scale), 1);
  for (size_t t = 0; t < a.size(); ++t) EXPECT_NEAR(b[t], a[t] - std::log(4.0), 1e-3);
}

}  // namespace
}  // namespace marey
