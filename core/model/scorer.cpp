#include "model/scorer.h"

#include <cmath>
#include <numbers>
#include <numeric>

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

ClipScore scoreSequence(const MotionModel& model, const FeatureSequence& features,
                        bool standardised) {
  const ModelInfo& info = model.info();
  if (features.frameCount() <= info.context)
    throwInput({.path = features.name},
               fmt::format("more than {} frames at {} per second (the model's context)",
                           info.context, info.features.fps),
               "{}", features.frameCount());
  const Matrix control = withLookahead(features.control, info.lookahead);
  const Matrix history = Eigen::Map<const Eigen::RowVectorXf>(
      features.pose.data(), static_cast<long>(info.context) * info.poseDim);
  RolloutState state = model.start(1, history);
  ClipScore out{.name = features.name, .firstFrame = info.context};
  const double shift = standardised ? 0.0 : info.standardiser.logDetPerFrame();
  for (long first = info.context; first < features.pose.rows(); first += kPiece) {
    const long count = std::min<long>(kPiece, features.pose.rows() - first);
    const SequenceScore piece = model.observe(
        state, features.pose.middleRows(first, count),
        control.middleRows(first - info.context, info.context + count + info.lookahead));
    for (long t = 0; t < count; ++t) {
      out.loglikNats.push_back(piece.loglikNats[static_cast<size_t>(t)] + shift);
      out.latentNorm.push_back(piece.latent.row(t).cast<double>().norm());
    }
  }
  out.bitsPerDimension = -out.meanNatsPerFrame() / (std::numbers::ln2 * info.poseDim);
  return out;
}

ClipScore scoreClip(const MotionModel& model, const Clip& clip, bool standardised) {
  const ModelInfo& info = model.info();
  const std::string& path = clip.source.path.empty() ? clip.name : clip.source.path;
  requireSameJoints(info, clip, path);
  FeatureSequence features = extractFeatures(clip, info.features);
  features.name = path;
  ClipScore out = scoreSequence(model, features, standardised);
  out.name = clip.name;
  return out;
}

}  // namespace marey
