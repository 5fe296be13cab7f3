// The laws of an invertible layer, one test for every layer and for whole networks.
#include <cmath>
#include <functional>
#include <string>

#include <ATen/CPUGeneratorImpl.h>
#include <gtest/gtest.h>

#include "base/job.h"
#include "model/gradient/batches.h"
#include "moglow/family.h"
#include "moglow/net.h"
#include "motion/walker.h"
#include "nn/flow/flow.h"

namespace marey {
namespace {

using nn::FlowState;
using nn::Transformed;
using torch::Tensor;

/// Data and conditioning of B sequences of T frames.
struct Inputs {
  Tensor x;  ///< [B, T, D]
  Tensor c;  ///< [B, T, C]
};

/// Anything invertible, in float64, so that round trips and determinants can be exact.
struct Layer {
  std::function<Transformed(const Inputs&, FlowState&)> toLatent;
  std::function<Tensor(const Tensor& z, const Tensor& c, FlowState&)> toData;
  std::function<Inputs(int64_t batch, int64_t frames)> inputs;
};

at::Generator generator(uint64_t seed) {
  return at::detail::createCPUGenerator(seed);
}

/// Output layers and actnorms start at zero: with random values the laws can fail.
void makeLively(torch::nn::Module& module) {
  const torch::NoGradGuard guard;
  auto random = generator(11);
  for (auto& item : module.named_parameters()) {
    const std::string& name = item.key();
    const bool zero = name.find("out_") != std::string::npos ||
                      name.find("bias") != std::string::npos ||
                      name.find("log") != std::string::npos;
    if (zero) item.value().add_(0.2 * torch::randn(item.value().sizes(), random));
  }
  module.to(torch::kFloat64);
  module.eval();
}

Inputs randomInputs(int64_t batch, int64_t frames, int64_t channels, int64_t conditioning) {
  auto random = generator(7);
  return {torch::randn({batch, frames, channels}, random, torch::kFloat64),
          torch::randn({batch, frames, conditioning}, random, torch::kFloat64)};
}

constexpr int64_t kChannels = 5, kConditioning = 3;

Layer actNorm() {
  auto layer = std::make_shared<nn::ActNorm>(kChannels);
  makeLively(*layer);
  return {[=](const Inputs& in, FlowState&) { return layer->toLatent(in.x); },
          [=](const Tensor& z, const Tensor&, FlowState&) { return layer->toData(z); },
          [](int64_t b, int64_t t) { return randomInputs(b, t, kChannels, 1); }};
}

Layer linear(bool lu) {
  auto random = generator(3);
  auto layer = std::make_shared<nn::InvertibleLinear>(kChannels, lu, random);
  {
    // A rotation has log-determinant 0 whatever the code does.
    const torch::NoGradGuard guard;
    auto& weights = lu ? layer->upper : layer->free;
    weights.add_(0.3 * torch::randn(weights.sizes(), random));
  }
  makeLively(*layer);
  return {[=](const Inputs& in, FlowState&) { return layer->toLatent(in.x); },
          [=](const Tensor& z, const Tensor&, FlowState&) { return layer->toData(z); },
          [](int64_t b, int64_t t) { return randomInputs(b, t, kChannels, 1); }};
}

nn::CouplingNetSpec smallNet(const std::string& cell) {
  return {.cell = cell, .hidden = 6, .layers = 2};
}

Layer coupling(const std::string& cell) {
  auto random = generator(4);
  auto layer =
      std::make_shared<nn::AffineCoupling>(kChannels, kConditioning, smallNet(cell), random);
  makeLively(*layer);
  return {[=](const Inputs& in, FlowState& s) {
            s.resize(1);
            return layer->toLatent(in.x, in.c, s[0]);
          },
          [=](const Tensor& z, const Tensor& c, FlowState& s) {
            s.resize(1);
            return layer->toData(z, c, s[0]);
          },
          [](int64_t b, int64_t t) { return randomInputs(b, t, kChannels, kConditioning); }};
}

Layer flow(bool lu, const std::string& cell) {
  auto random = generator(5);
  auto layer = std::make_shared<nn::Flow>(nn::FlowSpec{.channels = kChannels,
                                                       .conditioning = kConditioning,
                                                       .steps = 3,
                                                       .lu = lu,
                                                       .net = smallNet(cell)},
                                          random);
  makeLively(*layer);
  return {[=](const Inputs& in, FlowState& s) { return layer->toLatent(in.x, in.c, s); },
          [=](const Tensor& z, const Tensor& c, FlowState& s) { return layer->toData(z, c, s); },
          [](int64_t b, int64_t t) { return randomInputs(b, t, kChannels, kConditioning); }};
}

const DataSet& walkerData() {
  static const DataSet data = [] {
    std::vector<Clip> clips;
    for (auto& walked : walkerDataSet(6, 8.0, 2, 20.0)) clips.push_back(std::move(walked.clip));
    Progress progress;
    return prepareDataSet(clips, {}, {.mirror = false, .reverse = false}, progress);
  }();
  return data;
}

/// A whole network, fitted to the walker; its conditioning is [history, control].
Layer network(const std::string& poseBase, bool feetPassFlow = false) {
  constexpr int64_t kTau = 4;
  const DataSet& data = walkerData();
  Json config = {{"tau", kTau},    {"lookahead", 1},        {"steps", 2},          {"hidden", 8},
                 {"dropout", 0.0}, {"pose_base", poseBase}, {"start", "whitening"}};
  if (poseBase == "kinematic") {
    config["regimes"] = 3;
    config["foot_clusters"] = 10;
    config["net_features"] = 12;
    config["feet_pass_flow"] = feetPassFlow;
  }
  const auto trainee = moglow::family().makeTrainee(
      config, "test", {data.poseDim(), data.controlDim(), data.skeleton, data.standardiser}, 1);
  const auto net = std::dynamic_pointer_cast<moglow::Net>(trainee.net);
  const Batches batches(data.train, data.standardiser, 12, 40, torch::kCPU);
  net->initialise(batches.frames(net->context(), net->lookahead()));
  makeLively(*net);
  const int64_t historyWidth = kTau * data.poseDim();
  const auto contextOf = [=](const Tensor& c) {
    return moglow::Net::Context{
        c.narrow(-1, 0, historyWidth), c.narrow(-1, historyWidth, c.size(-1) - historyWidth), {}};
  };
  return {
      [=](const Inputs& in, FlowState& s) { return net->toLatent(in.x, contextOf(in.c), s); },
      [=](const Tensor& z, const Tensor& c, FlowState& s) {
        return net->toData(z, contextOf(c), s);
      },
      [=](int64_t b, int64_t t) {
        const auto batch = batches.inOrder(1, b);
        const auto pose = batch.pose.narrow(1, 0, kTau + t).to(torch::kFloat64);
        const auto context =
            net->contextOf(pose, batch.control.narrow(1, 0, kTau + t + 1).to(torch::kFloat64));
        return Inputs{pose.narrow(1, kTau, t), torch::cat({context.history, context.control}, -1)};
      }};
}

const std::map<std::string, std::function<Layer()>> kLayers{
    {"ActNorm", actNorm},
    {"LinearLu", [] { return linear(true); }},
    {"LinearFree", [] { return linear(false); }},
    {"CouplingLstm", [] { return coupling("lstm"); }},
    {"CouplingGru", [] { return coupling("gru"); }},
    {"CouplingFeedforward", [] { return coupling("feedforward"); }},
    {"FlowLuLstm", [] { return flow(true, "lstm"); }},
    {"FlowFreeGru", [] { return flow(false, "gru"); }},
    {"NetWithoutBase", [] { return network("none"); }},
    {"NetLinearBase", [] { return network("linear"); }},
    {"NetKinematicBase", [] { return network("kinematic"); }},
    {"NetFeetPassFlow", [] { return network("kinematic", true); }}};

class LayerLaws : public testing::TestWithParam<std::string> {
 protected:
  const Layer m_layer = kLayers.at(GetParam())();
};

double largestGap(const Tensor& a, const Tensor& b) {
  return (a - b).abs().max().item<double>();
}

/// What rounding may do to values of this size: 2^-52 of the largest, through some 10^5 operations.
/// A product of another shape adds in another order.
double rounding(const Tensor& values) {
  return 1e-10 * std::max(1.0, values.abs().max().item<double>());
}

TEST_P(LayerLaws, ShapesAreKeptAndValuesFinite) {
  const torch::NoGradGuard guard;
  const Inputs in = m_layer.inputs(3, 4);
  FlowState state;
  const auto out = m_layer.toLatent(in, state);
  EXPECT_EQ(out.value.sizes(), in.x.sizes());
  EXPECT_EQ(out.logDet.sizes(), (std::vector<int64_t>{3, 4}));
  EXPECT_TRUE(out.value.isfinite().all().item<bool>());
  EXPECT_TRUE(out.logDet.isfinite().all().item<bool>());
}

TEST_P(LayerLaws, ToDataUndoesToLatent) {
  const torch::NoGradGuard guard;
  const Inputs in = m_layer.inputs(3, 6);
  FlowState there, back;
  const auto latent = m_layer.toLatent(in, there).value;
  EXPECT_GT(largestGap(latent, in.x), 1e-2) << "an identity proves nothing";
  EXPECT_LT(largestGap(m_layer.toData(latent, in.c, back), in.x), 1e-7);
}

TEST_P(LayerLaws, TheLogDeterminantIsThatOfTheJacobian) {
  constexpr int64_t kFrames = 2;
  Inputs in = m_layer.inputs(1, kFrames);
  in.x = in.x.detach().clone().requires_grad_();
  FlowState state;
  const auto out = m_layer.toLatent(in, state);
  const auto flat = out.value.flatten();
  const int64_t n = flat.size(0), d = n / kFrames;
  std::vector<Tensor> rows;
  for (int64_t i = 0; i < n; ++i)
    rows.push_back(
        torch::autograd::grad({flat[i]}, {in.x}, {}, /*retain_graph=*/true)[0].flatten());
  const auto jacobian = torch::stack(rows);
  // A frame depends on frames before it (through the recurrent state) and on none after it.
  EXPECT_EQ(jacobian.narrow(0, 0, d).narrow(1, d, d).abs().max().item<double>(), 0.0);
  double largest = 0.0;
  for (int64_t t = 0; t < kFrames; ++t) {
    const auto block = jacobian.narrow(0, t * d, d).narrow(1, t * d, d);
    const double expected = std::get<1>(torch::linalg_slogdet(block)).item<double>();
    EXPECT_NEAR(out.logDet[0][t].item<double>(), expected, 1e-7 * (1.0 + std::abs(expected)));
    largest = std::max(largest, std::abs(expected));
  }
  EXPECT_GT(largest, 1e-3) << "a volume-preserving layer proves nothing";
}

TEST_P(LayerLaws, ABatchIsTheSameAsItsSequencesOneByOne) {
  const torch::NoGradGuard guard;
  const Inputs in = m_layer.inputs(3, 4);
  FlowState state, dataState;
  const auto whole = m_layer.toLatent(in, state);
  const auto wholeData = m_layer.toData(whole.value, in.c, dataState);
  for (int64_t b = 0; b < 3; ++b) {
    FlowState own, ownData;
    const auto one = m_layer.toLatent({in.x.narrow(0, b, 1), in.c.narrow(0, b, 1)}, own);
    EXPECT_LT(largestGap(one.value, whole.value.narrow(0, b, 1)), rounding(whole.value));
    EXPECT_LT(largestGap(one.logDet, whole.logDet.narrow(0, b, 1)), rounding(whole.logDet));
    const auto data = m_layer.toData(one.value, in.c.narrow(0, b, 1), ownData);
    EXPECT_LT(largestGap(data, wholeData.narrow(0, b, 1)), 1e-7);
  }
}

TEST_P(LayerLaws, PiecesInTimeWithTheirStateAreTheSameAsTheWhole) {
  const torch::NoGradGuard guard;
  const Inputs in = m_layer.inputs(2, 7);
  FlowState wholeState, pieceState, dataState;
  const auto whole = m_layer.toLatent(in, wholeState);
  int64_t first = 0;
  for (const int64_t frames : {1, 4, 2}) {
    const Inputs piece{in.x.narrow(1, first, frames), in.c.narrow(1, first, frames)};
    const auto out = m_layer.toLatent(piece, pieceState);
    EXPECT_LT(largestGap(out.value, whole.value.narrow(1, first, frames)), rounding(whole.value));
    EXPECT_LT(largestGap(out.logDet, whole.logDet.narrow(1, first, frames)),
              rounding(whole.logDet));
    EXPECT_LT(largestGap(m_layer.toData(out.value, piece.c, dataState), piece.x), 1e-7);
    first += frames;
  }
}

INSTANTIATE_TEST_SUITE_P(EveryLayer, LayerLaws, testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const auto& [name, make] : kLayers) names.push_back(name);
                           return names;
                         }()),
                         [](const auto& info) { return info.param; });

