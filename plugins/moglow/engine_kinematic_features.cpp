// What the kinematic base looks at: the past in the present root frame, and the numbers by which
// regimes, gates and nets see it.
#include <algorithm>
#include <cmath>

#include "moglow/engine_kinematic.h"

namespace marey::moglow {
namespace {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

/// Keeps the direction of a movement and squeezes its size.
template <typename Vector>
Vector squeezed(const Vector& movement, double scale) {
  const double size = std::max(movement.norm(), 1e-6);
  return movement * (std::asinh(size / scale) / size);
}

double squeezed(double movement, double scale) {
  return squeezed(Eigen::Matrix<double, 1, 1>(movement), scale)(0);
}

Vec2 onFloor(const Vec3& v) {
  return {v.x(), v.z()};
}

/// Into a root frame that moved by (sideways, forward) and then turned.
void moveOn(std::vector<Vec3>& joints, const double* control) {
  const double c = std::cos(control[2]), s = std::sin(control[2]);
  for (Vec3& joint : joints) {
    const double x = joint.x() - control[0], z = joint.z() - control[1];
    joint = {c * x - s * z, joint.y(), s * x + c * z};
  }
}

template <typename Vector>
void append(std::vector<double>& out, const Vector& values) {
  for (long i = 0; i < values.size(); ++i) out.push_back(values[i]);
}

}  // namespace

EngineKinematic::Past EngineKinematic::pastOf(const float* history, const float* control) const {
  const auto tau = static_cast<size_t>(m_config.tau),
             order = static_cast<size_t>(m_config.baseOrder), d = 3 * m_joints;
  // A control's sideways and forward way are centimetres, its turn radians.
  const auto controlAt = [&](size_t frame, size_t i) {
    const double value = control[3 * frame + i] * m_controlStd[i] + m_controlMean[i];
    return i < 2 ? value * 100.0 : value;
  };
  Past out;
  for (size_t lag = 1; lag <= order; ++lag) {
    auto joints = inCentimetres(history + (tau - lag) * d);
    for (size_t frame = tau - lag + 1; frame <= tau; ++frame) {
      const double way[] = {controlAt(frame, 0), controlAt(frame, 1), controlAt(frame, 2)};
      moveOn(joints, way);
    }
    out.poses.push_back(std::move(joints));
  }
  for (size_t lag = 0; lag < order; ++lag)
    for (size_t i = 0; i < 3; ++i) out.control.push_back(controlAt(tau - lag, i));
  meetBody(out);
  return out;
}

/// Fills in the lengths and the size of the body, and shrinks the past to the trained one.
void EngineKinematic::meetBody(Past& past) const {
  past.lengths = m_lengths;
  if (m_config.boneLengths != "history") return;
  double all = 0.0;
  for (size_t j = 0; j < m_joints; ++j) {
    const auto parent = static_cast<size_t>(std::max(m_parents[j], 0));
    double sum = 0.0;
    for (const auto& joints : past.poses) sum += (joints[j] - joints[parent]).norm();
    const double mean = sum / static_cast<double>(past.poses.size());
    past.lengths[j] = m_lengths[j] < kShortest ? mean : std::max(mean, kShortest);
    all += past.lengths[j];
  }
  if (m_allLengths < kShortest) return;
  past.size = all / m_allLengths;
  for (auto& joints : past.poses)
    for (Vec3& joint : joints) joint /= past.size;
  for (size_t i = 0; i < past.control.size(); ++i)
    if (i % 3 < 2) past.control[i] /= past.size;
}

std::vector<double> EngineKinematic::regressors(const Past& past) const {
  std::vector<double> out;
  out.reserve(m_richMean.size() + 1);
  const size_t order = past.poses.size();
  for (const Vec3& joint : past.poses.front()) append(out, joint);
  for (size_t k = 0; k + 1 < order; ++k)
    for (size_t j = 0; j < m_joints; ++j) append(out, past.movement(k, static_cast<int>(j)));
  out.insert(out.end(), past.control.begin(), past.control.end());
  for (size_t k = 0; k + 1 < order; ++k)
    for (const int joint : m_contacts) {
      const Vec2 way = onFloor(past.movement(k, joint));
      const double r = std::max(way.norm(), 1e-6);
      append(out, Vec2(way * ((std::asinh(r / 0.2) + r / 2.0) / r)));
    }
  return out;
}

std::vector<double> EngineKinematic::footFeatures(const Past& past, const Foot& foot) const {
  const double slow = m_slowMovement;
  // Left and right alike.
  const auto mirrored = [&](Vec2 v) {
    v.x() *= foot.side;
    return v;
  };
  const auto movement = [&](size_t lag, int joint) {
    return squeezed(mirrored(onFloor(past.movement(lag, joint))), slow);
  };
  std::vector<double> out;
  out.reserve(kFootFeatures);
  append(out, movement(0, foot.ankle));
  append(out, movement(1, foot.ankle));
  out.push_back(squeezed(past.movement(0, foot.ankle).y(), slow) * 0.7);
  out.push_back(past.at(0, foot.ankle).y() * 0.4);
  append(out, Vec2(movement(0, foot.toe) * 0.7));
  out.push_back(past.at(0, foot.toe).y() * 0.25);
  append(out, Vec2(mirrored(onFloor(past.at(0, foot.ankle) - past.at(0, 0))) * 0.08));
  append(out, Vec2(movement(0, 0) * 0.5));
  // The other foot says when this one may leave, the control whether it has to.
  append(out, Vec2(movement(0, foot.other) * 0.5));
  out.push_back(past.at(0, foot.other).y() * 0.15);
  append(out, Vec2(squeezed(mirrored({past.control[0], past.control[1]}), slow) * 0.5));
  out.push_back(std::asinh(past.control[2] * foot.side / 0.02) * 0.3);
  return out;
}

std::vector<double> EngineKinematic::regimeFeatures(const Past& past) const {
  std::vector<double> out;
  out.reserve(m_regimeCentres.features);
  for (const int joint : m_contacts) append(out, squeezed(past.movement(0, joint), 0.5));
  for (const int joint : m_contacts) out.push_back(past.at(0, joint).y() * 0.3);
  for (const Foot& foot : m_feet) append(out, Vec2(onFloor(past.at(0, foot.ankle)) * 0.05));
  for (const size_t i : {0, 1}) out.push_back(std::asinh(past.control[i] / 0.5) * 0.7);
  out.push_back(std::asinh(past.control[2] / 0.02) * 0.5);
  double way = 0.0;
  for (size_t j = 0; j < m_joints; ++j) way += past.movement(0, static_cast<int>(j)).norm();
  out.push_back(std::asinh(way / static_cast<double>(m_joints) / 0.3));
  return out;
}

void EngineKinematic::netFeatures(const Past& past, std::span<const double> rich,
                                  float* out) const {
  std::vector<double> centred(rich.size());
  for (size_t i = 0; i < rich.size(); ++i) centred[i] = rich[i] - m_netMean[i];
  std::vector<double> values(static_cast<size_t>(m_netProjection.paddedColumns()));
  m_netProjection.addTo(centred, values);
  values.resize(static_cast<size_t>(m_netProjection.columns()));
  const size_t speeds = rich.size() - m_speedScale.size(),
               controls = speeds - m_controlScale.size();
  for (size_t i = 0; i < m_speedScale.size(); ++i)
    values.push_back(centred[speeds + i] / m_speedScale[i]);
  for (size_t i = 0; i < m_controlScale.size(); ++i)
    values.push_back(centred[controls + i] / m_controlScale[i]);
  for (const int joint : m_contacts) values.push_back((past.at(0, joint).y() - 10.0) / 5.0);
  for (const double value : values) *out++ = static_cast<float>(std::clamp(value, -6.0, 6.0));
}

}  // namespace marey::moglow
