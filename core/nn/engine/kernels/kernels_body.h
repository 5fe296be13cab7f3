// The kernels, written once over `Lanes`. Included by one source per instruction set after its
// lanes; everything is local to that source, so that no code of a higher instruction set can be
// linked into another's place. Includes no header that would bring shared inline functions.
#pragma once

#include "nn/engine/kernels/kernels.h"

namespace {

using marey::nn::CouplingBlock;
using marey::nn::GateBlock;
using marey::nn::Inputs;
using marey::nn::kLanes;
using marey::nn::kPanel;
using marey::nn::kRowColumns;
using marey::nn::PanelProduct;
using marey::nn::RowProduct;

// ---- Products

struct FloatWeights {
  static constexpr long kRowBytes = 4 * kPanel;
  static Lanes read(const std::byte* row, int half) {
    return load(reinterpret_cast<const float*>(row) + half * kLanes);
  }
};

struct Bf16Weights {
  static constexpr long kRowBytes = 2 * kPanel;
  static Lanes read(const std::byte* row, int half) { return loadBf16(row, half); }
};

constexpr long kFetchAhead = 2048;  ///< bytes; products with few rows wait for memory

/// Sums of `Rows` rows and `kTileLanes` vectors of columns in each of `Panels` panels. Four rows
/// share a pointer: as many pointers as rows would not fit the registers.
template <typename Weights, int Rows, int Panels>
struct Tile {
  static constexpr int kPointers = (Rows + 3) / 4;

  Lanes sums[Panels][Rows][kTileLanes];
  const char* x[kPointers];
  long step;

  inline __attribute__((always_inline)) float input(int row, int k) const {
    return *reinterpret_cast<const float*>(x[row / 4] + (row % 4) * step + 4 * k);
  }

