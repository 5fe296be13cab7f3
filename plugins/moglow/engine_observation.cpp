// Scoring with the engine: many sequences at once, piece by piece in time.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/error.h"
#include "model/model_parts.h"
#include "moglow/engine_rollout.h"

namespace marey::moglow {
namespace {

/// Frames of all sequences in one piece: enough for full-speed products, a few MB of memory.
constexpr long kPieceRows = 2048;

/// Log-density of a latent under the base distribution (nn::baseLogDensity), in double.
class BaseDensity {
 public:
  BaseDensity(double df, long channels) : m_df(df), m_channels(static_cast<double>(channels)) {
    m_constant = df <= 0.0 ? -0.5 * m_channels * std::log(2.0 * std::numbers::pi)
                           : std::lgamma(0.5 * (df + m_channels)) - std::lgamma(0.5 * df) -
                                 0.5 * m_channels * std::log(df * std::numbers::pi);
  }
  double at(const float* latent) const {
    double squared = 0.0;
    for (long j = 0; j < static_cast<long>(m_channels); ++j)
      squared += static_cast<double>(latent[j]) * static_cast<double>(latent[j]);
    if (m_df <= 0.0) return m_constant - 0.5 * squared;
    return m_constant - 0.5 * (m_df + m_channels) * std::log1p(squared / m_df);
  }

 private:
  double m_df, m_channels, m_constant = 0.0;
};

}  // namespace

/// One call of observeMany. Sequences are in order of falling length, so that those that still go
/// on are always the first ones.
class EngineModel::Observation {
 public:
  Observation(const EngineModel& model, std::span<RolloutState> states,
              std::span<const ObservedSequence> sequences);
  std::vector<SequenceScore> run(const std::function<void()>& between);

 private:
  struct Lane {
    size_t index;  ///< in the caller's order
    long frames;
    nn::AlignedFloats poses, controls;  ///< standardised; the history before the poses
    nn::AlignedFloats targets;          ///< standardised; empty where the poses are scored
  };
  void addLane(Rollout& rollout, const ObservedSequence& sequence, size_t index);
  /// Frames begin .. of every sequence that has them.
  void piece(long begin, long frames, const std::function<void()>& between);
  void gather(const nn::FrameRows& frames, long begin);
  void seeBase(long rows);
  void keep(const nn::FrameRows& frames, long begin);

  const EngineModel& m_model;
  std::vector<Rollout*> m_rollouts;
  std::vector<Lane> m_lanes;
  nn::FlowEngine::State m_state;
  std::vector<SequenceScore> m_scores;
  // A piece's rows: history, control, poses, what the nets see of a base, innovations.
  nn::AlignedFloats m_history, m_control, m_poses, m_features, m_innovation;
  std::vector<RowForesight> m_foreseen;
  std::vector<double> m_baseLogDet;
  nn::FlowEngine::Sequences m_sequences;
};

void EngineModel::Observation::addLane(Rollout& rollout, const ObservedSequence& sequence,
                                       size_t index) {
  const Config& c = m_model.m_config;
  const Standardiser& units = m_model.m_units;
  const Matrix &poses = *sequence.poses, &controls = *sequence.controls;
  if (rollout.flow.rows != 1 || poses.cols() != c.poseDim || controls.cols() != c.controlDim ||
      controls.rows() != poses.rows() + c.tau + c.lookahead)
    throwInput({.path = "observed sequence"},
               fmt::format("one rollout, T x {} poses and {} + T + {} x {} controls", c.poseDim,
                           c.tau, c.lookahead, c.controlDim),
               "{} rollouts, {} x {} and {} x {}", rollout.flow.rows, poses.rows(), poses.cols(),
               controls.rows(), controls.cols());
  if (sequence.targets != nullptr &&
      (sequence.targets->rows() != poses.rows() || sequence.targets->cols() != poses.cols()))
    throwInput({.path = "observed sequence"},
               fmt::format("targets of {} x {}", poses.rows(), poses.cols()), "{} x {}",
               sequence.targets->rows(), sequence.targets->cols());
  const long history = m_model.historyWidth();
  Lane lane{
      index, poses.rows(), nn::AlignedFloats(static_cast<size_t>(history + poses.size())),
      nn::AlignedFloats(static_cast<size_t>(controls.size())),
      nn::AlignedFloats(sequence.targets ? static_cast<size_t>(sequence.targets->size()) : 0)};
  std::copy(rollout.history.data(), rollout.history.data() + history, lane.poses.data());
  standardise(poses.data(), poses.size(), units.poseMean, units.poseStd,
              lane.poses.data() + history);
  standardise(controls.data(), controls.size(), units.controlMean, units.controlStd,
              lane.controls.data());
  if (sequence.targets != nullptr)
    standardise(sequence.targets->data(), sequence.targets->size(), units.poseMean, units.poseStd,
                lane.targets.data());
  m_scores[index].latent.resize(poses.rows(), poses.cols());
  m_scores[index].loglikNats.resize(static_cast<size_t>(poses.rows()));
  m_rollouts.push_back(&rollout);
  m_lanes.push_back(std::move(lane));
}

EngineModel::Observation::Observation(const EngineModel& model, std::span<RolloutState> states,
                                      std::span<const ObservedSequence> sequences)
    : m_model(model),
      m_state(model.m_flow.start(static_cast<long>(states.size()))),
      m_scores(states.size()) {
  std::vector<size_t> order(sequences.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return sequences[a].poses->rows() > sequences[b].poses->rows();
  });
  for (const size_t i : order) {
    addLane(std::any_cast<Rollout&>(states[i].value), sequences[i], i);
    m_model.m_flow.copyRow(m_rollouts.back()->flow, 0, m_state,
                           static_cast<long>(m_rollouts.size()) - 1);
  }
}

