// The gate of a foot as a change of variables, and the chart of a leg that stands on it.
#include <cmath>

#include <ATen/CPUGeneratorImpl.h>
#include <gtest/gtest.h>

#include "moglow/bone_chart.h"

namespace marey::moglow {
namespace {

using torch::Tensor;

Tensor normal(at::IntArrayRef shape, uint64_t seed) {
  return torch::randn(shape, at::detail::createCPUGenerator(seed),
                      torch::TensorOptions(torch::kFloat64));
}

/// A gate whose radii grow unevenly, shifted up to 0.8.
Gate someGate(int64_t rows) {
  const auto radii = torch::rand({rows, kGateKnots}, at::detail::createCPUGenerator(3),
                                 torch::TensorOptions(torch::kFloat64))
                         .add(0.05)
                         .square()
                         .cumsum(1);
  const auto angle = torch::arange(rows, torch::kFloat64);
  const auto size = 0.8 * angle / static_cast<double>(rows);
  return {radii, torch::stack({size * angle.cos(), size * angle.sin()}, 1)};
}

TEST(FootGate, BackUndoesThrough) {
  const Gate gate = someGate(200);
  const auto offset = 3.0 * normal({200, 2}, 1);
  const auto value = throughGate(gate, offset).value;
  EXPECT_GT((value - offset).abs().max().item<double>(), 0.1) << "an identity proves nothing";
  EXPECT_LT((backThroughGate(gate, value) - offset).abs().max().item<double>(), 1e-10);
}

TEST(FootGate, LogDeterminantIsThatOfTheJacobian) {
  const Gate gate = someGate(50);
  auto offset = normal({50, 2}, 2).requires_grad_();
  const auto gated = throughGate(gate, offset);
  std::vector<Tensor> rows;
  for (int64_t i = 0; i < 2; ++i)
    rows.push_back(torch::autograd::grad({gated.value.select(1, i).sum()}, {offset}, {}, true)[0]);
  const auto expected = torch::logdet(torch::stack(rows, 1).transpose(1, 2));
  EXPECT_LT((gated.logDet - expected).abs().max().item<double>(), 1e-9);
}

TEST(FootGate, QuantilesMakeDistancesRayleigh) {
  // Nine of ten movements are tiny, one is large: no Gaussian has this spread.
  constexpr int64_t kCount = 20000;
  const auto tiny = torch::arange(kCount).remainder(10).ne(0).to(torch::kFloat64);
  const auto offset = normal({kCount, 2}, 5) * (tiny * 0.01 + (1.0 - tiny) * 3.0).unsqueeze(1);
  const auto shift = torch::zeros_like(offset);
  const auto radii = gateQuantiles(gateDistance(offset, shift), 1e-4);
  const auto rho =
      throughGate({radii.expand({kCount, kGateKnots}), shift}, offset).value.norm(2, -1);
  for (const double bound : {0.5, 1.0, 2.0, 3.0})
    EXPECT_NEAR(rho.lt(bound).to(torch::kFloat64).mean().item<double>(),
                1.0 - std::exp(-0.5 * bound * bound), 0.005)
        << bound;
}

TEST(FootGate, ShiftMovesTheMeanByItsShareOfTheDistance) {
  constexpr int64_t kCount = 40000;
  const auto value = normal({kCount, 2}, 6);
  const auto radii = someGate(1).radii.expand({kCount, kGateKnots});
  const auto shift = torch::tensor({{0.6, 0.0}}, torch::kFloat64).expand({kCount, 2});
  const auto offset = backThroughGate({radii, shift}, value);
  const double distance = gateRadius(radii, value.norm(2, -1)).mean().item<double>();
  EXPECT_NEAR(offset.select(1, 0).mean().item<double>(), 0.6 * distance, 0.02 * distance);
  EXPECT_NEAR(offset.select(1, 1).mean().item<double>(), 0.0, 0.02 * distance);
}

/// A root and one leg: hip, knee, foot, toe, 40 cm bones, bent forwards.
struct Leg {
  BoneChart chart{
      .parents = {-1, 0, 1, 2, 3},
      .feet = {3},
      .knees = {2},
      .lengths = torch::tensor({0., 10., 40., 40., 10.}, torch::kFloat64),
      .axes =
          torch::tensor({{0., 1., 0.}, {1., 0., 0.}, {0., -1., 0.}, {0., -1., 0.}, {0., 0., 1.}},
                        torch::kFloat64),
      .sides = torch::tensor({{1., 0., 0.}, {0., 1., 0.}, {1., 0., 0.}, {1., 0., 0.}, {1., 0., 0.}},
                             torch::kFloat64)};
  Tensor pose = torch::tensor({{{0., 85., 0.},
                                {10., 85., 0.},
                                {10., 85. - 38.2, 11.8666},
                                {10., 8.6, 0.},
                                {10., 8.6, 10.}}},
                              torch::kFloat64);
  Foreseen foreseen;
  FootGate gate;

