#include "moglow/engine_chart.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "moglow/engine_gate.h"

namespace marey::moglow {
namespace {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

Vec3 unit(const Vec3& v) {
  return v / std::max(v.norm(), 1e-6);
}

/// Height of a bone of a length above the foot of its chart; 0 where (q1, q2) is too long.
double rise(double length, const Vec2& q) {
  return std::sqrt(std::max(length * length - q.squaredNorm(), 0.0));
}

double firmness(double hold) {
  return hold * hold * (hold * hold);
}

Vec2 gateShift(double skew, const Vec3& way) {
  const Vec2 flat = way.head<2>();
  return skew * flat / (flat.norm() + 0.05);
}

Vec2 gateCentre(const FootForesight& foot, const Vec3& before) {
  return foot.hold * before.head<2>() + (1.0 - foot.hold) * foot.foreseen;
}

double kneeCentre(const FootForesight& foot) {
  return (1.0 - firmness(foot.hold)) * foot.knee;
}

double scaleAt(double slope, const FootForesight& foot, double distance) {
  return std::max(slope * (distance + foot.slack), kFinest);
}

/// How much of a foot's third coordinate is that of its last place.
double holdAlong(double hold, double distance) {
  const double far = distance / kResting;
  return kBoneMemory * firmness(hold) / (1.0 + far * far);
}

/// x / scale up to kTail, logarithmic from there; and the log-determinant.
std::pair<double, double> squeezed(double x, double scale) {
  const double r = x / scale, logFar = std::log(std::max(std::abs(r), kTail) / kTail);
  return {std::abs(r) < kTail ? r : std::copysign(kTail * (1.0 + logFar), r),
          -logFar - std::log(scale)};
}

double unsqueezed(double w, double scale) {
  if (std::abs(w) < kTail) return w * scale;
  return std::copysign(kTail * std::exp(std::abs(w) / kTail - 1.0), w) * scale;
}

Vec2 flatAt(std::span<const double> value, int joint) {
  const auto at = static_cast<size_t>(3 * joint);
  return {value[at], value[at + 1]};
}

}  // namespace

EngineChart::EngineChart(Body body) : m_body(std::move(body)) {
  const auto bends = [&](int joint) {
    return m_body.lengths[static_cast<size_t>(joint)] >= kShortest;
  };
  m_limbs.resize(m_body.parents.size());
  m_footIndex.assign(m_body.parents.size(), -1);
  for (size_t f = 0; f < m_body.feet.size(); ++f) {
    const int foot = m_body.feet[f], knee = m_body.parents[static_cast<size_t>(foot)];
    m_footIndex[static_cast<size_t>(foot)] = static_cast<int>(f);
    const bool leg = knee >= 0 && m_body.parents[static_cast<size_t>(knee)] >= 0 && bends(knee) &&
                     bends(foot) &&
                     std::find(m_knees.begin(), m_knees.end(), knee) == m_knees.end();
    m_knees.push_back(leg ? knee : -1);
    for (const int joint : {foot, knee}) {
      // A joint of two legs belongs to the first.
      if (leg && m_limbs[static_cast<size_t>(joint)].foot < 0)
        m_limbs[static_cast<size_t>(joint)] = {static_cast<int>(f), joint == knee};
    }
  }
}

/// The frame (columns) of a bone along a unit vector: the side axis is carried there from the mean
/// direction by the shortest arc and made orthonormal.
Mat3 EngineChart::frameAlong(int joint, const Vec3& n) const {
  const Vec3 &axis = m_body.axes[static_cast<size_t>(joint)],
             &side = m_body.sides[static_cast<size_t>(joint)];
  Vec3 p = side - n.dot(side) / std::max(1.0 + n.dot(axis), 1e-2) * (axis + n);
  p = unit(p - p.dot(n) * n);
  Mat3 out;
  out << p, n.cross(p), n;
  return out;
}

/// The frame of a knee of a leg that is bent so that its foot reaches a place.
Mat3 EngineChart::kneeFrame(const RowForesight& seen, int knee, int foot, const Vec3& hip,
                            const Vec3& place, const Vec3& foreseenThigh) const {
  const double thigh = seen.lengths[static_cast<size_t>(knee)],
               shin = seen.lengths[static_cast<size_t>(foot)],
               far = std::max((place - hip).norm(), 1e-3);
  const Vec3 axis = (place - hip) / far;
  const double d =
      std::min(std::max(far, std::abs(thigh - shin) + 1e-2), kStraight * (thigh + shin));
  const double along = (thigh * thigh - shin * shin + d * d) / (2.0 * d),
               across = std::sqrt(std::max(thigh * thigh - along * along, 0.0));
  // The side of a straight leg is that of the chart.
  const Vec3 towards = foreseenThigh + 1e-3 * m_body.sides[static_cast<size_t>(knee)],
             bend = unit(towards - towards.dot(axis) * axis),
             n = unit(along * axis + across * bend), p = unit(axis.cross(bend));
  Mat3 out;
  out << p, n.cross(p), n;
  return out;
}

Mat3 EngineChart::frameAt(const RowForesight& seen, int joint,
                          std::span<const Vec3> present) const {
  const auto own = static_cast<size_t>(joint), parent = static_cast<size_t>(m_body.parents[own]);
  const Vec3 bone = seen.pose[own] - seen.pose[parent];
  const Limb limb = m_limbs[own];
  if (limb.foot < 0)
    return frameAlong(joint, m_body.lengths[own] < kShortest ? m_body.axes[own] : unit(bone));
  const Vec3& place = seen.feet[static_cast<size_t>(limb.foot)].place;
  if (limb.knee)
    return kneeFrame(seen, joint, m_body.feet[static_cast<size_t>(limb.foot)], present[parent],
                     place, bone);
  return frameAlong(joint, unit(place - present[parent]));
}

/// A foot and its knee of `value` go through their gates; the log-determinant.
double EngineChart::gateFoot(const RowForesight& seen, size_t foot, std::span<const Vec3> pose,
                             std::span<double> value) const {
  const FootForesight& f = seen.feet[foot];
  const int joint = m_body.feet[foot], knee = m_knees[foot];
  const auto own = static_cast<size_t>(joint);
  const Vec3& parent = pose[static_cast<size_t>(m_body.parents[own])];
  const Mat3 back = frameAt(seen, joint, pose).transpose();
  const Vec3 now = back * (pose[own] - parent), before = back * (f.last - parent),
             way = back * (seen.pose[own] - f.last);
  const auto [gated, gateLogDet] =
      throughGate(f.radii, gateShift(f.skew, way), now.head<2>() - gateCentre(f, before));
  const double distance = gateRadius(f.radii, gated.norm()),
               height = rise(seen.lengths[own], now.head<2>()),
               excess = now.z() - height - holdAlong(f.hold, distance) * (before.z() - height);
  const auto [along, alongLogDet] = squeezed(excess, scaleAt(f.boneSlope, f, distance));
  value[3 * own] = gated.x();
  value[3 * own + 1] = gated.y();
  value[3 * own + 2] = along;
  if (knee < 0) return gateLogDet + alongLogDet;
  double& bent = value[3 * static_cast<size_t>(knee) + 1];
  const auto [inPlane, kneeLogDet] =
      squeezed(bent - kneeCentre(f), scaleAt(f.kneeSlope, f, distance));
  bent = inPlane;
  return gateLogDet + alongLogDet + kneeLogDet;
}

double EngineChart::toChart(const RowForesight& seen, std::span<const Vec3> pose,
                            std::span<double> value) const {
  Eigen::Map<Vec3>(value.data()) = pose[0] - seen.pose[0];
  for (size_t j = 1; j < pose.size(); ++j) {
    const Mat3 frame = frameAt(seen, static_cast<int>(j), pose);
    Vec3 q = frame.transpose() * (pose[j] - pose[static_cast<size_t>(m_body.parents[j])]);
    q.z() -= rise(seen.lengths[j], q.head<2>());
    Eigen::Map<Vec3>(value.data() + 3 * j) = q;
  }
  double logDet = 0.0;
  for (size_t f = 0; f < m_body.feet.size(); ++f) logDet += gateFoot(seen, f, pose, value);
  return logDet;
}

Vec3 EngineChart::released(const RowForesight& seen, int joint, std::span<const double> value,
                           const Mat3& frame, const Vec3& parent) const {
  const auto own = static_cast<size_t>(joint);
  const Vec3 q(value[3 * own], value[3 * own + 1], value[3 * own + 2]);
  if (m_footIndex[own] < 0) {
    const Limb limb = m_limbs[own];
    if (limb.foot < 0) return q;
    const FootForesight& f = seen.feet[static_cast<size_t>(limb.foot)];
    const Vec2 gated = flatAt(value, m_body.feet[static_cast<size_t>(limb.foot)]);
    const double scale = scaleAt(f.kneeSlope, f, gateRadius(f.radii, gated.norm()));
    return {q.x(), unsqueezed(q.y(), scale) + kneeCentre(f), q.z()};
  }
  const FootForesight& f = seen.feet[static_cast<size_t>(m_footIndex[own])];
  const Vec3 before = frame.transpose() * (f.last - parent),
             way = frame.transpose() * (seen.pose[own] - f.last);
  const Vec2 flat =
      backThroughGate(f.radii, gateShift(f.skew, way), q.head<2>()) + gateCentre(f, before);
  const double distance = gateRadius(f.radii, q.head<2>().norm()),
               above = before.z() - rise(seen.lengths[own], flat);
  return {
      flat.x(), flat.y(),
      unsqueezed(q.z(), scaleAt(f.boneSlope, f, distance)) + holdAlong(f.hold, distance) * above};
}

void EngineChart::fromChart(const RowForesight& seen, std::span<const double> value,
                            std::span<Vec3> pose) const {
  pose[0] = seen.pose[0] + Vec3(value[0], value[1], value[2]);
  for (size_t j = 1; j < pose.size(); ++j) {
    const auto joint = static_cast<int>(j);
    const Vec3& parent = pose[static_cast<size_t>(m_body.parents[j])];
    const Mat3 frame = frameAt(seen, joint, pose);
    Vec3 q = released(seen, joint, value, frame, parent);
    q.z() += rise(seen.lengths[j], q.head<2>());
    pose[j] = parent + frame * q;
  }
}

}  // namespace marey::moglow