void EngineModel::Observation::gather(const nn::FrameRows& frames, long begin) {
  const long d = m_model.m_config.poseDim, c = m_model.m_config.controlDim, rows = frames.rows(),
             history = m_model.historyWidth(), control = m_model.controlWidth();
  m_history.reserve(rows * history);
  m_control.reserve(rows * control);
  m_poses.reserve(rows * d);
  for (long t = 0; t < frames.frames(); ++t)
    for (long row = frames.first[static_cast<size_t>(t)];
         row < frames.first[static_cast<size_t>(t) + 1]; ++row) {
      const Lane& lane = m_lanes[static_cast<size_t>(row - frames.first[static_cast<size_t>(t)])];
      const float *pose = lane.poses.data() + (begin + t) * d,
                  *window = lane.controls.data() + (begin + t) * c;
      std::copy(pose, pose + history, m_history.data() + row * history);
      const float* target =
          lane.targets.size() > 0 ? lane.targets.data() + (begin + t) * d : pose + history;
      std::copy(target, target + d, m_poses.data() + row * d);
      std::copy(window, window + control, m_control.data() + row * control);
    }
}

void EngineModel::Observation::seeBase(long rows) {
  const long d = m_model.m_config.poseDim, passed = m_model.m_config.passedChannels(),
             features = m_model.featureWidth();
  m_features.reserve(rows * features);
  m_innovation.reserve(rows * d);
  m_baseLogDet.resize(static_cast<size_t>(rows));
  m_model.m_base->foresee(rows, m_history.data(), m_control.data(), m_features.data(), features,
                          m_foreseen);
  m_model.m_base->toInnovation(m_foreseen, m_poses.data(), m_innovation.data(),
                               m_baseLogDet.data());
  for (long row = 0; row < rows; ++row) {
    const float* e = m_innovation.data() + row * d;
    std::copy(e, e + passed, m_features.data() + (row + 1) * features - passed);
  }
}

void EngineModel::Observation::keep(const nn::FrameRows& frames, long begin) {
  const bool based = m_model.m_base != nullptr;
  const long d = m_model.m_config.poseDim, passed = m_model.m_config.passedChannels();
  const BaseDensity density(m_model.m_config.degreesOfFreedom(), d);
  for (long t = 0; t < frames.frames(); ++t)
    for (long row = frames.first[static_cast<size_t>(t)];
         row < frames.first[static_cast<size_t>(t) + 1]; ++row) {
      const Lane& lane = m_lanes[static_cast<size_t>(row - frames.first[static_cast<size_t>(t)])];
      SequenceScore& score = m_scores[lane.index];
      float* latent = score.latent.row(begin + t).data();
      if (passed > 0)
        std::copy(m_innovation.data() + row * d, m_innovation.data() + row * d + passed, latent);
      const float* values = m_sequences.values.data() + row * m_model.m_flow.stride();
      std::copy(values, values + d - passed, latent + passed);
      const auto at = static_cast<size_t>(row);
      score.loglikNats[static_cast<size_t>(begin + t)] =
          density.at(latent) + m_sequences.logDet[at] + (based ? m_baseLogDet[at] : 0.0);
    }
}

void EngineModel::Observation::piece(long begin, long count, const std::function<void()>& between) {
  std::vector<long> lengths;
  for (const Lane& lane : m_lanes)
    if (lane.frames > begin) lengths.push_back(std::min(count, lane.frames - begin));
  const auto frames = nn::FrameRows::of(lengths);
  const long rows = frames.rows(), d = m_model.m_config.poseDim,
             passed = m_model.m_config.passedChannels(), stride = m_model.m_flow.stride();
  gather(frames, begin);
  between();
  if (m_model.m_base) seeBase(rows);
  m_sequences.values.reserve(rows * stride);
  const float* data = m_model.m_base ? m_innovation.data() : m_poses.data();
  for (long row = 0; row < rows; ++row)
    std::copy(data + row * d + passed, data + (row + 1) * d,
              m_sequences.values.data() + row * stride);
  const long history = m_model.historyWidth(), control = m_model.controlWidth(),
             features = m_model.featureWidth();
  const std::array<nn::Inputs, 2> plain{
      {{m_history.data(), history, history}, {m_control.data(), control, control}}};
  const nn::Inputs seen{m_features.data(), features, features};
  m_model.m_flow.toLatent(frames, m_model.m_base ? std::span<const nn::Inputs>(&seen, 1) : plain,
                          m_state, m_sequences, between);
  keep(frames, begin);
}

std::vector<SequenceScore> EngineModel::Observation::run(const std::function<void()>& between) {
  long begin = 0;
  for (long going = static_cast<long>(m_lanes.size()); going > 0;) {
    const long count = std::max(8L, kPieceRows / going);
    piece(begin, count, between);
    begin += count;
    while (going > 0 && m_lanes[static_cast<size_t>(going) - 1].frames <= begin) --going;
  }
  for (size_t i = 0; i < m_lanes.size(); ++i) {
    const Lane& lane = m_lanes[i];
    const long history = m_model.historyWidth();
    const float* last = lane.poses.data() + lane.frames * m_model.m_config.poseDim;
    std::copy(last, last + history, m_rollouts[i]->history.data());
    m_model.m_flow.copyRow(m_state, static_cast<long>(i), m_rollouts[i]->flow, 0);
  }
  return std::move(m_scores);
}

std::vector<SequenceScore> EngineModel::observeMany(std::span<RolloutState> states,
                                                    std::span<const ObservedSequence> sequences,
                                                    const std::function<void()>& between) const {
  return Observation(*this, states, sequences).run(between);
}

}  // namespace marey::moglow
