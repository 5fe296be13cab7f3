#include "model/scorer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "base/error.h"

namespace marey {
namespace {

/// Frames scored at once: bounds the memory of long clips; the state runs on between pieces.
constexpr int kPiece = 512;

Matrix withLookahead(const Matrix& control, int lookahead) {
  Matrix out(control.rows() + lookahead, control.cols());
  out.topRows(control.rows()) = control;
  for (int i = 0; i < lookahead; ++i) out.row(control.rows() + i) = control.row(control.rows() - 1);
  return out;
}

}  // namespace

double ClipScore::meanNatsPerFrame() const {
  return std::accumulate(loglikNats.begin(), loglikNats.end(), 0.0) /
         static_cast<double>(loglikNats.size());
}

namespace {

/// Sequences that advance together: enough for full-speed products.
constexpr size_t kTogether = 64;

/// A sequence on its way.
struct Lane {
  size_t index;  ///< in the caller's order
  const FeatureSequence* features;
  Matrix control;  ///< with look-ahead
};

void check(const ModelInfo& info, const FeatureSequence& features) {
  if (features.frameCount() <= info.context)
    throwInput({.path = features.name},
               fmt::format("more than {} frames at {} per second (the model's context)",
                           info.context, info.features.fps),
               "{}", features.frameCount());
}

void append(const SequenceScore& piece, double shift, ClipScore& out) {
  for (long t = 0; t < piece.latent.rows(); ++t) {
    out.loglikNats.push_back(piece.loglikNats[static_cast<size_t>(t)] + shift);
    out.latentNorm.push_back(piece.latent.row(t).cast<double>().norm());
  }
}

/// Lanes in order of falling length, so that those that still go on are always the first ones.
void scoreGroup(const MotionModel& model, const std::vector<Lane>& lanes, double shift,
                Progress& progress, std::vector<ClipScore>& out) {
  const ModelInfo& info = model.info();
  std::vector<RolloutState> states;
  for (const Lane& lane : lanes)
    states.push_back(model.start(
        1, Eigen::Map<const Eigen::RowVectorXf>(lane.features->pose.data(),
                                                static_cast<long>(info.context) * info.poseDim)));
  const long longest = lanes.front().features->pose.rows();
  for (long first = info.context; first < longest; first += kPiece) {
    std::vector<Matrix> poses, controls;
    for (const Lane& lane : lanes) {
      const long count = std::min<long>(kPiece, lane.features->pose.rows() - first);
      if (count <= 0) break;
      poses.emplace_back(lane.features->pose.middleRows(first, count));
      controls.emplace_back(
          lane.control.middleRows(first - info.context, info.context + count + info.lookahead));
    }
    std::vector<ObservedSequence> observed;
    for (size_t i = 0; i < poses.size(); ++i) observed.push_back({&poses[i], &controls[i]});
    const auto scores = model.observeMany(std::span(states).first(observed.size()), observed,
                                          [&] { progress.throwIfCancelled(); });
    for (size_t i = 0; i < scores.size(); ++i) append(scores[i], shift, out[lanes[i].index]);
    progress.report(static_cast<double>(first + kPiece) / static_cast<double>(longest + kPiece),
                    "scoring");
  }
}

}  // namespace

std::vector<ClipScore> scoreSequences(const MotionModel& model,
                                      std::span<const FeatureSequence> sequences, bool standardised,
                                      Progress& progress) {
  const ModelInfo& info = model.info();
  for (const FeatureSequence& features : sequences) check(info, features);
  std::vector<size_t> order(sequences.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return sequences[a].frameCount() > sequences[b].frameCount();
  });
  std::vector<ClipScore> out(sequences.size());
  const double shift = standardised ? 0.0 : info.standardiser.logDetPerFrame();
  const auto all = static_cast<double>(order.size());
  for (size_t first = 0; first < order.size(); first += kTogether) {
    const size_t last = std::min(first + kTogether, order.size());
    std::vector<Lane> lanes;
    for (size_t i = first; i < last; ++i)
      lanes.push_back({order[i], &sequences[order[i]],
                       withLookahead(sequences[order[i]].control, info.lookahead)});
    Progress part =
        progress.part(static_cast<double>(first) / all, static_cast<double>(last) / all);
    scoreGroup(model, lanes, shift, part, out);
  }
  for (size_t i = 0; i < out.size(); ++i) {
    out[i].name = sequences[i].name;
    out[i].firstFrame = info.context;
    out[i].bitsPerDimension = -out[i].meanNatsPerFrame() / (std::numbers::ln2 * info.poseDim);
  }
  return out;
}

ClipScore scoreSequence(const MotionModel& model, const FeatureSequence& features,
                        bool standardised) {
  Progress progress;
  return std::move(scoreSequences(model, {&features, 1}, standardised, progress).front());
}

std::vector<ClipScore> scoreClips(const MotionModel& model, std::span<const Clip> clips,
                                  bool standardised, Progress& progress) {
  std::vector<FeatureSequence> sequences;
  for (const Clip& clip : clips) {
    progress.throwIfCancelled();
    const std::string& path = clip.source.path.empty() ? clip.name : clip.source.path;
    requireSameJoints(model.info(), clip, path);
    sequences.push_back(extractFeatures(clip, model.info().features));
    sequences.back().name = path;
  }
  auto out = scoreSequences(model, sequences, standardised, progress);
  for (size_t i = 0; i < out.size(); ++i) out[i].name = clips[i].name;
  return out;
}

ClipScore scoreClip(const MotionModel& model, const Clip& clip, bool standardised) {
  Progress progress;
  return std::move(scoreClips(model, {&clip, 1}, standardised, progress).front());
}

}  // namespace marey
