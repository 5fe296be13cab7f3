#include "model/scorer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "base/error.h"
#include "model/linear_gaussian.h"
#include "model/pose_units.h"
#include "motion/main_body.h"

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
  if (loglikNats.empty()) return std::numeric_limits<double>::quiet_NaN();
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

/// One of the draws of a model's observation noise, or none.
struct Draw {
  int index = 0;
  bool noisy = false;
  double weight = 1.0;
  Eigen::VectorXf scale;  ///< floorScales
};

Eigen::VectorXf floatScales(const ModelInfo& info) {
  const auto scales = floorScales(channelsOf(info));
  return Eigen::Map<const Eigen::VectorXd>(scales.data(), static_cast<long>(scales.size()))
      .cast<float>();
}

/// Adds a piece's share to the mean over the draws. Frames are those of the clip.
void add(const SequenceScore& piece, long first, double weight, ClipScore& out) {
  for (long t = 0; t < static_cast<long>(piece.loglikNats.size()); ++t) {
    const auto at = static_cast<size_t>(first - out.firstFrame + t);
    out.loglikNats[at] += weight * piece.loglikNats[static_cast<size_t>(t)];
    if (piece.latent.cols() > 0)
      out.latentNorm[at] += weight * piece.latent.row(t).cast<double>().norm();
  }
}

/// Lanes in order of falling length, so that those that still go on are always the first ones.
void scoreGroup(const MotionModel& model, const std::vector<Lane>& lanes, const Draw& draw,
                Progress& progress, std::vector<ClipScore>& out) {
  const ModelInfo& info = model.info();
  const DensityEstimator& density = *model.density();
  std::vector<RolloutState> states;
  states.reserve(lanes.size());
  for (const Lane& lane : lanes)
    states.push_back(density.start(
        1, Eigen::Map<const Eigen::RowVectorXf>(lane.features->pose.data(),
                                                static_cast<long>(info.context) * info.poseDim)));
  const long longest = lanes.front().features->pose.rows();
  for (long first = info.context; first < longest; first += kPiece) {
    std::vector<Matrix> poses, controls, targets;
    for (const Lane& lane : lanes) {
      const long count = std::min<long>(kPiece, lane.features->pose.rows() - first);
      if (count <= 0) break;
      poses.emplace_back(lane.features->pose.middleRows(first, count));
      if (draw.noisy)
        targets.emplace_back(poses.back() + observationNoise(info.observation, draw.index, first,
                                                             count, info.poseDim) *
                                                draw.scale.asDiagonal());
      controls.emplace_back(
          lane.control.middleRows(first - info.context, info.context + count + info.lookahead));
    }
    std::vector<ObservedSequence> observed;
    for (size_t i = 0; i < poses.size(); ++i)
      observed.push_back({&poses[i], &controls[i], draw.noisy ? &targets[i] : nullptr});
    const auto scores = density.observeMany(std::span(states).first(observed.size()), observed,
                                            [&] { progress.throwIfCancelled(); });
    for (size_t i = 0; i < scores.size(); ++i)
      add(scores[i], first, draw.weight, out[lanes[i].index]);
    progress.report(static_cast<double>(first + kPiece) / static_cast<double>(longest + kPiece),
                    "scoring");
  }
}

/// Every draw of the model's noise, or the poses as they are.
void scoreDraws(const MotionModel& model, const std::vector<Lane>& lanes, Progress& progress,
                std::vector<ClipScore>& out) {
  const ObservationNoise& noise = model.info().observation;
  const int draws = std::max(1, noise.draws);
  const Eigen::VectorXf scale = floatScales(model.info());
  for (int i = 0; i < draws; ++i) {
    Progress part = progress.part(static_cast<double>(i) / draws, (i + 1.0) / draws);
    scoreGroup(model, lanes, {i, !noise.none(), 1.0 / draws, scale}, part, out);
  }
}

/// What is known of a score before its frames are.
ClipScore begun(const ModelInfo& info, const FeatureSequence& features) {
  ClipScore out{.name = features.name, .frames = features.frameCount(), .firstFrame = info.context};
  if (info.density == DensityKind::None) return out;
  const auto scored = static_cast<size_t>(std::max(0, out.frames - info.context));
  out.loglikNats.assign(scored, 0.0);
  out.latentNorm.assign(scored, 0.0);
  return out;
}

