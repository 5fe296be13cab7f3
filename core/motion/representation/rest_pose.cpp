#include "motion/representation/rest_pose.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "motion/kinematics.h"
#include "motion/representation/root_frame.h"
#include "motion/resample.h"
#include "motion/skeleton_fit.h"

namespace marey {
namespace {

constexpr float kOwnPositionsM = 1e-3f;
constexpr double kSameDirection = 0.01;  ///< radians
constexpr double kNoLengthM = 1e-4;      ///< bones below this have no direction

bool sameDirections(const Skeleton& a, const Skeleton& b) {
  for (size_t j = 1; j < a.offsets.size(); ++j) {
    const Vec3d p = a.offsets[j].cast<double>(), q = b.offsets[j].cast<double>();
    if (p.norm() < kNoLengthM && q.norm() < kNoLengthM) continue;
    if (p.norm() < kNoLengthM || q.norm() < kNoLengthM) return false;
    if (std::atan2(p.cross(q).norm(), p.dot(q)) > kSameDirection) return false;
  }
  return true;
}

/// Whether rotations alone, about joints at their offsets, put the joints where they are.
bool madeOfRotations(const Clip& clip) {
  JointTransforms local = *clip.transforms;
  const auto width = static_cast<size_t>(clip.jointCount());
  for (size_t i = 0; i < local.translations.size(); ++i)
    if (i % width != 0) local.translations[i] = clip.skeleton->offsets[i % width];
  const std::vector<Vec3> made = forwardKinematics(*clip.skeleton, local);
  return made.size() == clip.positions.size() &&
         std::equal(made.begin(), made.end(), clip.positions.begin(),
                    [](const Vec3& a, const Vec3& b) { return (a - b).norm() < kOwnPositionsM; });
}

/// A skeleton whose identity pose is the rest pose of `skeleton`, with the clip's bone lengths.
std::shared_ptr<const Skeleton> atRest(const Skeleton& skeleton, const std::vector<Quatd>& world,
                                       const Clip& clip) {
  Skeleton out = skeleton;
  const auto lengths = withOffsetsFrom(clip);
  for (size_t j = 1; j < out.offsets.size(); ++j) {
    const auto parent = static_cast<size_t>(out.parents[j]);
    const Vec3d along = world[parent] * skeleton.offsets[j].cast<double>();
    const double length = lengths->offsets[j].cast<double>().norm();
    out.offsets[j] =
        (along.norm() < kNoLengthM ? along : Vec3d(along.normalized() * length)).cast<float>();
  }
  out.rest.clear();
  out.endSites.clear();
  return std::make_shared<const Skeleton>(std::move(out));
}

std::vector<Quatd> worldOf(const std::vector<Quatd>& local, const std::vector<int>& parents) {
  std::vector<Quatd> out = local;
  for (size_t j = 1; j < out.size(); ++j)
    out[j] = (out[static_cast<size_t>(parents[j])] * local[j]).normalized();
  return out;
}

/// Local rotations from world rotations that are relative to the rest pose `rest` (world too).
JointTransforms fromRest(const JointTransforms& fitted, const Skeleton& skeleton,
                         const std::vector<Quatd>& rest) {
  const size_t width = rest.size();
  JointTransforms out = fitted;
  std::vector<Quatd> world(width);
  for (size_t first = 0; first < fitted.rotations.size(); first += width) {
    for (size_t j = 0; j < width; ++j) world[j] = fitted.rotations[first + j].cast<double>();
    world = worldOf(world, skeleton.parents);
    for (size_t j = 0; j < width; ++j) world[j] = world[j] * rest[j];
    for (size_t j = 0; j < width; ++j) {
      const Quatd local =
          j == 0 ? world[j]
                 : world[static_cast<size_t>(skeleton.parents[j])].conjugate() * world[j];
      out.rotations[first + j] = local.normalized().cast<float>();
      if (j > 0) out.translations[first + j] = skeleton.offsets[j];
    }
  }
  return out;
}

}  // namespace

std::vector<Quatd> restRotations(const Skeleton& skeleton) {
  std::vector<Quatd> out;
  for (const auto& q : skeleton.rest) out.push_back(q.cast<double>().normalized());
  out.resize(static_cast<size_t>(skeleton.jointCount()), Quatd::Identity());
  return out;
}

ReadyClip withRotations(Clip clip, const Skeleton& skeleton) {
  if (clip.jointCount() != skeleton.jointCount())
    throwInput({.path = clip.name}, fmt::format("{} joints", skeleton.jointCount()), "{}",
               clip.jointCount());
  if (clip.transforms && sameDirections(*clip.skeleton, skeleton) && madeOfRotations(clip))
    return {.clip = std::move(clip)};
  const auto rest = worldOf(restRotations(skeleton), skeleton.parents);
  Clip bare = clip;
  bare.transforms.reset();
  bare.skeleton = atRest(skeleton, rest, clip);
  const SkeletonFit fit = fitSkeleton(bare);
  clip.transforms = fromRest(fit.transforms, skeleton, rest);
  return {.clip = std::move(clip), .fitM = fit.residual.largestM()};
}

std::shared_ptr<const Skeleton> withRestPose(const std::vector<Clip>& clips,
                                             const FeatureSpec& spec) {
  Skeleton out = *clips.front().skeleton;
  const bool bones = std::any_of(out.offsets.begin() + 1, out.offsets.end(),
                                 [](const auto& o) { return o.norm() > kNoLengthM; });
  if (!bones) out = *withOffsetsFrom(clips.front());
  out.rest.clear();
  const auto width = static_cast<size_t>(out.jointCount());
  std::vector<Eigen::Matrix4d> moments(width, Eigen::Matrix4d::Zero());
  for (const Clip& source : clips) {
    validate(source);
    const Clip clip = withRotations(resampled(source, spec.fps), out).clip;
    const auto trajectory = rootTrajectory(clip, spec);
    for (size_t i = 0; i < clip.transforms->rotations.size(); ++i) {
      Quatd q = clip.transforms->rotations[i].cast<double>();
      if (i % width == 0) q = turnOf(trajectory[i / width]).conjugate() * q;
      moments[i % width] += q.coeffs() * q.coeffs().transpose();
    }
  }
  for (const Eigen::Matrix4d& moment : moments) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> axes(moment);
    Quatd mean(Eigen::Vector4d(axes.eigenvectors().col(3)));
    if (mean.w() < 0.0) mean.coeffs() *= -1.0;
    out.rest.push_back(mean.normalized().cast<float>());
  }
  return std::make_shared<const Skeleton>(std::move(out));
}

}  // namespace marey
