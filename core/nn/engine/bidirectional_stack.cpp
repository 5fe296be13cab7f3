#include "nn/engine/bidirectional_stack.h"

#include <algorithm>

namespace marey::nn {
namespace {

/// The row that comes in each one's place when every sequence is reversed. Its own inverse.
std::vector<long> reversedRows(const FrameRows& frames) {
  const auto first = [&](long t) { return frames.first[static_cast<size_t>(t)]; };
  std::vector<long> out(static_cast<size_t>(frames.rows()));
  long length = frames.frames();
  for (long b = 0; length > 0 && b < first(1); ++b) {
    // Longer sequences come first.
    while (first(length) - first(length - 1) <= b) --length;
    for (long t = 0; t < length; ++t)
      out[static_cast<size_t>(first(t) + b)] = first(length - 1 - t) + b;
  }
  return out;
}

}  // namespace

BidirectionalStack::BidirectionalStack(const StackShape& shape, Precision precision)
    : m_shape(shape) {
  for (long i = 0; i < shape.layers; ++i) {
    const StackShape one{.cell = shape.cell,
                         .inputs = i == 0 ? shape.inputs : outputs(),
                         .hidden = shape.hidden,
                         .layers = 1};
    m_layers.push_back({RecurrentStack(one, precision), RecurrentStack(one, precision)});
  }
}

void BidirectionalStack::setLayer(long layer, Way way, const LayerWeights& weights) {
  Layer& both = m_layers[static_cast<size_t>(layer)];
  (way == Way::Ahead ? both.ahead : both.back).setLayer(0, weights);
}

Inputs BidirectionalStack::forward(const FrameRows& frames, const Inputs& inputs, Work& work,
                                   const std::function<void()>& between) const {
  const long rows = frames.rows(), sequences = rows > 0 ? frames.first[1] : 0;
  // The last term keeps rows from falling on the same sets of the first-level cache.
  const long stride = outputs() + kLanes;
  const std::vector<long> reversed = reversedRows(frames);
  work.odd.reserve(rows * stride);
  work.even.reserve(rows * stride);
  AlignedFloats* out = &work.even;
  Inputs seen = inputs;
  for (const Layer& layer : m_layers) {
    work.reversed.reserve(rows * seen.count);
    for (long row = 0; row < rows; ++row)
      std::copy_n(seen.values + reversed[static_cast<size_t>(row)] * seen.stride, seen.count,
                  work.reversed.data() + row * seen.count);
    const Inputs back{work.reversed.data(), seen.count, seen.count};
    StackState state = layer.ahead.start(sequences);
    const Inputs ahead = layer.ahead.forward(frames, {&seen, 1}, state, work.stack, between);
    for (long row = 0; row < rows; ++row)
      std::copy_n(ahead.values + row * ahead.stride, m_shape.hidden, out->data() + row * stride);
    state = layer.back.start(sequences);
    const Inputs came = layer.back.forward(frames, {&back, 1}, state, work.stack, between);
    for (long row = 0; row < rows; ++row)
      std::copy_n(came.values + row * came.stride, m_shape.hidden,
                  out->data() + reversed[static_cast<size_t>(row)] * stride + m_shape.hidden);
    seen = {out->data(), stride, outputs()};
    out = out == &work.even ? &work.odd : &work.even;
  }
  return seen;
}

}  // namespace marey::nn
