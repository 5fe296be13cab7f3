// The inner loops of the engine, one set per instruction set, chosen at run time. No libtorch type
// and no allocation in here.
//
// Promise of every function: what it writes for one row depends on that row's values alone, never
// on how many rows are given, where a row stands among them or which thread runs it. Products add
// each output up in one chain over the inputs, in their order; general BLAS libraries choose
// another order for another shape. Avx2 and Avx512 use the same operations in the same order and
// give the same bits; Generic has no fused multiply-add and gives others. Products in double
// precision (rowProduct) are the same bits on all of them.
#pragma once

#include <cstddef>

namespace marey::nn {

enum class Isa { Generic, Avx2, Avx512 };

/// Columns of a panel of packed weights.
constexpr long kPanel = 32;
/// Lanes of a vector; recurrent units and flow channels go in blocks of this many.
constexpr long kLanes = 16;
/// Columns of a product in double precision go in blocks of this many.
constexpr long kRowColumns = 4;

/// A run of `count` consecutive inputs of every row.
struct Inputs {
  const float* values = nullptr;
  long stride = 0;  ///< floats from row to row
  long count = 0;
};

/// out[r][0..31] = start[r][0..31] + sum over the inputs of row r times the panel's rows; and so
/// the next panel's 32 columns, where there are two.
struct PanelProduct {
  const Inputs* inputs = nullptr;
  int runs = 0;
  const std::byte* panel = nullptr;  ///< [sum of counts, 32], float or bf16 (packed_matrix.h)
  int panels = 1;                    ///< 1 or 2
  long panelBytes = 0;               ///< from one panel to the next
  const std::byte* next = nullptr;   ///< panel that will be wanted after them; fetched meanwhile
  const float* start = nullptr;
  long startStride = 0;  ///< 0: the same for every row
  float* out = nullptr;
  long outStride = 0;
  long rows = 0;  ///< none is allowed: a member of a team may have no share
};

/// out[j] += sum over k of x[k] * weights[k][j], in the order of k, in double precision. Every
/// product is rounded before it is added: one result on all sets.
struct RowProduct {
  const double* x = nullptr;
  long inputs = 0;
  const float* weights = nullptr;  ///< [inputs, columns]
  long columns = 0;                ///< a multiple of kRowColumns
  double* out = nullptr;           ///< [columns]
};

/// A block of `kLanes` recurrent units. Gates [rows, 64] in four groups of 16: LSTM i, f, g, o;
/// GRU r, z, what the input gives to n, what the state gives to n (PyTorch's definitions).
struct GateBlock {
  const float* gates = nullptr;
  const float* previous = nullptr;  ///< [rows, 16] hidden, `stride` apart (GRU)
  float* cell = nullptr;            ///< [rows, 16], `stride` apart, updated in place (LSTM)
  float* hidden = nullptr;          ///< [rows, 16], `stride` apart
  long stride = 0, previousStride = 0, cellStride = 0;
  long rows = 0;
};

/// A block of `kLanes` channels of an affine coupling; `net` [rows, 32]: 16 shifts, 16 raw scales;
/// scale = sigmoid(raw + 2) + 1e-6.
struct CouplingBlock {
  const float* net = nullptr;
  float* channels = nullptr;  ///< [rows, 16], `stride` apart, changed in place
  long stride = 0;
  float* scales = nullptr;  ///< [rows, 16] or null: where toLatent leaves its scales
  long rows = 0;
};

/// Rows of one frame of a recurrent layer that is trained. Matrices of units are [rows, units]
/// without gaps; gates come in PyTorch's order, each `units` wide. Forward turns what the products
/// gave into activations, in place; backward turns these into the gradients of what it was given.
struct TrainingRows {
  float* gates = nullptr;           ///< [rows, gates * units], `gateStride` apart
  const float* bias = nullptr;      ///< [gates * units]; forward
  float* biasGradient = nullptr;    ///< [4 * units], added to; GRU: r, z, n and that of fromState
  const float* previous = nullptr;  ///< LSTM cell, GRU hidden of the frame before; null: zeros
  float* cell = nullptr;            ///< LSTM
  float* hidden = nullptr;          ///< forward
  float* fromState = nullptr;       ///< GRU: what the state gives to n; backward: its gradient
  const float* gradient = nullptr;  ///< of the loss by `hidden`; backward
  /// Backward. LSTM: the gradient by the cell, of later frames in, for earlier ones out. GRU: the
  /// gradient by the frame before's hidden, added to; null at the first frame.
  float* carried = nullptr;
  long gateStride = 0;
  long units = 0;  ///< a multiple of kLanes
  long rows = 0;
};

/// One step of Adam on `blocks` * 16 values, whose gradients are first clamped to +-limit and then
/// scaled.
struct AdamStep {
  float* parameter = nullptr;
  float* mean = nullptr;
  float* square = nullptr;
  const float* gradient = nullptr;
  float limit = 0.f, gradientScale = 1.f;
  float beta1 = 0.f, beta2 = 0.f, epsilon = 0.f;
  float rest1 = 0.f, rest2 = 0.f;  ///< 1 - beta: a difference in float32 would be too coarse
  float rate = 0.f;                ///< with the correction of the mean
  float squareScale = 0.f;         ///< correction of the square's root
  long blocks = 0;
};

struct Kernels {
  const char* name;
  void (*product)(const PanelProduct&);
  void (*productBf16)(const PanelProduct&);
  void (*rowProduct)(const RowProduct&);
  void (*lstm)(const GateBlock&);
  void (*gru)(const GateBlock&);
  void (*relu)(float* values, long stride, long rows);  ///< [rows, 32] in place
  void (*toData)(const CouplingBlock&);                 ///< z2 / scale - shift
  void (*toLatent)(const CouplingBlock&);               ///< (z2 + shift) * scale
  /// 1 / (1 + exp(-x)) and tanh(x) of `blocks` * 16 values: within 4 ulp of the exact value
  /// (sigmoid of arguments below -87 is not smaller than that of -87).
  void (*sigmoid)(const float* x, float* y, long blocks);
  void (*tanh)(const float* x, float* y, long blocks);
  void (*lstmForward)(const TrainingRows&);
  void (*lstmBackward)(const TrainingRows&);
  void (*gruForward)(const TrainingRows&);
  void (*gruBackward)(const TrainingRows&);
  void (*adam)(const AdamStep&);
};

/// The set that MAREY_ISA names (generic, avx2 or avx512), else the best that this processor runs;
/// chosen once. Throws UsageError, which names what this machine has, for one that it has not:
/// programs ask for it before anything else.
const Kernels& kernels();
/// One particular set, for tests; null where this build or processor lacks it.
const Kernels* kernelsFor(Isa isa);

}  // namespace marey::nn
