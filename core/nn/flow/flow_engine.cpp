#include "nn/flow/flow_engine.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

namespace marey::nn {
namespace {

/// Rows handled at once: their coupling nets' outputs stay in the first-level cache.
constexpr long kRowsTogether = 96;
/// With so many rows for each, threads take rollouts of their own and never wait for each other;
/// with fewer they share the weights, which are then what takes the time to read.
constexpr long kRowsOfOwn = 24;
/// Rows of a pass over sequences between two calls of `between`.
constexpr long kRowsBetween = 4096;

/// Of at most 16 scales, each above 1e-6: far from the smallest double.
double logOfProduct(const float* scales, long count) {
  double product = 1.0;
  for (long i = 0; i < count; ++i) product *= static_cast<double>(scales[i]);
  return std::log(product);
}

/// Rows of a pass in parts, taken up by whichever thread is free; results do not depend on it.
template <typename Work>
void forParts(long rows, const std::function<void()>& between, const Work& work) {
  for (long begin = 0; begin < rows; begin += kRowsBetween) {
    between();
    const long end = std::min(begin + kRowsBetween, rows);
    std::atomic<long> next = begin;
    runTeam(teamThreads(), [&](Team) {
      for (long row; (row = next.fetch_add(kRowsTogether)) < end;)
        work(RowRange{row, std::min(row + kRowsTogether, end)});
    });
  }
}

}  // namespace

FlowEngine::State FlowEngine::start(long rows) const {
  State out{.rows = rows};
  for (const Step& step : m_steps) out.steps.push_back(step.stack.start(rows));
  out.values = AlignedFloats(static_cast<size_t>(rows * m_stride));
  out.mixed = out.values;
  return out;
}

void FlowEngine::copyRow(const State& from, long fromRow, State& to, long toRow) const {
  for (size_t k = 0; k < m_steps.size(); ++k)
    m_steps[k].stack.copyRow(from.steps[k], fromRow, to.steps[k], toRow);
}

/// The coupling after its net's hidden layers; with `logDet` towards latents, else towards data.
void FlowEngine::couple(const Step& step, const Inputs& hidden, RowRange rows,
                        std::pair<long, long> blocks, float* values, double* logDet) const {
  const Kernels& k = kernels();
  alignas(64) std::array<float, kRowsTogether * kPanel> net;
  alignas(64) std::array<float, kRowsTogether * kLanes> scales;
  const long groups = (rows.count() + kRowsTogether - 1) / kRowsTogether;
  for (long g = 0; g < groups; ++g) {
    const long begin = rows.begin + g * rows.count() / groups,
               end = rows.begin + (g + 1) * rows.count() / groups;
    const Inputs own{hidden.values + begin * hidden.stride, hidden.stride, hidden.count};
    for (long b = blocks.first; b < blocks.second; ++b) {
      step.output.multiply({.inputs = {&own, 1},
                            .begin = b,
                            .end = b + 1,
                            .start = step.outputBias.data() + b * kPanel,
                            .out = net.data(),
                            .outStride = kPanel,
                            .rows = end - begin});
      const CouplingBlock block{.net = net.data(),
                                .channels = values + begin * m_stride + passed() + b * kLanes,
                                .stride = m_stride,
                                .scales = scales.data(),
                                .rows = end - begin};
      if (logDet == nullptr) {
        k.toData(block);
        continue;
      }
      k.toLatent(block);
      const long real = std::min(kLanes, m_channels - passed() - b * kLanes);
      for (long r = begin; r < end; ++r)
        logDet[r] += logOfProduct(scales.data() + (r - begin) * kLanes, real);
    }
  }
}

void FlowEngine::stepToData(Team& team, RowRange rows, State& state,
                            std::span<const Inputs> conditioning) const {
  float *values = state.values.data(), *mixed = state.mixed.data();
  std::array<Inputs, 3> inputs;
  for (size_t i = 0; i < conditioning.size(); ++i) inputs[i + 1] = conditioning[i];
  for (size_t k = m_steps.size(); k-- > 0;) {
    const Step& step = m_steps[k];
    inputs[0] = {values, m_stride, passed()};
    step.stack.step(team, rows, {inputs.data(), conditioning.size() + 1}, state.steps[k]);
    const Inputs hidden = step.stack.output(state.steps[k]);
    team.divide(blocks(), [&](std::pair<long, long> part) {
      couple(step, hidden, rows, part, values, nullptr);
    });
    team.divide(rows.count(), [&](std::pair<long, long> part) {
      const long begin = rows.begin + part.first;
      const Inputs own{values + begin * m_stride, m_stride, m_channels};
      step.toData.multiply({.inputs = {&own, 1},
                            .end = step.toData.panels(),
                            .start = step.toDataStart.data(),
                            .out = mixed + begin * m_stride,
                            .outStride = m_stride,
                            .rows = part.second - part.first});
    });
    std::swap(values, mixed);
  }
}

void FlowEngine::toData(State& state, std::span<const Inputs> conditioning) const {
  const int threads = teamThreads();
  const bool own = state.rows >= threads * kRowsOfOwn;
  runTeam(threads, [&](Team team) {
    const auto [begin, end] = team.share(state.rows);
    Team alone;
    if (own)
      stepToData(alone, {begin, end}, state, conditioning);
    else
      stepToData(team, {0, state.rows}, state, conditioning);
  });
  for (size_t k = 0; k < m_steps.size(); ++k) m_steps[k].stack.advance(state.steps[k]);
  if (m_steps.size() % 2 == 1) std::swap(state.values, state.mixed);
}

void FlowEngine::toLatent(const FrameRows& frames, std::span<const Inputs> conditioning,
                          State& state, Sequences& s, const std::function<void()>& between) const {
  const long rows = frames.rows();
  if (static_cast<long>(s.mixed.size()) < rows * m_stride)
    s.mixed = AlignedFloats(static_cast<size_t>(rows * m_stride));
  s.logDet.assign(static_cast<size_t>(rows), 0.0);
  std::array<Inputs, 3> inputs;
  for (size_t i = 0; i < conditioning.size(); ++i) inputs[i + 1] = conditioning[i];
  for (size_t k = 0; k < m_steps.size(); ++k) {
    const Step& step = m_steps[k];
    forParts(rows, between, [&](RowRange part) {
      const Inputs own{s.values.data() + part.begin * m_stride, m_stride, m_channels};
      step.toLatent.multiply({.inputs = {&own, 1},
                              .end = step.toLatent.panels(),
                              .start = step.toLatentStart.data(),
                              .out = s.mixed.data() + part.begin * m_stride,
                              .outStride = m_stride,
                              .rows = part.count()});
    });
    inputs[0] = {s.mixed.data(), m_stride, passed()};
    const Inputs hidden = step.stack.forward(frames, {inputs.data(), conditioning.size() + 1},
                                             state.steps[k], s.work, between);
    forParts(rows, between, [&](RowRange part) {
      couple(step, hidden, part, {0, blocks()}, s.mixed.data(), s.logDet.data());
      for (long r = part.begin; r < part.end; ++r) s.logDet[static_cast<size_t>(r)] += step.logDet;
    });
    std::swap(s.values, s.mixed);
  }
}

}  // namespace marey::nn
