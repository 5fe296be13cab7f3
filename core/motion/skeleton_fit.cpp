#include "motion/skeleton_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "motion/kinematics.h"
#include "motion/pose_solver.h"

namespace marey {
namespace {

/// Time in which unseen twist falls to 1/e: slow enough to go unnoticed, faster than it gathers.
constexpr double kTwistS = 0.5;
/// How fast a trunk turns, radians per second: what positions say badly may change by that much.
constexpr double kTurnRadS = 2.0;
/// Residuals below this (a micrometre) are rounding, not contradictions.
constexpr double kRoundingM = 1e-6;

bool measured(const Skeleton& skeleton) {
  return skeleton.jointCount() == 1 ||
         std::any_of(skeleton.offsets.begin() + 1, skeleton.offsets.end(),
                     [](const Vec3& offset) { return offset.norm() > 1e-6f; });
}

/// `rotation` with the share `share` of its twist about `axis` taken back. Near a half turn away
/// from rest the twist is not determined, so it is left alone there.
Quatd untwisted(const Quatd& rotation, const Vec3d& axis, double share) {
  const double along = rotation.vec().dot(axis);
  const double certain = rotation.w() * rotation.w() + along * along;
  double twist = 2.0 * std::atan2(along, rotation.w());
  if (twist > std::numbers::pi) twist -= 2.0 * std::numbers::pi;
  if (twist < -std::numbers::pi) twist += 2.0 * std::numbers::pi;
  return rotation * Quatd(Eigen::AngleAxisd(-twist * share * certain, axis));
}

/// Local rotations out of world rotations whose unseen parts are arbitrary.
class TwistKeeper {
 public:
  TwistKeeper(const Skeleton& skeleton, const PoseSolver& solver, double fps)
      : m_skeleton(skeleton), m_solver(solver), m_share(1.0 - std::exp(-1.0 / (kTwistS * fps))) {}

  /// Replaces the unseen parts of `pose`; returns the local rotations.
  const std::vector<Quatd>& settle(WorldPose& pose) {
    const bool first = m_local.empty();
    if (first) m_local.assign(pose.rotations.size(), Quatd::Identity());
    for (size_t j = 0; j < pose.rotations.size(); ++j) {
      const Quatd parent =
          j == 0 ? Quatd::Identity() : pose.rotations[static_cast<size_t>(m_skeleton.parents[j])];
      const Quatd next = local(static_cast<int>(j), parent.conjugate() * pose.rotations[j], first);
      // q and -q are one rotation; interpolation between frames wants the nearer one.
      m_local[j].coeffs() = (next.dot(m_local[j]) < 0.0 ? -1.0 : 1.0) * next.normalized().coeffs();
      pose.rotations[j] = (parent * m_local[j]).normalized();
    }
    return m_local;
  }

 private:
  Quatd local(int joint, const Quatd& found, bool first) const {
    if (m_solver.observed(joint) == Observed::Rotation) return found;
    if (m_solver.observed(joint) == Observed::Nothing) return Quatd::Identity();
    const Vec3d& axis = m_solver.axis(joint);
    const Vec3d direction = found * axis;
    if (first) return shortestArc(axis, direction);
    const Quatd& before = m_local[static_cast<size_t>(joint)];
    return untwisted(shortestArc(before * axis, direction) * before, axis, m_share);
  }

