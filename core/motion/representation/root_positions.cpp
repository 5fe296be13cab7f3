#include "motion/representation/root_positions.h"

#include "motion/representation/root_frame.h"
#include "motion/roles.h"

namespace marey {
namespace {

int joints(int width) {
  return width > 0 && width % 3 == 0 ? width / 3 : -1;
}

std::vector<Channel> channels(const Skeleton& skeleton) {
  std::vector<Channel> out;
  for (int j = 0; j < skeleton.jointCount(); ++j)
    for (const char* axis : {".x", ".y", ".z"})
      out.push_back({skeleton.names[static_cast<size_t>(j)] + axis, j, ChannelKind::Position});
  return out;
}

std::shared_ptr<const Skeleton> skeletonOf(const std::vector<Clip>& clips, const FeatureSpec&) {
  return clips.front().skeleton;
}

ReadyClip ready(Clip clip, const Skeleton&) {
  return {.clip = std::move(clip)};
}

Matrix encode(const Clip& clip, const Skeleton&, const std::vector<RootFrame>& trajectory) {
  Matrix out(clip.frameCount(), 3 * clip.jointCount());
  for (int t = 0; t < clip.frameCount(); ++t)
    for (int j = 0; j < clip.jointCount(); ++j)
      out.block<1, 3>(t, 3 * j) =
          toRootFrame(clip.at(t, j), trajectory[static_cast<size_t>(t)]).transpose();
  return out;
}

Clip decode(const Matrix& pose, const std::vector<RootFrame>& trajectory,
            std::shared_ptr<const Skeleton> skeleton) {
  const int joints = skeleton->jointCount();
  Clip out;
  out.skeleton = std::move(skeleton);
  out.positions.resize(static_cast<size_t>(pose.rows()) * static_cast<size_t>(joints));
  for (long t = 0; t < pose.rows(); ++t)
    for (int j = 0; j < joints; ++j)
      out.frame(static_cast<int>(t))[static_cast<size_t>(j)] =
          fromRootFrame(pose.block<1, 3>(t, 3 * j).transpose(), trajectory[static_cast<size_t>(t)]);
  return out;
}

Matrix mirror(const Matrix& pose, const Skeleton& skeleton) {
  const auto other = rolesOf(skeleton).mirror;
  Matrix out = pose;
  for (size_t j = 0; j < other.size(); ++j) {
    const long to = 3 * static_cast<long>(j), from = 3L * other[j];
    out.middleCols<3>(to) = pose.middleCols<3>(from);
    out.col(to) *= -1.f;
  }
  return out;
}

Matrix reverse(const Matrix& pose) {
  return pose.colwise().reverse();
}

}  // namespace

Representation rootPositions() {
  return {.name = "root-positions",
          .formerNames = {"positions"},
          .description = "joint positions in the root frame, three values per joint",
          .shownUnits = "cm",
          .rotations = false,
          .roundTripM = 1e-5,
          .joints = joints,
          .channels = channels,
          .skeletonOf = skeletonOf,
          .ready = ready,
          .encode = encode,
          .decode = decode,
          .mirror = mirror,
          .reverse = reverse};
}

}  // namespace marey
