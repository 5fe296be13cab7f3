#include "experiment/packed_motion.h"

#include <algorithm>

namespace marey {

void pack(const ClipScore& score, Packer& packer) {
  packer.add(score.name)
      .add(score.firstFrame)
      .add(score.bitsPerDimension)
      .add(score.loglikNats)
      .add(score.latentNorm);
}

ClipScore unpackScore(Unpacker& bytes) {
  ClipScore out;
  out.name = bytes.text();
  out.firstFrame = bytes.number<int>();
  out.bitsPerDimension = bytes.number<double>();
  out.loglikNats = bytes.list<double>();
  out.latentNorm = bytes.list<double>();
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

}  // namespace marey
