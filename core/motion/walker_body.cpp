#include "motion/walker_body.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "motion/walker_leg.h"
#include "motion/walker_noise.h"

namespace marey::walker {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// A stretched leg keeps this share of its length, so that the knee never snaps.
constexpr double kReachShare = 0.995;
constexpr double kLowestHipsM = 0.35;
/// How far around a stretched frame the hips are lowered too.
constexpr double kSoftenS = 0.12;

enum Channel {
  SwayX,
  SwayZ,
  Height,
  PelvisYaw,
  Lean,
  SideLean,
  Twist,
  HeadYaw,
  HeadNod,
  HeadTilt,
  ArmLeft,
  ArmRight,
  ElbowLeft,
  ElbowRight,
  OutLeft,
  OutRight,
  ChannelCount
};
constexpr std::array<double, ChannelCount> kTimeScaleS = {1.1, 1.1, 0.9, 0.7, 0.9, 0.9, 0.6, 1.0,
                                                          0.9, 0.8, 0.7, 0.7, 0.8, 0.8, 0.9, 0.9};

Quaterniond aboutX(double a) {
  return Quaterniond(AngleAxisd(a, Vector3d::UnitX()));
}
Quaterniond aboutY(double a) {
  return Quaterniond(AngleAxisd(a, Vector3d::UnitY()));
}
Quaterniond aboutZ(double a) {
  return Quaterniond(AngleAxisd(a, Vector3d::UnitZ()));
}

/// The same rotation on the other side of the body (x negated).
Quaterniond acrossBody(const Quaterniond& q) {
  return {q.w(), q.x(), -q.y(), -q.z()};
}

Vector3d offsetOf(int joint) {
  return walkerSkeleton()->offsets[joint].cast<double>();
}

struct LegJoints {
  int hip, knee, ankle, toe;
};
constexpr std::array<LegJoints, 2> kLegs = {
    LegJoints{LeftUpLeg, LeftLeg, LeftFoot, LeftToeBase},
    LegJoints{RightUpLeg, RightLeg, RightFoot, RightToeBase}};

struct Lengths {
  double thigh, shank, hipsAboveHipJoint;
};
const Lengths& lengths() {
  static const Lengths value{offsetOf(LeftLeg).norm(), offsetOf(LeftFoot).norm(),
                             -offsetOf(LeftUpLeg).y()};
  return value;
}

double standingHeight() {
  return kAnkleHeightM + lengths().thigh + lengths().shank + lengths().hipsAboveHipJoint;
}

/// Highest hips at which the leg reaches its ankle, or lower than everything when none does.
double highestHips(const Vector3d& hipOffset, const Vector3d& floor, const Vector3d& ankle) {
  const double reach = kReachShare * (lengths().thigh + lengths().shank);
  const Vector3d joint = floor + hipOffset;
  const double flat = std::hypot(joint.x() - ankle.x(), joint.z() - ankle.z());
  if (flat >= reach) return -1.0;
  return ankle.y() + std::sqrt(reach * reach - flat * flat) - hipOffset.y();
}

/// The minimum over `radius` frames on both sides, then a mean with raised-cosine weights of the
/// same radius: smooth, and nowhere above the input.
std::vector<double> smoothLowerBound(const std::vector<double>& values, int radius) {
  const int n = static_cast<int>(values.size());
  std::vector<double> lowest(values.size());
  for (int i = 0; i < n; ++i)
    lowest[i] = *std::min_element(values.begin() + std::max(0, i - radius),
                                  values.begin() + std::min(n, i + radius + 1));
  std::vector<double> out(values.size());
  for (int i = 0; i < n; ++i) {
    double sum = 0.0;
    double weights = 0.0;
    for (int k = -radius; k <= radius; ++k) {
      const double w = 1.0 + std::cos(M_PI * k / (radius + 1));
      sum += w * lowest[std::clamp(i + k, 0, n - 1)];
      weights += w;
    }
    out[i] = sum / weights;
  }
  return out;
}

}  // namespace