/// Three coordinates of every joint, in order.
bool arePositions(const std::vector<Channel>& channels) {
  for (size_t i = 0; i < channels.size(); ++i)
    if (channels[i].kind != ChannelKind::Position || channels[i].joint != static_cast<int>(i / 3))
      return false;
  return true;
}

void finish(const ModelInfo& info, const FeatureSequence& features, bool standardised,
            ClipScore& out) {
  const auto channels = channelsOf(info);
  const double logDet = toShownPerFrame(info.standardiser, channels);
  out.unit = standardised || info.standardiser.empty() ? kStandardisedUnit : likelihoodUnit(info);
  for (double& nats : out.loglikNats) nats += standardised ? 0.0 : logDet;
  out.bitsPerDimension = -out.meanNatsPerFrame() / (std::numbers::ln2 * info.poseDim);
  if (!info.yardstick || out.loglikNats.empty()) return;
  out.linearGaussianNats = logDensity(*info.yardstick, features, out.firstFrame);
  // Of poses in their own units.
  const double shift = (standardised ? 0.0 : logDet) - info.standardiser.logDetPerFrame();
  for (double& nats : out.linearGaussianNats) nats += shift;
  if (info.skeleton && arePositions(channels))
    out.oddestJoint = leastExplainedJoints(*info.yardstick, features, out.firstFrame);
}

}  // namespace

std::vector<ClipScore> scoreSequences(const MotionModel& model,
                                      std::span<const FeatureSequence> sequences, bool standardised,
                                      Progress& progress) {
  const ModelInfo& info = model.info();
  std::vector<ClipScore> out;
  std::vector<size_t> order;
  for (size_t i = 0; i < sequences.size(); ++i) {
    out.push_back(begun(info, sequences[i]));
    if (!out.back().loglikNats.empty()) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return sequences[a].frameCount() > sequences[b].frameCount();
  });
  const auto all = static_cast<double>(order.size());
  for (size_t first = 0; first < order.size(); first += kTogether) {
    const size_t last = std::min(first + kTogether, order.size());
    std::vector<Lane> lanes;
    for (size_t i = first; i < last; ++i)
      lanes.push_back({order[i], &sequences[order[i]],
                       withLookahead(sequences[order[i]].control, info.lookahead)});
    Progress part =
        progress.part(static_cast<double>(first) / all, static_cast<double>(last) / all);
    scoreDraws(model, lanes, part, out);
  }
  for (size_t i = 0; i < out.size(); ++i) finish(info, sequences[i], standardised, out[i]);
  return out;
}

ClipScore scoreSequence(const MotionModel& model, const FeatureSequence& features,
                        bool standardised) {
  Progress progress;
  requireFrames(model.info(), features.frameCount(), fewestFrames(model.info()),
                {.path = features.name});
  return std::move(scoreSequences(model, {&features, 1}, standardised, progress).front());
}

std::vector<ClipScore> scoreClips(const MotionModel& model, std::span<const Clip> clips,
                                  bool standardised, Progress& progress) {
  std::vector<FeatureSequence> sequences;
  for (const Clip& clip : clips) {
    progress.throwIfCancelled();
    const std::string& path = clip.source.path.empty() ? clip.name : clip.source.path;
    requireSameJoints(model.info(), clip, path);
    sequences.push_back(featuresOf(model.info(), clip));
    sequences.back().name = path;
  }
  auto out = scoreSequences(model, sequences, standardised, progress);
  for (size_t i = 0; i < out.size(); ++i) out[i].name = clips[i].name;
  return out;
}

std::string whyNotScored(const ModelInfo& info, const Clip& clip) {
  if (const int joints = jointsOf(info); clip.jointCount() != joints)
    return fmt::format("another skeleton ({} joints, the model has {} joints)", clip.jointCount(),
                       joints);
  if (!info.skeleton || clip.skeleton->names == info.skeleton->names) return {};
  return otherJoints(*clip.skeleton, *info.skeleton);
}

ClipScore scoreClip(const MotionModel& model, const Clip& clip, bool standardised) {
  Progress progress;
  const std::string& path = clip.source.path.empty() ? clip.name : clip.source.path;
  requireSameJoints(model.info(), clip, path);
  FeatureSequence features = featuresOf(model.info(), clip);
  features.name = path;
  ClipScore out = scoreSequence(model, features, standardised);
  out.name = clip.name;
  return out;
}

}  // namespace marey
