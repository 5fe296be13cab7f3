// The engine's inner loops, every instruction set that this processor runs, against double
// precision; and that a row's result depends on nothing but the row.
#include "nn/engine/kernels/kernels.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"
#include "nn/engine/packed_matrix.h"
#include "nn/engine/recurrent_stack.h"
#include "nn/engine/row_matrix.h"

namespace marey::nn {
namespace {

std::vector<float> noise(uint32_t sample, size_t count) {
  std::vector<float> out(count);
  fillNormal({.seed = 2, .sample = sample, .stage = RandomStage::Test}, out);
  return out;
}

std::vector<Isa> available() {
  std::vector<Isa> out;
  for (const Isa isa : {Isa::Generic, Isa::Avx2, Isa::Avx512})
    if (kernelsFor(isa) != nullptr) out.push_back(isa);
  return out;
}

std::string nameOf(const testing::TestParamInfo<Isa>& isa) {
  return kernelsFor(isa.param)->name;
}

class EveryIsa : public testing::TestWithParam<Isa> {
 protected:
  const Kernels& kernels() const { return *kernelsFor(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Kernels, EveryIsa, testing::ValuesIn(available()), nameOf);

struct Problem {
  long rows, first, second;  ///< inputs in two runs
  std::vector<float> a, b, panel, start;

  Problem(long r, long f, long s)
      : rows(r),
        first(f),
        second(s),
        a(noise(1, static_cast<size_t>(r * f))),
        b(noise(2, static_cast<size_t>(r * s))),
        panel(noise(3, static_cast<size_t>((f + s) * kPanel))),
        start(noise(4, static_cast<size_t>(kPanel))) {}

  std::vector<float> run(const Kernels& kernels, long from, long count) const {
    std::vector<float> out(static_cast<size_t>(count * kPanel));
    const Inputs inputs[] = {{a.data() + from * first, first, first},
                             {b.data() + from * second, second, second}};
    const auto* weights = reinterpret_cast<const std::byte*>(panel.data());
    kernels.product({.inputs = inputs,
                     .runs = 2,
                     .panel = weights,
                     .next = weights,
                     .start = start.data(),
                     .out = out.data(),
                     .outStride = kPanel,
                     .rows = count});
    return out;
  }

  double exact(long row, long column) const {
    double sum = start[static_cast<size_t>(column)];
    for (long k = 0; k < first + second; ++k)
      sum += static_cast<double>(k < first ? a[static_cast<size_t>(row * first + k)]
                                           : b[static_cast<size_t>(row * second + k - first)]) *
             panel[static_cast<size_t>(k * kPanel + column)];
    return sum;
  }
};

TEST_P(EveryIsa, ProductsAreThoseOfDoublePrecision) {
  for (const long rows : {1L, 2L, 5L, 6L, 7L, 12L, 13L, 25L, 40L}) {
    const Problem p(rows, 31, 18);
    const auto got = p.run(kernels(), 0, rows);
    for (long r = 0; r < rows; ++r)
      for (long c = 0; c < kPanel; ++c)
        EXPECT_NEAR(got[static_cast<size_t>(r * kPanel + c)], p.exact(r, c), 2e-5)
            << rows << " rows, " << r << ", " << c;
  }
}

TEST_P(EveryIsa, ARowsProductIsTheSameBitsWhateverOtherRowsThereAre) {
  const Problem p(40, 37, 64);
  const auto together = p.run(kernels(), 0, 40);
  for (long from = 0; from < 40; ++from)
    for (const long count : {1L, 3L, 12L, 13L}) {
      if (from + count > 40) continue;
      const auto part = p.run(kernels(), from, count);
      EXPECT_TRUE(std::equal(part.begin(), part.end(), together.begin() + from * kPanel))
          << from << ", " << count;
    }
}

TEST_P(EveryIsa, TwoPanelsAtOnceAreTheSameBitsAsEachAlone) {
  constexpr long kInputs = 37;
  const auto x = noise(5, 20 * kInputs), panels = noise(6, 2 * kInputs * kPanel),
             start = noise(7, 2 * kPanel);
  for (const auto product : {kernels().product, kernels().productBf16}) {
    const long panelBytes =
        kInputs * kPanel * (product == kernels().product ? sizeof(float) : sizeof(uint16_t));
    for (const long rows : {0L, 1L, 2L, 3L, 4L, 5L, 12L, 20L}) {
      const Inputs run{x.data(), kInputs, kInputs};
      std::vector<float> both(static_cast<size_t>(rows * 2 * kPanel)), each(both.size());
      PanelProduct p{.inputs = &run,
                     .runs = 1,
                     .panel = reinterpret_cast<const std::byte*>(panels.data()),
                     .panels = 2,
                     .panelBytes = panelBytes,
                     .start = start.data(),
                     .out = both.data(),
                     .outStride = 2 * kPanel,
                     .rows = rows};
      p.next = p.panel;
      product(p);
      p.panels = 1;
      for (const long q : {0L, 1L}) {
        p.panel = reinterpret_cast<const std::byte*>(panels.data()) + q * panelBytes;
        p.start = start.data() + q * kPanel;
        p.out = each.data() + q * kPanel;
        product(p);
      }
      EXPECT_TRUE(std::equal(both.begin(), both.end(), each.begin(),
                             [](float a, float b) {
                               return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b);
                             }))
          << rows << " rows";
    }
  }
}

TEST_P(EveryIsa, ARowOfBf16WeightsIsTheRowOfTheirValues) {
  const long inputs = 45;
  PackedMatrix narrow(inputs, kPanel, Precision::BFloat16);
  Problem p(9, 20, 25);
  for (long c = 0; c < kPanel; ++c) {
    std::vector<float> column(static_cast<size_t>(inputs));
    for (long k = 0; k < inputs; ++k)
      column[static_cast<size_t>(k)] = p.panel[static_cast<size_t>(k * kPanel + c)];
    narrow.set(c, 0, column);
    narrow.get(c, 0, column);
    for (long k = 0; k < inputs; ++k)
      p.panel[static_cast<size_t>(k * kPanel + c)] = column[static_cast<size_t>(k)];
  }
  const auto wanted = p.run(kernels(), 0, 9);
  std::vector<float> got(wanted.size());
  const Inputs runs[] = {{p.a.data(), 20, 20}, {p.b.data(), 25, 25}};
  // What PackedMatrix stores is read here by every instruction set, not only by the best.
  std::vector<uint16_t> stored(static_cast<size_t>(inputs * kPanel));
  for (long k = 0; k < inputs; ++k)
    for (long c = 0; c < kPanel; ++c)
      stored[static_cast<size_t>(k * kPanel + 2 * (c % kLanes) + c / kLanes)] =
          static_cast<uint16_t>(
              std::bit_cast<uint32_t>(p.panel[static_cast<size_t>(k * kPanel + c)]) >> 16);
  const auto* weights = reinterpret_cast<const std::byte*>(stored.data());
  kernels().productBf16({.inputs = runs,
                         .runs = 2,
                         .panel = weights,
                         .next = weights,
                         .start = p.start.data(),
                         .out = got.data(),
                         .outStride = kPanel,
                         .rows = 9});
  EXPECT_EQ(got, wanted);
}

TEST_P(EveryIsa, ProductsInDoublePrecisionAreTheSameBitsAsAPlainLoop) {
  for (const long columns : {4L, 16L, 20L, 32L, 64L, 100L}) {
    const auto weights = noise(8, static_cast<size_t>(37 * columns)), inputs = noise(9, 37);
    std::vector<double> x(inputs.begin(), inputs.end());
    for (double& value : x) value /= 3.0;  // not a float: its products round
    std::vector<double> got(static_cast<size_t>(columns), 0.5), wanted = got;
    for (size_t k = 0; k < x.size(); ++k)
      for (size_t j = 0; j < wanted.size(); ++j)
        wanted[j] += x[k] * static_cast<double>(weights[k * wanted.size() + j]);
    kernels().rowProduct({.x = x.data(),
                          .inputs = 37,
                          .weights = weights.data(),
                          .columns = columns,
                          .out = got.data()});
    EXPECT_EQ(got, wanted) << columns << " columns";
  }
}

TEST(RowMatrix, HasTheColumnsThatItWasGivenAndZerosAfterThem) {
  const auto weights = noise(8, 5 * 6);
  const std::vector<double> x{1, 2, 3, 4, 5};
  const RowMatrix matrix(5, 6, weights);
  std::vector<float> turned(30);
  for (size_t k = 0; k < 5; ++k)
    for (size_t j = 0; j < 6; ++j) turned[j * 5 + k] = weights[k * 6 + j];
  std::vector<double> got(8), other(8);
  ASSERT_EQ(matrix.paddedColumns(), 8);
  matrix.addTo(x, got);
  RowMatrix::transposed(5, 6, turned).addTo(x, other);
  EXPECT_EQ(got, other);
  EXPECT_EQ(got[6], 0.0);
  double third = 0.0;
  for (size_t k = 0; k < 5; ++k) third += x[k] * static_cast<double>(weights[k * 6 + 3]);
  EXPECT_EQ(got[3], third);
}

/// Distance in units of the last place of the exact value.
double ulps(float got, double exact) {
  const auto nearest = static_cast<float>(exact);
  const double unit =
      std::max<double>(std::nextafter(std::fabs(nearest), std::numeric_limits<float>::infinity()) -
                           static_cast<double>(std::fabs(nearest)),
                       std::numeric_limits<float>::denorm_min());
  return std::fabs(got - exact) / unit;
}

/// From tiny to saturated, both signs.
std::vector<float> arguments() {
  std::vector<float> out;
  for (int i = 0; i < 100000; ++i) {
    const double u = (i + 0.5) / 100000.0;
    out.push_back(static_cast<float>(-86.0 + 172.0 * u));
    out.push_back(static_cast<float>((i % 2 ? 1.0 : -1.0) * std::pow(10.0, -8.0 + 9.0 * u)));
  }
  out.resize(out.size() / kLanes * kLanes);
  return out;
}

TEST_P(EveryIsa, SigmoidAndTanhAreWithinFourUnitsOfTheLastPlace) {
  const auto x = arguments();
  std::vector<float> s(x.size()), t(x.size());
  kernels().sigmoid(x.data(), s.data(), static_cast<long>(x.size()) / kLanes);
  kernels().tanh(x.data(), t.data(), static_cast<long>(x.size()) / kLanes);
  double worstSigmoid = 0.0, worstTanh = 0.0;
  for (size_t i = 0; i < x.size(); ++i) {
    worstSigmoid = std::max(worstSigmoid, ulps(s[i], 1.0 / (1.0 + std::exp(-double{x[i]}))));
    worstTanh = std::max(worstTanh, ulps(t[i], std::tanh(double{x[i]})));
  }
  EXPECT_LT(worstSigmoid, 4.0);
  EXPECT_LT(worstTanh, 4.0);
  EXPECT_GT(worstSigmoid + worstTanh, 0.4) << "the measure finds no rounding at all";
}

TEST_P(EveryIsa, NonLinearitiesKeepTheirLimitsAndNaN) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::nanf("");
  std::vector<float> x(kLanes, 0.f), s(kLanes), t(kLanes);
  x[1] = inf;
  x[2] = -inf;
  x[3] = nan;
  x[4] = -0.f;
  kernels().sigmoid(x.data(), s.data(), 1);
  kernels().tanh(x.data(), t.data(), 1);
  EXPECT_EQ(s[0], 0.5f);
  EXPECT_EQ(s[1], 1.f);
  EXPECT_LT(s[2], 1e-37f);
  EXPECT_TRUE(std::isnan(s[3]));
  EXPECT_EQ(t[0], 0.f);
  EXPECT_EQ(t[1], 1.f);
  EXPECT_EQ(t[2], -1.f);
  EXPECT_TRUE(std::isnan(t[3]));
  EXPECT_TRUE(std::signbit(t[4]));
}

TEST_P(EveryIsa, AValueIsTheSameBitsInEveryLane) {
  for (const float value : {0.3f, -4.f, 17.f, -1e-3f}) {
    const std::vector<float> x(kLanes, value);
    std::vector<float> s(kLanes), t(kLanes);
    kernels().sigmoid(x.data(), s.data(), 1);
    kernels().tanh(x.data(), t.data(), 1);
    EXPECT_EQ(std::count(s.begin(), s.end(), s[0]), kLanes);
    EXPECT_EQ(std::count(t.begin(), t.end(), t[0]), kLanes);
  }
}

TEST(Kernels, Avx2AndAvx512GiveTheSameBits) {
  const Kernels *a = kernelsFor(Isa::Avx2), *b = kernelsFor(Isa::Avx512);
  if (a == nullptr || b == nullptr) GTEST_SKIP() << "this processor has not both";
  const Problem p(29, 31, 100);
  EXPECT_EQ(p.run(*a, 0, 29), p.run(*b, 0, 29));
  const auto x = arguments();
  const auto blocks = static_cast<long>(x.size()) / kLanes;
  std::vector<float> u(x.size()), v(x.size());
  a->sigmoid(x.data(), u.data(), blocks);
  b->sigmoid(x.data(), v.data(), blocks);
  EXPECT_EQ(u, v);
  a->tanh(x.data(), u.data(), blocks);
  b->tanh(x.data(), v.data(), blocks);
  EXPECT_EQ(u, v);
}

TEST(PackedMatrix, GivesBackWhatWasSetAndRoundsHalvesToEven) {
  PackedMatrix full(5, 70, Precision::Float32), narrow(5, 70, Precision::BFloat16);
  for (long c = 0; c < 70; ++c) {
    const auto weights = noise(static_cast<uint32_t>(c), 5);
    full.set(c, 0, weights);
    std::vector<float> back(5);
    full.get(c, 0, back);
    EXPECT_EQ(back, weights);
  }
  // 1 + 1/256 lies half-way between two values of 8 bits; so does 1 + 3/256.
  narrow.set(69, 1, std::vector<float>{1.f + 1.f / 256.f, 1.f + 3.f / 256.f, -1.0001f});
  std::vector<float> back(5);
  narrow.get(69, 0, back);
  EXPECT_EQ(back, (std::vector<float>{0.f, 1.f, 1.f + 4.f / 256.f, -1.f, 0.f}));
}

TEST(FrameRows, LongerSequencesComeFirstInEveryFrame) {
  const std::vector<long> lengths{4, 2, 2, 1};
  const auto frames = FrameRows::of(lengths);
  EXPECT_EQ(frames.first, (std::vector<long>{0, 4, 7, 8, 9}));
  EXPECT_EQ(frames.frames(), 4);
  EXPECT_EQ(frames.rows(), 9);
  EXPECT_EQ(FrameRows::of({}).rows(), 0);
}

}  // namespace
}  // namespace marey::nn
