// A flow on packed weights: what sampling and scoring run on. The same function as Flow (flow.h),
// which stays as the plain path that this one is tested against. No libtorch type
// appears here.
//
// Against the plain path: weights lie in the order in which they are read; the coupling net's first
// layer takes [z1, conditioning, state] as one product without gathering them; gates follow each
// product while it is in the cache; inverse linear layer and actnorm are one matrix and one vector
// per step; nothing is allocated from frame to frame. Each product of the conditioning is part of
// that chain: a product for all K steps ahead would do the same sums and move 13 MB more through
// memory for 100 samples of the published size.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/tensor_file.h"
#include "nn/engine/recurrent_stack.h"
#include "nn/flow/flow_spec.h"

namespace marey::nn {

/// Name ("step0_actnorm.bias") and shape of every tensor of the flow, as stored.
std::vector<std::pair<std::string, std::vector<int64_t>>> flowTensors(const FlowSpec& spec);

class FlowEngine {
 public:
  /// Reads the tensors of `flowTensors`, stored with `prefix` before their names, and takes the
  /// large ones out of `file`, so that they are held once. Throws InputError for a singular linear
  /// layer.
  FlowEngine(const FlowSpec& spec, TensorFile& file, const std::string& prefix, Precision precision,
             const std::string& origin);
  /// Puts the large tensors back (rounded, where the precision is less).
  void restore(TensorFile& file) const;

  long channels() const { return m_channels; }
  Precision precision() const { return m_precision; }
  size_t bytes() const;

  /// Recurrent state and working memory of `rows` rollouts; a value.
  struct State {
    long rows = 0;
    std::vector<StackState> steps;
    AlignedFloats values, mixed;  ///< [rows, stride()]
  };
  State start(long rows) const;
  /// The recurrent state of a row of one batch becomes that of a row of another.
  void copyRow(const State& from, long fromRow, State& to, long toRow) const;
  long stride() const { return m_stride; }

  /// One frame: state.values holds latents [rows, channels] before and data after it.
  /// `conditioning`: at most two runs, from row 0 on.
  void toData(State& state, std::span<const Inputs> conditioning) const;

  /// Memory of `toLatent`, kept from call to call; `values` [frames.rows(), stride()].
  struct Sequences {
    AlignedFloats values, mixed;
    std::vector<double> logDet;  ///< [frames.rows()]
    RecurrentStack::Work work;
  };
  /// Whole sequences: sequences.values holds data before and latents after it.
  /// `between` is called every few frames and may throw.
  void toLatent(const FrameRows& frames, std::span<const Inputs> conditioning, State& state,
                Sequences& sequences, const std::function<void()>& between) const;

 private:
  struct Step {
    RecurrentStack stack;
    PackedMatrix output;  ///< [hidden] -> blocks of 16 shifts and 16 scales
    AlignedFloats outputBias;
    PackedMatrix toData, toLatent;  ///< actnorm and linear layer in one
    AlignedFloats toDataStart, toLatentStart;
    double logDet = 0.0;  ///< of those two layers
  };
  Step packed(long index, TensorFile& file, const std::string& origin) const;
  void packMixing(Step& step, const std::string& prefix, const TensorFile& file,
                  const std::string& origin) const;
  void stepToData(Team& team, RowRange rows, State& state,
                  std::span<const Inputs> conditioning) const;
  void couple(const Step& step, const Inputs& hidden, RowRange rows, std::pair<long, long> blocks,
              float* values, double* logDet) const;
  long passed() const { return m_channels / 2; }
  long blocks() const { return (m_channels - passed() + kLanes - 1) / kLanes; }
  StackShape stackShape() const;

  FlowSpec m_spec;
  std::string m_prefix;
  Precision m_precision;
  long m_channels, m_stride;
  std::vector<Step> m_steps;
};

}  // namespace marey::nn
