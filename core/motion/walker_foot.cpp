#include "motion/walker_foot.h"

#include <algorithm>
#include <cmath>

namespace marey::walker {
namespace {

using Eigen::Vector3d;

Vector3d along(double yaw) {
  return {std::sin(yaw), 0.0, std::cos(yaw)};
}

/// From ankle to toe of a foot turned by yaw and pitched by `pitch` (positive: heel up).
Vector3d ankleToToe(double yaw, double pitch) {
  const double drop = kAnkleHeightM - kToeHeightM;
  const double s = std::sin(pitch);
  const double c = std::cos(pitch);
  const Vector3d up(0.0, -drop * c - kFootLengthM * s, 0.0);
  return along(yaw) * (kFootLengthM * c - drop * s) + up;
}

Vector3d ankleOf(const Placement& p) {
  return {p.x, kAnkleHeightM, p.z};
}

/// Standing flat; every call with one placement gives the same bits.
FootPose standing(const Placement& p) {
  FootPose pose{.ankle = ankleOf(p), .toe = {}, .yaw = p.yaw, .pitch = 0.0};
  pose.toe = pose.ankle + ankleToToe(p.yaw, 0.0);
  return pose;
}

/// The toe stays, the heel rises; u in [0, 1] is the part of the push that is done. It leaves the
/// floor with some speed, so that a contact has a clear end.
FootPose pushing(const Step& step, double u) {
  FootPose pose = standing(step.from);
  pose.pitch = step.pushPitch * u * (0.35 + 0.65 * u);
  pose.ankle = pose.toe - ankleToToe(pose.yaw, pose.pitch);
  return pose;
}

/// Velocity of the ankle at toe-off.
Vector3d pushVelocity(const Step& step) {
  const double push = step.toeOffS - step.liftS;
  if (push <= 0.0) return Vector3d::Zero();
  constexpr double kDelta = 1e-5;
  const Vector3d d = pushing(step, 1.0).ankle - pushing(step, 1.0 - kDelta).ankle;
  return d / (kDelta * push);
}

double smoothStep(double u) {
  return u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
}

/// Quintic from p0 (velocity v0 per unit) to rest at p1. It starts and brakes sharply, as a leg
/// that is swung does, so that contacts have clear ends.
Vector3d glide(const Vector3d& p0, const Vector3d& v0, const Vector3d& p1, double u) {
  constexpr double kPull = 5.0;
  constexpr double kBrake = 9.0;
  const double v = 1.0 - u;
  const double velocity = u * (1.0 + u * u * (-6.0 + u * (8.0 - 3.0 * u)));
  const double pull = 0.5 * u * u * v * v * v;
  const double brake = 0.5 * u * u * u * v * v;
  return p0 + (smoothStep(u) + kPull * pull - kBrake * brake) * (p1 - p0) + velocity * v0;
}

FootPose swinging(const Step& step, double u) {
  const double seconds = step.landS - step.toeOffS;
  const FootPose from = pushing(step, 1.0);
  const double turn = std::remainder(step.to.yaw - step.from.yaw, 2.0 * M_PI);
  FootPose pose{.ankle = {}, .toe = {}, .yaw = step.from.yaw + smoothStep(u) * turn, .pitch = 0.0};
  // The heel keeps rising for a moment, then the toes come up before the landing.
  const double early = 0.35 * step.pushPitch * std::sin(M_PI * std::min(1.0, 2.0 * u));
  const double late = smoothStep(std::clamp(u / 0.85, 0.0, 1.0));
  pose.pitch = step.pushPitch + early * (1.0 - late) + late * (step.landPitch - step.pushPitch);
  pose.ankle = glide(from.ankle, seconds * pushVelocity(step), ankleOf(step.to), u);
  pose.ankle.y() += step.heightM * 16.0 * u * u * (1.0 - u) * (1.0 - u);
  const Vector3d toToe = ankleToToe(pose.yaw, pose.pitch);
  // The toes clear the floor by what the swing leaves to them.
  const double clearance = kToeHeightM + 0.02 * std::sin(M_PI * u) * std::min(1.0, 4.0 * u);
  pose.ankle.y() = std::max(pose.ankle.y(), clearance - toToe.y());
  pose.toe = pose.ankle + toToe;
  return pose;
}

/// The ankle stands on the heel, the toes come down.
FootPose landing(const Step& step, double u) {
  FootPose pose = standing(step.to);
  pose.pitch = step.landPitch * (1.0 - u) * (1.0 - u) * (1.0 + 2.0 * u);
  pose.toe = pose.ankle + ankleToToe(pose.yaw, pose.pitch);
  return pose;
}

double part(double timeS, double fromS, double toS) {
  return (timeS - fromS) / (toS - fromS);
}

}  // namespace

FootTrack::FootTrack(const Placement& start, const std::vector<Step>& steps)
    : m_start(start), m_steps(steps) {}

FootPose FootTrack::at(double timeS) const {
  const auto next = std::upper_bound(m_steps.begin(), m_steps.end(), timeS,
                                     [](double t, const Step& s) { return t <= s.liftS; });
  if (next == m_steps.begin()) return standing(m_start);
  const Step& step = *(next - 1);
  if (timeS < step.toeOffS) return pushing(step, part(timeS, step.liftS, step.toeOffS));
  if (timeS < step.landS) return swinging(step, part(timeS, step.toeOffS, step.landS));
  if (timeS < step.flatS) return landing(step, part(timeS, step.landS, step.flatS));
  return standing(step.to);
}

std::vector<Contact> FootTrack::contacts(int ankleJoint, double endS) const {
  std::vector<Contact> out;
  for (size_t i = 0; i <= m_steps.size(); ++i) {
    const double begin = i == 0 ? 0.0 : std::max(0.0, m_steps[i - 1].landS);
    const double end = i == m_steps.size() ? endS : std::min(endS, m_steps[i].liftS);
    if (end > begin) out.push_back({.joint = ankleJoint, .beginS = begin, .endS = end});
  }
  return out;
}

}  // namespace marey::walker
