// Scores and motions as bytes, between the processes of a run.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/packing.h"
#include "model/sampler.h"
#include "model/scorer.h"

namespace marey {

void pack(const ClipScore& score, Packer& packer);
ClipScore unpackScore(Unpacker& bytes);
/// Poses alone: the receiver knows control and start.
void pack(const Matrix& poses, Packer& packer);
Matrix unpackPoses(Unpacker& bytes);

/// Sampled motions with their scores.
struct ScoredSequence {
  Matrix poses;
  ClipScore score;
};
/// Frames sampled, and the time that took without scoring.
struct SamplingPace {
  double frames = 0.0, seconds = 0.0;
};
/// Samples the requests as one batch and scores what came of it: one packed result per request.
std::vector<std::string> packedSamples(const MotionModel& model,
                                       std::span<const SampleRequest> requests, SamplingPace& pace,
                                       Progress& progress);
std::vector<ScoredSequence> unpackSamples(std::string_view bytes);

}  // namespace marey
