// Internal to the two sources of the recurrent stack.
#pragma once

#include <array>

#include "nn/engine/recurrent_stack.h"

namespace marey::nn {

/// A few runs of inputs, without allocation.
class InputRuns {
 public:
  static constexpr size_t kMost = 4;

  void add(const Inputs& run) { m_runs[m_size++] = run; }
  size_t size() const { return m_size; }
  /// The same from another row on.
  std::array<Inputs, kMost> from(long row) const {
    auto out = m_runs;
    for (Inputs& run : out) run.values += row * run.stride;
    return out;
  }

 private:
  std::array<Inputs, kMost> m_runs{};
  size_t m_size = 0;
};

/// Pointers are to row 0.
struct RecurrentStack::Call {
  InputRuns inputs;
  long first = 0;  ///< input of the weights at which `inputs` begin
  const float* start = nullptr;
  long startStride = 0;
  const float* previous = nullptr;
  float* cell = nullptr;
  float* hidden = nullptr;
  RowRange rows;
};

}  // namespace marey::nn
