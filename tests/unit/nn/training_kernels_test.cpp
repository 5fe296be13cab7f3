// The cells of training, every instruction set: forward against double precision, backward against
// finite differences of it.
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"
#include "nn/engine/kernels/kernels.h"

namespace marey::nn {
namespace {

constexpr long kRows = 3, kUnits = 32;

std::vector<float> noise(uint32_t sample, long count) {
  std::vector<float> out(static_cast<size_t>(count));
  fillNormal({.seed = 4, .sample = sample, .stage = RandomStage::Test}, out);
  return out;
}

double sigmoid(double x) {
  return 1.0 / (1.0 + std::exp(-x));
}

struct State {
  double cell, hidden;
};

/// One unit: pre-activations with their biases, the state before, GRU's share of the state in n.
struct Unit {
  double gates[4], previous, fromState;
  State lstm() const {
    const double cell = sigmoid(gates[1]) * previous + sigmoid(gates[0]) * std::tanh(gates[2]);
    return {cell, sigmoid(gates[3]) * std::tanh(cell)};
  }
  State gru() const {
    const double n = std::tanh(gates[2] + sigmoid(gates[0]) * fromState), z = sigmoid(gates[1]);
    return {0.0, (1.0 - z) * n + z * previous};
  }
};

class TrainingCells : public testing::TestWithParam<Isa> {
 protected:
  TrainingCells() {
    const Kernels* k = kernelsFor(GetParam());
    if (k != nullptr) kernels = *k;
  }
  void SetUp() override {
    if (kernelsFor(GetParam()) == nullptr) GTEST_SKIP() << "not on this processor";
  }

  Unit unit(long row, long u, bool lstm) const {
    Unit out{{}, previous[at(row, u)], lstm ? 0.0 : fromState[at(row, u)]};
    const long count = lstm ? 4 : 3;
    for (long g = 0; g < count; ++g)
      out.gates[g] = static_cast<double>(gates[gate(row, g, u, count)]) +
                     bias[static_cast<size_t>(g * kUnits + u)];
    return out;
  }
  static size_t at(long row, long u) { return static_cast<size_t>(row * kUnits + u); }
  static size_t gate(long row, long g, long u, long count) {
    return static_cast<size_t>((row * count + g) * kUnits + u);
  }
  TrainingRows rows(bool lstm) {
    return {.gates = work.data(),
            .bias = bias.data(),
            .biasGradient = biasGradient.data(),
            .previous = previous.data(),
            .cell = cell.data(),
            .hidden = hidden.data(),
            .fromState = fromStateWork.data(),
            .gradient = gradient.data(),
            .carried = carriedWork.data(),
            .gateStride = (lstm ? 4 : 3) * kUnits,
            .units = kUnits,
            .rows = kRows};
  }

  /// Of the sum of every hidden times its gradient and, for LSTM, every cell times its own.
  double slope(long row, long u, bool lstm, const std::function<void(Unit&, double)>& move) const {
    constexpr double kStep = 1e-5;
    double values[2];
    for (int side = 0; side < 2; ++side) {
      Unit moved = unit(row, u, lstm);
      move(moved, side == 0 ? -kStep : kStep);
      const State s = lstm ? moved.lstm() : moved.gru();
      values[side] = s.hidden * gradient[at(row, u)] + (lstm ? s.cell * carried[at(row, u)] : 0.0);
    }
    return (values[1] - values[0]) / (2.0 * kStep);
  }

  Kernels kernels{};
  std::vector<float> gates = noise(1, 4 * kRows * kUnits), bias = noise(2, 4 * kUnits),
                     previous = noise(3, kRows*kUnits), fromState = noise(4, kRows*kUnits),
                     gradient = noise(5, kRows*kUnits), carried = noise(6, kRows*kUnits),
                     biasGradient = noise(7, 4 * kUnits);
  std::vector<float> work = gates, fromStateWork = fromState, carriedWork = carried,
                     cell = noise(8, kRows*kUnits), hidden = cell;
};

constexpr double kTolerance = 1e-5;

TEST_P(TrainingCells, LstmHasTheValuesAndSlopesOfItsDefinition) {
  const std::vector<float> before = biasGradient;
  kernels.lstmForward(rows(true));
  for (long r = 0; r < kRows; ++r)
    for (long u = 0; u < kUnits; ++u) {
      EXPECT_NEAR(cell[at(r, u)], unit(r, u, true).lstm().cell, kTolerance);
      EXPECT_NEAR(hidden[at(r, u)], unit(r, u, true).lstm().hidden, kTolerance);
    }
  kernels.lstmBackward(rows(true));
  for (long u = 0; u < kUnits; ++u)
    for (long g = 0; g < 4; ++g) {
      double sum = before[static_cast<size_t>(g * kUnits + u)];
      for (long r = 0; r < kRows; ++r) {
        const double expected = slope(r, u, true, [&](Unit& x, double d) { x.gates[g] += d; });
        EXPECT_NEAR(work[gate(r, g, u, 4)], expected, kTolerance);
        sum += expected;
        EXPECT_NEAR(carriedWork[at(r, u)],
                    slope(r, u, true, [](Unit& x, double d) { x.previous += d; }), kTolerance);
      }
      EXPECT_NEAR(biasGradient[static_cast<size_t>(g * kUnits + u)], sum, kTolerance);
    }
}

TEST_P(TrainingCells, GruHasTheValuesAndSlopesOfItsDefinition) {
  const std::vector<float> before = biasGradient;
  kernels.gruForward(rows(false));
  for (long r = 0; r < kRows; ++r)
    for (long u = 0; u < kUnits; ++u)
      EXPECT_NEAR(hidden[at(r, u)], unit(r, u, false).gru().hidden, kTolerance);
  kernels.gruBackward(rows(false));
  for (long u = 0; u < kUnits; ++u) {
    double sums[4];
    for (long g = 0; g < 4; ++g) sums[g] = before[static_cast<size_t>(g * kUnits + u)];
    for (long r = 0; r < kRows; ++r) {
      for (long g = 0; g < 3; ++g) {
        const double expected = slope(r, u, false, [&](Unit& x, double d) { x.gates[g] += d; });
        EXPECT_NEAR(work[gate(r, g, u, 3)], expected, kTolerance);
        sums[g] += expected;
      }
      const double ofState = slope(r, u, false, [](Unit& x, double d) { x.fromState += d; });
      EXPECT_NEAR(fromStateWork[at(r, u)], ofState, kTolerance);
      sums[3] += ofState;
      EXPECT_NEAR(carriedWork[at(r, u)] - carried[at(r, u)],
                  slope(r, u, false, [](Unit& x, double d) { x.previous += d; }), kTolerance);
    }
    for (long g = 0; g < 4; ++g)
      EXPECT_NEAR(biasGradient[static_cast<size_t>(g * kUnits + u)], sums[g], kTolerance);
  }
}

INSTANTIATE_TEST_SUITE_P(Isas, TrainingCells, testing::Values(Isa::Generic, Isa::Avx2, Isa::Avx512),
                         [](const auto& info) {
                           return info.param == Isa::Generic ? "Generic"
                                  : info.param == Isa::Avx2  ? "Avx2"
                                                             : "Avx512";
                         });

}  // namespace
}  // namespace marey::nn