std::vector<double> smoothed(const std::vector<double>& values, double sigmaFrames) {
  const int n = static_cast<int>(values.size());
  const int radius = static_cast<int>(std::ceil(3.0 * sigmaFrames));
  std::vector<double> weights;
  for (int k = -radius; k <= radius; ++k)
    weights.push_back(std::exp(-0.5 * k * k / (sigmaFrames * sigmaFrames)));
  double total = 0.0;
  for (double w : weights) total += w;
  std::vector<double> out(values.size(), 0.0);
  for (int i = 0; i < n; ++i)
    for (int k = -radius; k <= radius; ++k)
      out[i] += weights[k + radius] / total * values[std::clamp(i + k, 0, n - 1)];
  return out;
}

Body::Body(const Gait& gait, uint64_t seed, double noise, double beginS, double endS)
    : m_gait(gait), m_noise(noise) {
  for (uint32_t c = 0; c < ChannelCount; ++c)
    m_channels.emplace_back(seed, c, kTimeScaleS[c], beginS, endS);
}

double Body::noiseAt(int channel, double timeS) const {
  return m_noise * m_channels[channel].at(timeS);
}

Body::Pelvis Body::pelvis(const FrameDrive& d) const {
  const double stride = d.stride / 0.7;
  const double still = std::clamp(1.0 - d.speed / 0.4, 0.0, 1.0);
  const Vector3d left(std::cos(d.root.heading), 0.0, -std::sin(d.root.heading));
  const Vector3d ahead(std::sin(d.root.heading), 0.0, std::cos(d.root.heading));
  const double side = 0.028 * d.weight + (0.004 + 0.008 * still) * noiseAt(SwayX, d.timeS);
  const double forward = (0.003 + 0.006 * still) * noiseAt(SwayZ, d.timeS);
  Pelvis out;
  out.floor = Vector3d(d.root.x, 0.0, d.root.z) + side * left + forward * ahead;
  // The hip of the leading leg goes forward, that of the swinging leg drops.
  const double yaw = -0.10 * stride + 0.02 * noiseAt(PelvisYaw, d.timeS);
  out.rotation =
      aboutY(d.root.heading + yaw) * aboutZ(0.05 * d.weight) * aboutX(0.35 * m_gait.style.lean);
  return out;
}

std::vector<double> Body::hipHeights(const std::vector<FrameDrive>& drives, double fps) const {
  std::vector<double> bound;
  for (const FrameDrive& d : drives) {
    const Pelvis p = pelvis(d);
    const double open = std::min(1.0, std::pow(d.stride / 0.6, 2));
    double height = standingHeight() - m_gait.style.crouchM - 2.0 * m_gait.style.bounceM * open +
                    0.003 * noiseAt(Height, d.timeS);
    for (int foot : {kLeft, kRight}) {
      const Vector3d hip = p.rotation * offsetOf(kLegs[foot].hip);
      height = std::min(height, highestHips(hip, p.floor, d.feet[foot].ankle));
    }
    if (height < kLowestHipsM)
      throwInput({.path = "walker", .item = fmt::format("time {:.2f} s", d.timeS)},
                 "a path that can be walked", "feet {:.2f} m from the hips at {:.1f} m/s", d.spread,
                 d.speed);
    bound.push_back(height);
  }
  return smoothLowerBound(bound, static_cast<int>(std::ceil(kSoftenS * fps)));
}

void Body::poseTrunk(const FrameDrive& d, std::vector<Quaterniond>& local) const {
  const double stride = d.stride / 0.7;
  const double swing = m_gait.style.armSwing / 0.38;
  const double lean = m_gait.style.lean * (0.6 + 0.5 * d.speed / 1.3);
  const double bend = lean + 0.03 * noiseAt(Lean, d.timeS);
  const double side = -0.03 * d.weight + 0.02 * noiseAt(SideLean, d.timeS) -
                      0.05 * std::clamp(d.turn * d.speed / 1.5, -1.0, 1.0);
  const double twist = (0.10 + 0.07 * swing) * stride + 0.04 * noiseAt(Twist, d.timeS);
  local[Spine] = aboutY(0.5 * twist) * aboutZ(0.5 * side) * aboutX(0.5 * bend);
  local[Spine1] = aboutY(0.5 * twist) * aboutZ(0.5 * side) * aboutX(0.5 * bend);
  local[Neck] = aboutX(0.15 * bend);
  // The head stays level and looks where the path turns to.
  const double look = -0.8 * twist + 0.10 * stride + 0.25 * std::clamp(d.turn, -1.5, 1.5);
  local[Head] = aboutY(look + 0.10 * noiseAt(HeadYaw, d.timeS)) *
                aboutZ(-0.8 * side + 0.04 * noiseAt(HeadTilt, d.timeS)) *
                aboutX(-0.9 * bend + 0.05 * noiseAt(HeadNod, d.timeS));
}