  explicit Leg(double hold) {
    const auto last = pose.select(1, 3).unsqueeze(1);
    foreseen = {.pose = pose + 0.5,
                .last = last,
                .places = last + (1.0 - hold) * 0.5,
                .hold = torch::full({1, 1}, hold, torch::kFloat64),
                .lengths = chart.lengths.unsqueeze(0)};
    const auto ones = torch::ones({1, 1}, torch::kFloat64);
    gate = {.foreseen = torch::zeros({1, 1, 2}, torch::kFloat64),
            .knee = 0.1 * ones,
            .skew = 0.3 * ones,
            .radii = (0.01 * torch::arange(1, kGateKnots + 1, torch::kFloat64)).view({1, 1, -1}),
            .kneeSlope = ones,
            .boneSlope = ones,
            .slack = 0.02 * ones};
  }
};

TEST(StandingLeg, AHeldFootStaysWhereItStoodThoughTheHipMoves) {
  const Leg leg(1.0);
  auto value = torch::zeros({1, 5, 3}, torch::kFloat64);
  value.select(1, 0).add_(torch::tensor({-0.7, -1.5, 0.2}, torch::kFloat64));
  const auto now = fromChart(leg.chart, value, leg.foreseen, leg.gate);
  EXPECT_LT((now - leg.pose).select(1, 3).norm().item<double>(), 1e-3);
  EXPECT_GT((now - leg.pose).select(1, 1).norm().item<double>(), 0.5);
  EXPECT_NEAR((now.select(1, 3) - now.select(1, 2)).norm().item<double>(), 40.0, 1e-3);
  EXPECT_NEAR((now.select(1, 2) - now.select(1, 1)).norm().item<double>(), 40.0, 1e-9);
}

TEST(StandingLeg, ChartAndBackForHeldAndFreeFeet) {
  for (const double hold : {0.0, 0.5, 1.0}) {
    const Leg leg(hold);
    const auto pose = leg.pose + 0.3 * normal({1, 5, 3}, 8);
    const auto charted = toChart(leg.chart, pose, leg.foreseen, leg.gate);
    EXPECT_LT((fromChart(leg.chart, charted.value, leg.foreseen, leg.gate) - pose)
                  .abs()
                  .max()
                  .item<double>(),
              1e-9)
        << hold;
  }
}

TEST(StandingLeg, LogDeterminantIsThatOfTheJacobian) {
  for (const double hold : {0.0, 0.5, 1.0}) {
    const Leg leg(hold);
    auto pose = (leg.pose + 0.3 * normal({1, 5, 3}, 9)).requires_grad_();
    const auto charted = toChart(leg.chart, pose, leg.foreseen, leg.gate);
    const auto flat = charted.value.flatten();
    std::vector<Tensor> rows;
    for (int64_t i = 0; i < flat.size(0); ++i)
      rows.push_back(torch::autograd::grad({flat[i]}, {pose}, {}, true)[0].flatten());
    const double expected = std::get<1>(torch::slogdet(torch::stack(rows))).item<double>();
    EXPECT_NEAR(charted.logDet.item<double>(), expected, 1e-8) << hold;
  }
}

/// The body of one row, foreseen for as many as there are sizes, each with bones so much longer.
struct Bodies {
  Leg one{0.7};
  Foreseen foreseen;
  FootGate gate;