// ---- Starts and base density

TEST(ActNorm, ADataDependentStartGivesZeroMeanAndUnitVarianceButForConstantChannels) {
  const torch::NoGradGuard guard;
  auto random = generator(2);
  const auto frames = torch::randn({500, 3}, random) * torch::tensor({0.1f, 30.f, 1.f}) +
                      torch::tensor({5.f, -40.f, 0.f});
  frames.select(1, 2).fill_(7.f);
  nn::ActNorm layer(3);
  layer.initialise(frames);
  const auto out = layer.toLatent(frames.unsqueeze(1)).value.squeeze(1);
  EXPECT_LT(out.mean(0).abs().max().item<double>(), 1e-3);
  EXPECT_NEAR(out.select(1, 0).std(false).item<double>(), 1.0, 1e-3);
  EXPECT_NEAR(out.select(1, 1).std(false).item<double>(), 1.0, 1e-3);
  EXPECT_EQ(out.select(1, 2).abs().max().item<double>(), 0.0);
  EXPECT_EQ(layer.logs[2].item<double>(), 0.0);
}

TEST(InvertibleLinear, ASingularMatrixIsRefused) {
  auto random = generator(2);
  nn::InvertibleLinear layer(3, true, random);
  EXPECT_THROW(layer.assign(torch::ones({3, 3})), NumericError);
}

