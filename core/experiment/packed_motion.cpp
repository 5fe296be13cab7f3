#include "experiment/packed_motion.h"

#include <algorithm>
#include <chrono>

namespace marey {

void pack(const ClipScore& score, Packer& packer) {
  packer.add(score.name)
      .add(score.frames)
      .add(score.firstFrame)
      .add(score.unit)
      .add(score.bitsPerDimension)
      .add(score.loglikNats)
      .add(score.latentNorm)
      .add(score.linearGaussianNats)
      .add(score.oddestJoint);
}

ClipScore unpackScore(Unpacker& bytes) {
  ClipScore out;
  out.name = bytes.text();
  out.frames = bytes.number<int>();
  out.firstFrame = bytes.number<int>();
  out.unit = bytes.text();
  out.bitsPerDimension = bytes.number<double>();
  out.loglikNats = bytes.list<double>();
  out.latentNorm = bytes.list<double>();
  out.linearGaussianNats = bytes.list<double>();
  out.oddestJoint = bytes.list<int>();
  return out;
}

void pack(const Matrix& poses, Packer& packer) {
  packer.add(static_cast<long>(poses.cols()))
      .add(std::span<const float>(poses.data(), static_cast<size_t>(poses.size())));
}

Matrix unpackPoses(Unpacker& bytes) {
  const long cols = bytes.number<long>();
  const std::vector<float> values = bytes.list<float>();
  if (cols < 1 || static_cast<long>(values.size()) % cols != 0)
    throw Error(fmt::format("packed poses: expected rows of {} values, found {} in all", cols,
                            values.size()));
  Matrix out(static_cast<long>(values.size()) / cols, cols);
  std::copy(values.begin(), values.end(), out.data());
  return out;
}

std::vector<std::string> packedSamples(const MotionModel& model,
                                       std::span<const SampleRequest> requests, SamplingPace& pace,
                                       Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  const auto sampled = sampleSequences(model, requests, progress);
  pace.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (const SampleRequest& request : requests)
    pace.frames += static_cast<double>(request.samples) * static_cast<double>(request.path.size());
  std::vector<FeatureSequence> scored;
  for (const auto& ofRequest : sampled)
    scored.insert(scored.end(), ofRequest.begin(), ofRequest.end());
  Progress scoring = progress.part(1.0, 1.0);
  const auto scores = scoreSequences(model, scored, false, scoring);
  auto next = scores.begin();
  std::vector<std::string> out;
  for (const auto& ofRequest : sampled) {
    Packer packer;
    for (const FeatureSequence& sequence : ofRequest) {
      pack(sequence.pose, packer);
      pack(*next++, packer);
    }
    out.push_back(packer.take());
  }
  return out;
}

std::vector<ScoredSequence> unpackSamples(std::string_view bytes) {
  std::vector<ScoredSequence> out;
  for (Unpacker rest(bytes); !rest.done();) {
    Matrix poses = unpackPoses(rest);
    out.push_back({std::move(poses), unpackScore(rest)});
  }
  return out;
}

}  // namespace marey
