// Recurrent layers one above the other (LSTM, GRU or plain layers with ReLU, PyTorch's definitions)
// on packed weights: the engine under every recurrent family. No libtorch type appears here and
// nothing is allocated while frames advance.
//
// What comes out for a row is the same bits whatever other rows are there, however many threads
// work and whether frames come one by one (`step`) or as sequences (`forward`).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "nn/engine/packed_matrix.h"
#include "nn/engine/team.h"

namespace marey::nn {

enum class Cell { Lstm, Gru, Feedforward };
/// "lstm", "gru" or "feedforward". Throws InputError for others.
Cell cellNamed(const std::string& name);
/// Groups of rows in PyTorch's weights: 4, 3, 1.
long gatesOf(Cell cell);

struct StackShape {
  Cell cell = Cell::Lstm;
  long inputs = 0;
  long hidden = 0;
  long layers = 1;
};

/// One layer's weights, row-major as in PyTorch; recurrent ones empty for plain layers.
struct LayerWeights {
  std::span<const float> input;      ///< [gates * hidden, inputs]
  std::span<const float> recurrent;  ///< [gates * hidden, hidden]
  std::span<const float> inputBias, recurrentBias;
};

/// Recurrent state of `rows` rollouts; a value: a copy goes its own way.
struct StackState {
  long rows = 0;
  std::vector<AlignedFloats> hidden, cell;  ///< per layer [rows, hiddenStride]
  std::vector<AlignedFloats> next;          ///< hidden of the frame that is being made
};

/// Rows [begin, end) of a batch.
struct RowRange {
  long begin = 0, end = 0;
  long count() const { return end - begin; }
};

/// Frames of sequences of different lengths, time-major: frame t of sequence b is row first[t] + b.
/// Longer sequences come first, so that frame t has its first[t + 1] - first[t] longest.
struct FrameRows {
  std::vector<long> first;  ///< [frames + 1]
  long frames() const { return static_cast<long>(first.size()) - 1; }
  long rows() const { return first.back(); }
  /// Throws nothing; `lengths` non-increasing.
  static FrameRows of(std::span<const long> lengths);
};

class RecurrentStack {
 public:
  RecurrentStack(const StackShape& shape, Precision precision);
  void setLayer(long layer, const LayerWeights& weights);
  /// What setLayer packed, [gates * hidden, width] row-major (rounded where precision is less).
  std::vector<float> inputWeights(long layer) const;
  std::vector<float> recurrentWeights(long layer) const;

  const StackShape& shape() const { return m_shape; }
  size_t bytes() const;
  StackState start(long rows) const;
  void copyRow(const StackState& from, long fromRow, StackState& to, long toRow) const;

  /// The next frame of some rows, every layer. `inputs` are those of the first layer, from row 0
  /// of the batch on; their counts add up to shape().inputs. The members of `team` share the
  /// rows. The outputs are in output(state) once every row is done; then advance(state).
  void step(Team& team, RowRange rows, std::span<const Inputs> inputs, StackState& state) const;
  /// Last layer of the frame just made, [rows, hiddenStride].
  Inputs output(const StackState& state) const;
  void advance(StackState& state) const;

  /// Memory of `forward`, kept from call to call.
  struct Work {
    AlignedFloats gates;      ///< [rows, columns]
    AlignedFloats odd, even;  ///< [rows, hiddenStride]: hidden of alternate layers
  };
  /// Whole sequences: what the inputs give as one product per layer, then frame by frame.
  /// `inputs` [frames.rows(), ...]; the sequences are the first rows of the state; the result is
  /// [frames.rows(), hiddenStride] within `work`. `between` is called every few frames and may
  /// throw.
  Inputs forward(const FrameRows& frames, std::span<const Inputs> inputs, StackState& state,
                 Work& work, const std::function<void()>& between) const;

 private:
  struct Layer {
    PackedMatrix weights;  ///< [inputs + hidden] -> blocks of units, gate by gate
    AlignedFloats bias;
    long inputs = 0;
  };
  struct Call;  ///< one layer, one frame
  void run(const Layer& layer, const Call& call, std::pair<long, long> blocks) const;
  void recurrence(const Layer& layer, size_t index, const FrameRows& frames, StackState& state,
                  const AlignedFloats& gates, AlignedFloats& hidden,
                  const std::function<void()>& between) const;
  long column(long gate, long unit) const;
  long blockUnits() const { return m_shape.cell == Cell::Feedforward ? kPanel : kLanes; }
  long blockPanels() const { return m_shape.cell == Cell::Feedforward ? 1 : 2; }
  long blocks() const { return (m_shape.hidden + blockUnits() - 1) / blockUnits(); }
  long columns() const { return blocks() * blockPanels() * kPanel; }

  StackShape m_shape;
  long m_hiddenStride = 0;
  std::vector<Layer> m_layers;
};

}  // namespace marey::nn