void Body::poseArms(const FrameDrive& d, std::vector<Quaterniond>& local) const {
  for (int side : {kLeft, kRight}) {
    const double sign = side == kLeft ? 1.0 : -1.0;
    // Opposite to the leg of the same side; the elbow bends more in front.
    const double swing = -sign * m_gait.style.armSwing * d.stride / 0.75 +
                         0.06 * noiseAt(side == kLeft ? ArmLeft : ArmRight, d.timeS);
    const double out = m_gait.armOut + 0.03 * noiseAt(side == kLeft ? OutLeft : OutRight, d.timeS);
    const double elbow = m_gait.elbow + 0.4 * std::max(-0.2, swing) +
                         0.12 * std::min(d.speed, 2.5) / 1.3 +
                         0.06 * noiseAt(side == kLeft ? ElbowLeft : ElbowRight, d.timeS);
    // Written for the left arm, whose rest direction is +x.
    const Quaterniond shoulder =
        aboutX(-swing - 0.3 * m_gait.style.lean) * aboutZ(out - M_PI / 2.0);
    const Quaterniond forearm = aboutY(-std::max(0.05, elbow));
    const Quaterniond hand = aboutY(-0.12);
    const int first = side == kLeft ? LeftArm : RightArm;
    local[first] = side == kLeft ? shoulder : acrossBody(shoulder);
    local[first + 1] = side == kLeft ? forearm : acrossBody(forearm);
    local[first + 2] = side == kLeft ? hand : acrossBody(hand);
  }
}

void Body::pose(const FrameDrive& d, double hipHeight, std::vector<Vec3>& positions,
                JointTransforms& transforms) const {
  static const std::shared_ptr<const Skeleton> skeleton = walkerSkeleton();
  std::vector<Quaterniond> local(JointCount, Quaterniond::Identity());
  std::vector<Quaterniond> world(JointCount);
  std::vector<Vector3d> place(JointCount);
  const Pelvis p = pelvis(d);
  local[Hips] = p.rotation;
  poseTrunk(d, local);
  poseArms(d, local);
  world[Hips] = p.rotation;
  place[Hips] = p.floor + Vector3d(0.0, hipHeight, 0.0);
  for (int j = 1; j < JointCount; ++j) {
    const int parent = skeleton->parents[j];
    world[j] = world[parent] * local[j];
    place[j] = place[parent] + world[parent] * offsetOf(j);
  }
  for (int side : {kLeft, kRight}) {
    const LegJoints& leg = kLegs[side];
    const FootPose& foot = d.feet[side];
    const double facing =
        d.root.heading + 0.5 * std::remainder(foot.yaw - d.root.heading, 2 * M_PI);
    // A pitched foot draws the knee upwards and forwards with it.
    const Vector3d ahead(std::sin(facing), 0.15, std::cos(facing));
    const LegPose ik =
        solveLeg(place[leg.hip], foot.ankle, ahead, lengths().thigh, lengths().shank);
    place[leg.knee] = ik.knee;
    place[leg.ankle] = foot.ankle;
    place[leg.toe] = foot.toe;
    world[leg.hip] = Quaterniond(ik.thigh);
    world[leg.knee] = Quaterniond(ik.shank);
    world[leg.ankle] = aboutY(foot.yaw) * aboutX(foot.pitch);
    world[leg.toe] = aboutY(foot.yaw);
    for (int j : {leg.hip, leg.knee, leg.ankle, leg.toe})
      local[j] = world[skeleton->parents[j]].conjugate() * world[j];
  }
  for (int j = 0; j < JointCount; ++j) {
    positions.push_back(place[j].cast<float>());
    transforms.rotations.push_back(local[j].normalized().cast<float>());
    transforms.translations.push_back(j == Hips ? Vec3(place[j].cast<float>())
                                                : skeleton->offsets[j]);
  }
}

}  // namespace marey::walker