  const Skeleton& m_skeleton;
  const PoseSolver& m_solver;
  double m_share;
  std::vector<Quatd> m_local;
};

/// The nearest pose; where the positions contradict the skeleton, rotations that they show badly
/// stay near `before`: the weight is that of Gaussian errors, of positions as large as the residual
/// and of turns of kTurnRadS, so that it vanishes with the contradiction.
WorldPose nextPose(const PoseSolver& solver, std::span<const Vec3> target, const WorldPose& before,
                   double fps) {
  WorldPose pose = before;
  const double squares = solver.solve(target, pose);
  const double variance = squares / static_cast<double>(target.size());
  if (before.rotations.empty() || variance < kRoundingM * kRoundingM) return pose;
  const double turn = kTurnRadS / fps;
  const Hold hold{.before = before, .weight = variance / (turn * turn)};
  pose = before;
  solver.solve(target, pose, &hold);
  return pose;
}

FitResidual residualOf(const Clip& clip, const Skeleton& skeleton,
                       const JointTransforms& transforms) {
  const std::vector<Vec3> fitted = forwardKinematics(skeleton, transforms);
  const auto width = static_cast<size_t>(clip.jointCount());
  FitResidual out{.joints = skeleton.names,
                  .rmsM = std::vector<double>(width),
                  .maxM = std::vector<double>(width),
                  .frames = std::vector<int>(width, clip.frameCount())};
  for (size_t i = 0; i < fitted.size(); ++i) {
    const double distance = (fitted[i] - clip.positions[i]).cast<double>().norm();
    out.rmsM[i % width] += distance * distance;
    out.maxM[i % width] = std::max(out.maxM[i % width], distance);
  }
  for (double& sum : out.rmsM) sum = std::sqrt(sum / clip.frameCount());
  return out;
}

}  // namespace

double FitResidual::largestM() const {
  return maxM.empty() ? 0.0 : *std::max_element(maxM.begin(), maxM.end());
}

FitResidual pooled(const FitResidual& a, const FitResidual& b) {
  FitResidual out = a;
  for (size_t j = 0; j < b.joints.size(); ++j) {
    const auto found = std::find(out.joints.begin(), out.joints.end(), b.joints[j]);
    const auto i = static_cast<size_t>(found - out.joints.begin());
    if (found == out.joints.end()) {
      out.joints.push_back(b.joints[j]);
      out.rmsM.push_back(b.rmsM[j]);
      out.maxM.push_back(b.maxM[j]);
      out.frames.push_back(b.frames[j]);
      continue;
    }
    const double squares =
        out.rmsM[i] * out.rmsM[i] * out.frames[i] + b.rmsM[j] * b.rmsM[j] * b.frames[j];
    out.frames[i] += b.frames[j];
    out.rmsM[i] = std::sqrt(squares / out.frames[i]);
    out.maxM[i] = std::max(out.maxM[i], b.maxM[j]);
  }
  return out;
}

SkeletonFit fitSkeleton(const Clip& clip) {
  validate(clip);
  SkeletonFit out{.skeleton = measured(*clip.skeleton) ? clip.skeleton : withOffsetsFrom(clip)};
  const PoseSolver solver(*out.skeleton);
  TwistKeeper keeper(*out.skeleton, solver, clip.fps);
  WorldPose pose;
  for (int t = 0; t < clip.frameCount(); ++t) {
    pose = nextPose(solver, clip.frame(t), pose, clip.fps);
    for (const Quatd& rotation : keeper.settle(pose))
      out.transforms.rotations.push_back(rotation.cast<float>());
    out.transforms.translations.push_back(pose.root.cast<float>());
    out.transforms.translations.insert(out.transforms.translations.end(),
                                       out.skeleton->offsets.begin() + 1,
                                       out.skeleton->offsets.end());
  }
  out.residual = residualOf(clip, *out.skeleton, out.transforms);
  return out;
}

Clip withFit(Clip clip, const SkeletonFit& fit) {
  clip.skeleton = fit.skeleton;
  clip.transforms = fit.transforms;
  clip.positions = forwardKinematics(*clip.skeleton, *clip.transforms);
  return clip;
}

std::shared_ptr<const Skeleton> withOffsetsFrom(const Clip& clip) {
  Skeleton out = *clip.skeleton;
  if (clip.frameCount() == 0) return clip.skeleton;
  out.offsets[0] = clip.at(0, 0);
  for (const auto& [parent, child] : out.bones()) {
    double sum = 0.0;
    for (int t = 0; t < clip.frameCount(); ++t)
      sum += (clip.at(t, child) - clip.at(t, parent)).norm();
    const Vec3 first = clip.at(0, child) - clip.at(0, parent);
    const auto mean = static_cast<float>(sum / clip.frameCount());
    out.offsets[static_cast<size_t>(child)] =
        first.norm() > 0.0f ? Vec3(first.normalized() * mean) : Vec3(0.0f, mean, 0.0f);
  }
  return std::make_shared<const Skeleton>(std::move(out));
}

}  // namespace marey