  explicit Bodies(const std::vector<double>& sizes) {
    const auto rows = static_cast<int64_t>(sizes.size());
    const auto many = [&](const Tensor& t) {
      std::vector<int64_t> shape(static_cast<size_t>(t.dim()), 1);
      shape[0] = rows;
      return t.repeat(at::IntArrayRef(shape));
    };
    const auto& f = one.foreseen;
    foreseen = {.pose = many(f.pose),
                .last = many(f.last),
                .places = many(f.places),
                .hold = many(f.hold),
                .lengths = f.lengths * torch::tensor(sizes, torch::kFloat64).unsqueeze(1)};
    gate = {.foreseen = many(one.gate.foreseen),
            .knee = many(one.gate.knee),
            .skew = many(one.gate.skew),
            .radii = many(one.gate.radii),
            .kneeSlope = many(one.gate.kneeSlope),
            .boneSlope = many(one.gate.boneSlope),
            .slack = many(one.gate.slack)};
  }
};

TEST(StandingLeg, EveryRowStandsOnBonesOfItsOwnLengths) {
  const std::vector<double> sizes{1.0, 1.05, 0.9, 1.3};
  const Bodies bodies(sizes);
  const auto rows = static_cast<int64_t>(sizes.size());
  // Nothing strays: every bone but the held foot's, which takes up what its hold asks for, is as
  // long as foreseen.
  const auto still = fromChart(bodies.one.chart, torch::zeros({rows, 5, 3}, torch::kFloat64),
                               bodies.foreseen, bodies.gate);
  for (int64_t i = 0; i < rows; ++i)
    for (const auto& [joint, length] : {std::pair{1, 10.0}, {2, 40.0}, {4, 10.0}})
      EXPECT_NEAR((still[i][joint] - still[i][joint - 1]).norm().item<double>(),
                  sizes[static_cast<size_t>(i)] * length, 1e-9)
          << "row " << i << ", joint " << joint;
  // The thigh of a longer leg bends further for the same place of the foot.
  const auto height = [&](int64_t i) { return still[i][2][2].item<double>(); };
  EXPECT_GT(height(1), height(0) + 1.0);
  EXPECT_LT(height(2), height(0) - 1.0);
  const auto pose = bodies.one.pose.repeat({rows, 1, 1}) + 0.3 * normal({rows, 5, 3}, 12);
  const auto value = toChart(bodies.one.chart, pose, bodies.foreseen, bodies.gate).value;
  const auto back = fromChart(bodies.one.chart, value, bodies.foreseen, bodies.gate);
  EXPECT_LT((back - pose).abs().max().item<double>(), 1e-9);
}

TEST(StandingLeg, LogDeterminantsOfUnlikeBodiesAreThoseOfFiniteDifferences) {
  const std::vector<double> sizes{1.0, 1.05, 0.9};
  const Bodies bodies(sizes);
  const auto rows = static_cast<int64_t>(sizes.size());
  const auto pose = bodies.one.pose.repeat({rows, 1, 1}) + 0.2 * normal({rows, 5, 3}, 13);
  const auto chartOf = [&](const Tensor& p) {
    return toChart(bodies.one.chart, p, bodies.foreseen, bodies.gate);
  };
  constexpr double kStep = 1e-5;
  std::vector<Tensor> columns;
  for (int64_t i = 0; i < 15; ++i) {
    auto step = torch::zeros({15}, torch::kFloat64);
    step[i] = kStep;
    const auto by = step.view({1, 5, 3});
    columns.push_back((chartOf(pose + by).value - chartOf(pose - by).value).flatten(1) /
                      (2.0 * kStep));
  }
  const auto numeric = std::get<1>(torch::slogdet(torch::stack(columns, 2)));
  EXPECT_LT((chartOf(pose).logDet - numeric).abs().max().item<double>(), 1e-5);
  EXPECT_GT((numeric[1] - numeric[2]).abs().item<double>(), 1e-3) << "lengths say nothing";
}

TEST(StandingLeg, KneesAreThoseOfLegsThatBend) {
  const Leg leg(1.0);
  EXPECT_EQ(kneesOf(leg.chart.parents, {3, 4}, leg.chart.lengths), (std::vector<int64_t>{2, 3}));
  // A foot on the root has no knee; a bone of no length bends nothing; two feet share one knee.
  EXPECT_EQ(kneesOf({-1, 0}, {1}, torch::tensor({0., 40.})), (std::vector<int64_t>{-1}));
  EXPECT_EQ(kneesOf({-1, 0, 1}, {2}, torch::tensor({0., 0., 40.})), (std::vector<int64_t>{-1}));
  EXPECT_EQ(kneesOf({-1, 0, 1, 1}, {2, 3}, torch::tensor({0., 40., 40., 40.})),
            (std::vector<int64_t>{1, -1}));
}

TEST(StandingLeg, AnImpossiblePlaceIsAimedAt) {
  Leg leg(1.0);
  leg.foreseen.places = leg.foreseen.places - torch::tensor({0., 30., 0.}, torch::kFloat64);
  const auto now =
      fromChart(leg.chart, torch::zeros({1, 5, 3}, torch::kFloat64), leg.foreseen, leg.gate);
  EXPECT_TRUE(now.isfinite().all().item<bool>());
  EXPECT_NEAR((now.select(1, 2) - now.select(1, 1)).norm().item<double>(), 40.0, 1e-9);
}

}  // namespace
}  // namespace marey::moglow