TEST(InvertibleLinear, AnAssignedMatrixIsItsWeight) {
  auto random = generator(2);
  const auto matrix = torch::randn({6, 6}, random, torch::kFloat64);
  for (const bool lu : {true, false}) {
    nn::InvertibleLinear layer(6, lu, random);
    layer.assign(matrix);
    EXPECT_LT(largestGap(layer.weight().to(torch::kFloat64), matrix), 1e-5);
  }
}

TEST(Whitening, TheWhitenedCovarianceIsTheIdentity) {
  auto random = generator(6);
  const auto root = torch::randn({4, 4}, random, torch::kFloat64);
  const auto covariance = root.matmul(root.t());
  const auto w = nn::whitening(covariance, 1e-12);
  EXPECT_LT(largestGap(w.matmul(covariance).matmul(w.t()), torch::eye(4, torch::kFloat64)), 1e-8);
}

/// scipy.stats.multivariate_normal(zeros(5)) and multivariate_t(zeros(5), eye(5), df), .logpdf.
TEST(BaseDensity, AgreesWithScipy) {
  const auto z = torch::tensor({0.5, -1.25, 2.0, 0.0, -0.75}, torch::kFloat64);
  EXPECT_NEAR(nn::baseLogDensity(z, 0.0).item<double>(), -7.782192666023363, 1e-12);
  EXPECT_NEAR(nn::baseLogDensity(z, 3.0).item<double>(), -8.253550862183934, 1e-12);
  EXPECT_NEAR(nn::baseLogDensity(z, 50.0).item<double>(), -7.821697588283827, 1e-12);
}

TEST(BaseDensity, IsOneValuePerFrame) {
  EXPECT_EQ(nn::baseLogDensity(torch::zeros({2, 3, 5}), 4.0).sizes(), (std::vector<int64_t>{2, 3}));
}

}  // namespace
}  // namespace marey