  /// Input k of all rows, with its weights of all panels, `panelBytes` apart.
  inline __attribute__((always_inline)) void add(const std::byte* weights, long panelBytes, int k,
                                                 int half) {
#pragma GCC unroll 2
    for (int q = 0; q < Panels; ++q) {
      Lanes w[kTileLanes];
      for (int j = 0; j < kTileLanes; ++j)
        w[j] = Weights::read(weights + q * panelBytes + k * Weights::kRowBytes, half + j);
#pragma GCC unroll 16
      for (int r = 0; r < Rows; ++r) {
        const Lanes value = all(input(r, k));
#pragma GCC unroll 2
        for (int j = 0; j < kTileLanes; ++j) sums[q][r][j] = fma(value, w[j], sums[q][r][j]);
      }
    }
  }
};

/// Columns half * 16 .. of rows `first` .. first + Rows - 1. `fetch`: what is to be brought into
/// the cache meanwhile, as long as the panel; so for each of `Panels`.
template <typename Weights, int Rows, int Panels>
void tileProduct(const PanelProduct& p, long first, int half, const std::byte* fetch) {
  Tile<Weights, Rows, Panels> tile;
  const auto column = [&](int q, int j) { return q * kPanel + (half + j) * kLanes; };
  for (int q = 0; q < Panels; ++q)
    for (int r = 0; r < Rows; ++r)
      for (int j = 0; j < kTileLanes; ++j)
        tile.sums[q][r][j] = load(p.start + (first + r) * p.startStride + column(q, j));
  const std::byte* weights = p.panel;
  for (int i = 0; i < p.runs; ++i) {
    const Inputs& run = p.inputs[i];
    tile.step = 4 * run.stride;
    for (int q = 0; q < Tile<Weights, Rows, Panels>::kPointers; ++q)
      tile.x[q] = reinterpret_cast<const char*>(run.values + (first + 4 * q) * run.stride);
    const auto advance = [&](int inputs) {
      weights += inputs * Weights::kRowBytes;
      fetch += inputs * Weights::kRowBytes;
      for (auto& pointer : tile.x) pointer += 4 * inputs;
    };
    long left = run.count;
    for (; left >= 2; left -= 2) {
      for (int q = 0; q < Panels; ++q) {
        __builtin_prefetch(fetch + q * p.panelBytes, 0, 2);
        __builtin_prefetch(fetch + q * p.panelBytes + Weights::kRowBytes, 0, 2);
      }
      tile.add(weights, p.panelBytes, 0, half);
      tile.add(weights, p.panelBytes, 1, half);
      advance(2);
    }
    if (left > 0) {
      tile.add(weights, p.panelBytes, 0, half);
      advance(1);
    }
  }
  for (int q = 0; q < Panels; ++q)
    for (int r = 0; r < Rows; ++r)
      for (int j = 0; j < kTileLanes; ++j)
        store(p.out + (first + r) * p.outStride + column(q, j), tile.sums[q][r][j]);
}

using TileFunction = void (*)(const PanelProduct&, long, int, const std::byte*);

template <typename Weights, int Panels, int... Is>
struct TileTable {
  static constexpr TileFunction kByRows[] = {tileProduct<Weights, Is, Panels>...};
};

template <typename Weights, int Panels, int N, int... Is>
struct MakeTable : MakeTable<Weights, Panels, N - 1, N, Is...> {};
template <typename Weights, int Panels, int... Is>
struct MakeTable<Weights, Panels, 0, Is...> : TileTable<Weights, Panels, Is...> {};

template <typename Weights>
void panelProduct(const PanelProduct& p) {
  using Table = MakeTable<Weights, 1, kTileRows>;
  const long tiles = (p.rows + kTileRows - 1) / kTileRows;
  for (long t = 0; t < tiles; ++t) {
    const long first = t * p.rows / tiles, rows = (t + 1) * p.rows / tiles - first;
    // While the first rows are at work the next panel comes from memory, every second line in each
    // of two tiles. One tile alone is bound by memory: it reads ahead of itself.
    const std::byte* fetch = tiles == 1 ? p.panel + kFetchAhead : t < 2 ? p.next + 64 * t : p.panel;
    for (int half = 0; half < 2; half += kTileLanes)
      Table::kByRows[rows - 1](p, first, half, fetch);
  }
}

template <typename Weights>
void product(const PanelProduct& p) {
  // Few rows wait for memory, which gives more where it is read in two places at once.
  if (p.rows > 0 && p.rows <= kPairRows && p.panels == 2) {
    using Table = MakeTable<Weights, 2, kPairRows>;
    for (int half = 0; half < 2; half += kTileLanes)
      Table::kByRows[p.rows - 1](p, 0, half, p.panel + kFetchAhead);
    return;
  }
  PanelProduct one = p;
  for (long q = 0; q < p.panels; ++q) {
    one.panel = p.panel + q * p.panelBytes;
    one.next = q + 1 < p.panels ? one.panel + p.panelBytes : p.next;
    one.start = p.start + q * kPanel;
    one.out = p.out + q * kPanel;
    panelProduct<Weights>(one);
  }
}

// ---- Products in double precision

// Four numbers, in as many registers as the instruction set needs for them.
using Floats = float __attribute__((vector_size(16)));
using Doubles = double __attribute__((vector_size(32)));

/// Columns `first` .. of a row's product, 4 * `Blocks` of them.
template <int Blocks>
void rowColumns(const RowProduct& p, long first) {
  Doubles sums[Blocks];
  __builtin_memcpy(sums, p.out + first, sizeof(sums));
  for (long k = 0; k < p.inputs; ++k) {
    const double x = p.x[k];
    const float* row = p.weights + k * p.columns + first;
#pragma GCC unroll 8
    for (int b = 0; b < Blocks; ++b) {
      Floats w;
      __builtin_memcpy(&w, row + b * kRowColumns, sizeof(w));
      sums[b] += x * __builtin_convertvector(w, Doubles);
    }
  }
  __builtin_memcpy(p.out + first, sums, sizeof(sums));
}

void rowProduct(const RowProduct& p) {
  long at = 0;
  for (; at + 8 * kRowColumns <= p.columns; at += 8 * kRowColumns) rowColumns<8>(p, at);
  for (; at + 4 * kRowColumns <= p.columns; at += 4 * kRowColumns) rowColumns<4>(p, at);
  for (; at < p.columns; at += kRowColumns) rowColumns<1>(p, at);
}

// ---- Non-linearities

struct Reduced {
  Lanes power;  ///< 2^n
  Lanes rest;   ///< exp(r) - 1, x = n ln 2 + r, |r| <= ln 2 / 2
};

/// For |x| below 88.
inline Reduced reduced(Lanes x) {
  const Lanes round = all(12582912.f);  // 1.5 * 2^23: what is added to it becomes whole
  const Lanes n = (x * all(1.44269504f) + round) - round;
  // ln 2 in two parts, the first one exact in products with n.
  const Lanes r = fma(n, all(-1.42860677e-06f), fma(n, all(-0.693145752f), x));
  Lanes q = fma(r, all(1.f / 5040.f), all(1.f / 720.f));
  q = fma(q, r, all(1.f / 120.f));
  q = fma(q, r, all(1.f / 24.f));
  q = fma(q, r, all(1.f / 6.f));
  q = fma(q, r, all(0.5f));
  return {powerOfTwo(n), fma(r * r, q, r)};
}

/// A value as a fraction: factors share one division.
struct Fraction {
  Lanes above, below;
  Lanes value() const { return above / below; }
};

inline Fraction operator*(Fraction a, Fraction b) {
  return {a.above * b.above, a.below * b.below};
}

inline Fraction sigmoid(Lanes x) {
  const Reduced e = reduced(larger(all(0.f) - magnitude(x), all(-87.f)));
  const Lanes small = fma(e.power, e.rest, e.power);  // exp(-|x|), at most 1
  return {ifNegative(x, small, all(1.f)), all(1.f) + small};
}

inline Fraction hyperbolicTangent(Lanes x) {
  const Lanes twice = smaller(magnitude(x) + magnitude(x), all(40.f));
  const Reduced e = reduced(twice);
  const Lanes grown = fma(e.power, e.rest, e.power - all(1.f));  // exp(2|x|) - 1
  return {withSignOf(grown, x), grown + all(2.f)};
}

void lstm(const GateBlock& b) {
  for (long r = 0; r < b.rows; ++r) {
    const float* gates = b.gates + r * 4 * kLanes;
    float* cell = b.cell + r * b.cellStride;
    const Fraction fresh = sigmoid(load(gates)) * hyperbolicTangent(load(gates + 2 * kLanes));
    const Lanes forget = sigmoid(load(gates + kLanes)).value();
    const Lanes c = fma(forget, load(cell), fresh.value());
    store(cell, c);
    const Fraction out = sigmoid(load(gates + 3 * kLanes)) * hyperbolicTangent(c);
    store(b.hidden + r * b.stride, out.value());
  }
}

void gru(const GateBlock& b) {
  for (long r = 0; r < b.rows; ++r) {
    const float* gates = b.gates + r * 4 * kLanes;
    const Lanes reset = sigmoid(load(gates)).value(),
                update = sigmoid(load(gates + kLanes)).value();
    const Lanes fresh =
        hyperbolicTangent(fma(reset, load(gates + 3 * kLanes), load(gates + 2 * kLanes))).value();
    const Lanes old = load(b.previous + r * b.previousStride);
    store(b.hidden + r * b.stride, fma(update, old - fresh, fresh));
  }
}

void relu(float* values, long stride, long rows) {
  for (long r = 0; r < rows; ++r)
    for (long j = 0; j < kPanel; j += kLanes) {
      float* at = values + r * stride + j;
      store(at, larger(load(at), all(0.f)));
    }
}

inline Lanes scaleOf(const float* net) {
  return sigmoid(load(net + kLanes) + all(2.f)).value() + all(1e-6f);
}

void toData(const CouplingBlock& b) {
  for (long r = 0; r < b.rows; ++r) {
    const float* net = b.net + r * kPanel;
    float* at = b.channels + r * b.stride;
    store(at, load(at) / scaleOf(net) - load(net));
  }
}

void toLatent(const CouplingBlock& b) {
  for (long r = 0; r < b.rows; ++r) {
    const float* net = b.net + r * kPanel;
    float* at = b.channels + r * b.stride;
    const Lanes scale = scaleOf(net);
    store(at, (load(at) + load(net)) * scale);
    store(b.scales + r * kLanes, scale);
  }
}

void sigmoidOf(const float* x, float* y, long blocks) {
  for (long i = 0; i < blocks * kLanes; i += kLanes) store(y + i, sigmoid(load(x + i)).value());
}

void tanhOf(const float* x, float* y, long blocks) {
  for (long i = 0; i < blocks * kLanes; i += kLanes)
    store(y + i, hyperbolicTangent(load(x + i)).value());
}

}  // namespace

#include "nn/engine/kernels/training_body.h"

namespace {

constexpr marey::nn::Kernels kernelsNamed(const char* name) {
  return {name,
          product<FloatWeights>,
          product<Bf16Weights>,
          rowProduct,
          lstm,
          gru,
          relu,
          toData,
          toLatent,
          sigmoidOf,
          tanhOf,
          lstmForward,
          lstmBackward,
          gruForward,
          gruBackward,
          adam};
}

}  // namespace
