#include "motion/representation/joint_expmap.h"

#include "motion/kinematics.h"
#include "motion/representation/mirror_plan.h"
#include "motion/representation/rest_pose.h"
#include "motion/representation/root_frame.h"

namespace marey {
namespace {

/// Values before the rotations: the root's position.
constexpr long kPlace = 3;

int joints(int width) {
  return width > kPlace && width % 3 == 0 ? (width - static_cast<int>(kPlace)) / 3 : -1;
}

std::vector<Channel> channels(const Skeleton& skeleton) {
  std::vector<Channel> out;
  for (const char* axis : {".x", ".y", ".z"})
    out.push_back({skeleton.names.front() + axis, 0, ChannelKind::Position});
  for (int j = 0; j < skeleton.jointCount(); ++j)
    for (const char* axis : {".rx", ".ry", ".rz"})
      out.push_back({skeleton.names[static_cast<size_t>(j)] + axis, j, ChannelKind::Rotation});
  return out;
}

/// Exponential maps of rotations relative to the rest pose, without jumps.
class Logarithms {
 public:
  explicit Logarithms(const Skeleton& skeleton)
      : m_rest(restRotations(skeleton)), m_before(m_rest.size(), Vec3d::Zero()) {}

  /// Of one frame's local rotations, into `row`.
  void write(const std::vector<Quatd>& local, Matrix::RowXpr row) {
    for (size_t j = 0; j < local.size(); ++j) {
      m_before[j] = logNear(m_rest[j].conjugate() * local[j], m_before[j]);
      row.segment<3>(kPlace + 3 * static_cast<long>(j)) = m_before[j].transpose().cast<float>();
    }
  }

 private:
  std::vector<Quatd> m_rest;
  std::vector<Vec3d> m_before;
};

/// Local rotations of a row.
std::vector<Quatd> localRotations(const Matrix& pose, long t, const std::vector<Quatd>& rest) {
  std::vector<Quatd> out;
  for (size_t j = 0; j < rest.size(); ++j)
    out.push_back(
        rest[j] *
        expMap(
            pose.row(t).segment<3>(kPlace + 3 * static_cast<long>(j)).transpose().cast<double>()));
  return out;
}

Matrix encode(const Clip& clip, const Skeleton& skeleton,
              const std::vector<RootFrame>& trajectory) {
  const auto width = static_cast<size_t>(skeleton.jointCount());
  Matrix out(clip.frameCount(), kPlace + 3 * static_cast<long>(width));
  Logarithms logarithms(skeleton);
  std::vector<Quatd> local(width);
  for (int t = 0; t < clip.frameCount(); ++t) {
    const RootFrame& root = trajectory[static_cast<size_t>(t)];
    const size_t at = static_cast<size_t>(t) * width;
    for (size_t j = 0; j < width; ++j)
      local[j] = clip.transforms->rotations[at + j].cast<double>().normalized();
    local[0] = turnOf(root).conjugate() * local[0];
    out.block<1, kPlace>(t, 0) = toRootFrame(clip.transforms->translations[at], root).transpose();
    logarithms.write(local, out.row(t));
  }
  return out;
}

Clip decode(const Matrix& pose, const std::vector<RootFrame>& trajectory,
            std::shared_ptr<const Skeleton> skeleton) {
  const auto rest = restRotations(*skeleton);
  JointTransforms transforms;
  for (long t = 0; t < pose.rows(); ++t) {
    const RootFrame& root = trajectory[static_cast<size_t>(t)];
    std::vector<Quatd> local = localRotations(pose, t, rest);
    local[0] = turnOf(root) * local[0];
    for (const Quatd& q : local) transforms.rotations.push_back(q.normalized().cast<float>());
    transforms.translations.push_back(fromRootFrame(pose.block<1, kPlace>(t, 0).transpose(), root));
    transforms.translations.insert(transforms.translations.end(), skeleton->offsets.begin() + 1,
                                   skeleton->offsets.end());
  }
  Clip out;
  out.positions = forwardKinematics(*skeleton, transforms);
  out.transforms = std::move(transforms);
  out.skeleton = std::move(skeleton);
  return out;
}

Matrix mirror(const Matrix& pose, const Skeleton& skeleton) {
  const auto rest = restRotations(skeleton);
  const MirrorPlan plan(skeleton);
  Matrix out = pose;
  out.col(0) *= -1.f;
  Logarithms logarithms(skeleton);
  for (long t = 0; t < pose.rows(); ++t)
    logarithms.write(plan.mirrored(localRotations(pose, t, rest)), out.row(t));
  return out;
}

Matrix reverse(const Matrix& pose) {
  return pose.colwise().reverse();
}

}  // namespace

Representation jointExpmap() {
  return {.name = "joint-expmap",
          .formerNames = {},
          .description =
              "the root's place and every joint's rotation as an exponential map "
              "relative to the rest pose: bones are exact",
          .shownUnits = "cm and rad",
          .rotations = true,
          .roundTripM = 5e-5,
          .joints = joints,
          .channels = channels,
          .skeletonOf = withRestPose,
          .ready = withRotations,
          .encode = encode,
          .decode = decode,
          .mirror = mirror,
          .reverse = reverse};
}

}  // namespace marey
