// Whole sequences through the recurrent stack: poses that are known give every frame's inputs at
// once, so that only the product with the recurrent weights goes frame by frame.
#include <algorithm>
#include <atomic>
#include <numeric>

#include "nn/engine/stack_call.h"

namespace marey::nn {
namespace {

constexpr long kRowsTogether = 96;   ///< inputs of so many rows stay in the second-level cache
constexpr long kRowsBetween = 1024;  ///< rows of a product between two calls of `between`
constexpr long kFramesBetween = 8;   ///< frames of a recurrence between two calls
/// Members of a team go through their own sequences without waiting for each other where each has
/// this many rows at least; with fewer they share the weights of every frame.
constexpr long kRowsOfOwn = 8, kManyRowsOfOwn = 24;
constexpr size_t kCachedWeights = size_t{1} << 19;  ///< bytes that stay with every member

/// Boundaries of the members' sequences, with about as many frames for each.
std::vector<long> sharesByFrames(const FrameRows& frames, int members) {
  const long sequences = frames.first[1];
  std::vector<long> until(static_cast<size_t>(sequences), 0);
  for (long t = 0; t < frames.frames(); ++t)
    for (long b = 0;
         b < frames.first[static_cast<size_t>(t) + 1] - frames.first[static_cast<size_t>(t)]; ++b)
      ++until[static_cast<size_t>(b)];
  std::partial_sum(until.begin(), until.end(), until.begin());
  std::vector<long> out{0};
  for (int m = 1; m < members; ++m)
    out.push_back(std::lower_bound(until.begin(), until.end(), until.back() * m / members) -
                  until.begin());
  out.push_back(sequences);
  return out;
}

}  // namespace

void RecurrentStack::recurrence(const Layer& layer, size_t index, const FrameRows& frames,
                                StackState& state, const AlignedFloats& gates,
                                AlignedFloats& hidden, const std::function<void()>& between) const {
  const long stride = m_hiddenStride, width = columns();
  const auto rowOf = [&](long t) { return frames.first[static_cast<size_t>(t)]; };
  // Sequences [own.begin, own.end) at frame t.
  const auto frame = [&](long t, RowRange own, std::pair<long, long> blocks) {
    own.end = std::min(own.end, rowOf(t + 1) - rowOf(t));
    if (own.count() <= 0) return;
    const float* previous =
        t == 0 ? state.hidden[index].data() : hidden.data() + rowOf(t - 1) * stride;
    Call call{.first = layer.inputs,
              .start = gates.data() + rowOf(t) * width,
              .startStride = width,
              .previous = previous,
              .cell = m_shape.cell == Cell::Lstm ? state.cell[index].data() : nullptr,
              .hidden = hidden.data() + rowOf(t) * stride,
              .rows = own};
    call.inputs.add({previous, stride, m_shape.hidden});
    run(layer, call, blocks);
  };
  const int threads = teamThreads();
  const bool cached = layer.weights.bytes() * static_cast<size_t>(m_shape.hidden) <=
                      kCachedWeights * static_cast<size_t>(layer.weights.inputs());
  const long sequences = rowOf(1);
  const bool own = sequences >= threads * (cached ? kRowsOfOwn : kManyRowsOfOwn);
  const auto shares = sharesByFrames(frames, own ? threads : 1);
  for (long begin = 0; begin < frames.frames(); begin += kFramesBetween) {
    between();
    const long end = std::min(begin + kFramesBetween, frames.frames());
    runTeam(threads, [&](Team team) {
      // A team may turn out smaller than asked for.
      for (size_t part = static_cast<size_t>(team.rank()); own && part + 1 < shares.size();
           part += static_cast<size_t>(team.size()))
        for (long t = begin; t < end; ++t)
          frame(t, {shares[part], shares[part + 1]}, {0, blocks()});
      for (long t = begin; !own && t < end; ++t)
        team.divide(blocks(), [&](std::pair<long, long> some) { frame(t, {0, sequences}, some); });
    });
  }
  // The last frame of every sequence is where it goes on from.
  for (long t = 0; t < frames.frames(); ++t) {
    const long longer = t + 1 < frames.frames() ? rowOf(t + 2) - rowOf(t + 1) : 0;
    const float* last = hidden.data() + rowOf(t) * stride;
    std::copy(last + longer * stride, last + (rowOf(t + 1) - rowOf(t)) * stride,
              state.hidden[index].data() + longer * stride);
  }
}

Inputs RecurrentStack::forward(const FrameRows& frames, std::span<const Inputs> inputs,
                               StackState& state, Work& work,
                               const std::function<void()>& between) const {
  const long rows = frames.rows(), width = columns();
  const bool recurrent = m_shape.cell != Cell::Feedforward;
  if (recurrent) work.gates.reserve(rows * width);
  work.odd.reserve(rows * m_hiddenStride);
  work.even.reserve(rows * m_hiddenStride);
  InputRuns runs;
  for (const Inputs& run : inputs) runs.add(run);
  AlignedFloats* hidden = &work.even;
  for (size_t i = 0; i < m_layers.size(); ++i) {
    const Layer& layer = m_layers[i];
    for (long begin = 0; begin < rows; begin += kRowsBetween) {
      between();
      const long end = std::min(begin + kRowsBetween, rows);
      std::atomic<long> next = begin;
      runTeam(teamThreads(), [&](Team) {
        for (long row; (row = next.fetch_add(kRowsTogether)) < end;) {
          const RowRange part{row, std::min(row + kRowsTogether, end)};
          if (!recurrent) {
            run(layer,
                {.inputs = runs,
                 .start = layer.bias.data(),
                 .hidden = hidden->data(),
                 .rows = part},
                {0, blocks()});
            continue;
          }
          const auto own = runs.from(row);
          layer.weights.multiply({.inputs = {own.data(), runs.size()},
                                  .end = layer.weights.panels(),
                                  .start = layer.bias.data(),
                                  .out = work.gates.data() + row * width,
                                  .outStride = width,
                                  .rows = part.count()});
        }
      });
    }
    if (recurrent) recurrence(layer, i, frames, state, work.gates, *hidden, between);
    runs = {};
    runs.add({hidden->data(), m_hiddenStride, m_shape.hidden});
    hidden = hidden == &work.even ? &work.odd : &work.even;
  }
  return runs.from(0)[0];
}

}  // namespace marey::nn
