#include "moglow/engine_kinematic.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "moglow/base_tensors.h"

namespace marey::moglow {
namespace {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

std::vector<Vec3> vectorsOf(const std::vector<double>& values) {
  std::vector<Vec3> out;
  for (size_t i = 0; i + 2 < values.size(); i += 3)
    out.emplace_back(values[i], values[i + 1], values[i + 2]);
  return out;
}

EngineChart chartOf(const BodyFacts& body, const BaseTensors& stored) {
  return EngineChart({.parents = body.parents,
                      .feet = body.feet,
                      .lengths = stored.numbers("bone_lengths"),
                      .axes = vectorsOf(stored.numbers("bone_axes")),
                      .sides = vectorsOf(stored.numbers("bone_sides"))});
}

/// Two bones above a foot, or as far up as the skeleton goes.
int hipOf(const std::vector<int>& parents, int foot) {
  for (int bones = 0; bones < 2 && parents[static_cast<size_t>(foot)] >= 0; ++bones)
    foot = parents[static_cast<size_t>(foot)];
  return foot;
}

/// The pose's coordinates with the first two of every foot in front.
std::vector<size_t> feetFirst(const std::vector<int>& feet, size_t poseDim) {
  std::vector<size_t> out, rest(poseDim);
  std::iota(rest.begin(), rest.end(), size_t{0});
  for (const int foot : feet)
    for (const size_t i : {3 * static_cast<size_t>(foot), 3 * static_cast<size_t>(foot) + 1}) {
      out.push_back(i);
      std::erase(rest, i);
    }
  out.insert(out.end(), rest.begin(), rest.end());
  return out;
}

/// What was foreseen for a body of the trained size, for one of another. How far things stray from
/// it stays as it is: a floor in millimetres does not shrink with a body.
void resize(RowForesight& seen, double size) {
  for (double& value : seen.predicted) value *= size;
  for (Vec3& joint : seen.pose) joint *= size;
  for (FootForesight& foot : seen.feet) {
    foot.last *= size;
    foot.place *= size;
    foot.foreseen *= size;
    foot.knee *= size;
  }
}

std::vector<double> zerosFor(const nn::RowMatrix& matrix) {
  return std::vector<double>(static_cast<size_t>(matrix.paddedColumns()), 0.0);
}

}  // namespace

size_t EngineKinematic::Centres::nearest(std::span<const double> point) const {
  std::vector<double> distance(clusters, 0.0);
  for (size_t f = 0; f < features; ++f) {
    const double x = point[f], *row = values.data() + f * clusters;
    for (size_t c = 0; c < clusters; ++c) distance[c] += (x - row[c]) * (x - row[c]);
  }
  return static_cast<size_t>(std::min_element(distance.begin(), distance.end()) - distance.begin());
}

EngineKinematic::Centres EngineKinematic::centresOf(const std::vector<double>& rows,
                                                    size_t features) {
  Centres out{.features = features, .clusters = rows.size() / features, .values = {}};
  for (size_t f = 0; f < features; ++f)
    for (size_t c = 0; c < out.clusters; ++c) out.values.push_back(rows[c * features + f]);
  return out;
}

EngineKinematic::EngineKinematic(const Config& c, const BodyFacts& body, const BaseTensors& stored)
    : EngineBase(c),
      m_config(c),
      m_joints(body.parents.size()),
      m_parents(body.parents),
      m_order(feetFirst(body.feet, 3 * body.parents.size())),
      m_chart(chartOf(body, stored)) {
  const auto floors = stored.numbers("foot_floor"), reaches = stored.numbers("reach");
  const size_t feet = body.feet.size();
  for (size_t f = 0; f < feet; ++f) {
    m_feet.push_back({.ankle = body.feet[f],
                      .toe = body.toes[f],
                      .hip = hipOf(body.parents, body.feet[f]),
                      .other = body.feet[std::min(f ^ 1U, feet - 1)],
                      .knee = body.parents[static_cast<size_t>(body.feet[f])],
                      .side = f % 2 == 0 ? 1.0 : -1.0,
                      .floor = floors[f],
                      .reach = reaches[f]});
    m_contacts.push_back(body.feet[f]);
    m_contacts.push_back(body.toes[f]);
  }
  m_poseMean = stored.numbers("pose_mean");
  m_poseStd = stored.numbers("pose_std");
  m_controlMean = stored.numbers("control_mean");
  m_controlStd = stored.numbers("control_std");
  m_predictable = stored.numbers("predictable");
  m_lengths = stored.numbers("bone_lengths");
  m_allLengths = std::accumulate(m_lengths.begin(), m_lengths.end(), 0.0);
  m_foreseenMean = stored.numbers("foreseen_mean");
  m_foreseenBias = stored.numbers("foreseen_bias");
  m_foreseenWeight = stored.matrix("foreseen_weight");
  m_richMean = stored.numbers("rich_mean");
  m_richWeight = stored.matrices("rich_weight", false);
  m_factor = stored.matrices("factor", true);
  m_factorInverse = stored.matrices("factor_inverse", true);
  m_factorLogDet = stored.numbers("factor_log_det");
  m_netMean = stored.numbers("net_mean");
  m_netProjection = stored.matrix("net_projection");
  m_speedScale = stored.numbers("speed_scale");
  m_controlScale = stored.numbers("control_scale");
  m_slowMovement = stored.number("slow_movement");
  const auto centres = stored.numbers("regime_centres");
  m_regimeCentres = centresOf(centres, centres.size() / static_cast<size_t>(c.regimes));
  readGaits(stored);
  // Density of standardised poses, not of centimetres.
  m_unitsLogDet = static_cast<double>(m_poseStd.size()) * std::log(100.0);
  for (const double std : m_poseStd) m_unitsLogDet += std::log(std);
}

void EngineKinematic::readGaits(const BaseTensors& stored) {
  m_footCentres = centresOf(stored.numbers("foot_centres"), kFootFeatures);
  const auto hold = stored.numbers("foot_hold"), skew = stored.numbers("foot_skew"),
             radii = stored.numbers("foot_radii"), knee = stored.numbers("knee_slope"),
             bone = stored.numbers("bone_slope"), slack = stored.numbers("slack");
  for (size_t i = 0; i < hold.size(); ++i) {
    m_gaits.push_back({.hold = hold[i],
                       .skew = skew[i],
                       .kneeSlope = knee[i],
                       .boneSlope = bone[i],
                       .slack = slack[i],
                       .radii = {}});
    std::copy_n(radii.data() + i * kGateKnots, kGateKnots, m_gaits.back().radii.begin());
  }
}

std::vector<Vec3> EngineKinematic::inCentimetres(const float* pose) const {
  std::vector<Vec3> out(m_joints);
  for (size_t j = 0; j < m_joints; ++j)
    for (size_t i = 0; i < 3; ++i)
      out[j][static_cast<long>(i)] =
          (pose[3 * j + i] * m_poseStd[3 * j + i] + m_poseMean[3 * j + i]) * 100.0;
  return out;
}

void EngineKinematic::foreseeRow(const float* history, const float* control, float* features,
                                 RowForesight& seen) const {
  const Past past = pastOf(history, control);
  const auto rich = regressors(past);
  foreseePose(past, rich, seen);
  netFeatures(past, rich, features);
}

void EngineKinematic::foreseePose(const Past& past, std::span<const double> rich,
                                  RowForesight& seen) const {
  // Chart coordinates, by the regime's regression.
  seen.regime = m_regimeCentres.nearest(regimeFeatures(past));
  const nn::RowMatrix& weight = m_richWeight[seen.regime];
  std::vector<double> centred(rich.size() + 1, 1.0);
  for (size_t i = 0; i < rich.size(); ++i) centred[i] = rich[i] - m_richMean[i];
  seen.predicted = zerosFor(weight);
  weight.addTo(centred, seen.predicted);
  // The pose where no foot is held.
  const size_t plain = m_foreseenMean.size();
  for (size_t i = 0; i < plain; ++i) centred[i] = rich[i] - m_foreseenMean[i];
  auto step = zerosFor(m_foreseenWeight);
  m_foreseenWeight.addTo(std::span(centred).first(plain), step);
  seen.pose = past.poses.front();
  for (size_t j = 0; j < m_joints; ++j)
    for (size_t i = 0; i < 3; ++i)
      seen.pose[j][static_cast<long>(i)] += step[3 * j + i] + m_foreseenBias[3 * j + i];
  seen.feet.resize(m_feet.size());
  Vec3 pull = Vec3::Zero();
  for (size_t f = 0; f < m_feet.size(); ++f) {
    FootForesight& out = seen.feet[f];
    foreseeFoot(past, m_feet[f], seen, out);
    // A body that is about to go out of reach of the feet that it stands on stays with them.
    const Vec3& hip = seen.pose[static_cast<size_t>(m_feet[f].hip)];
    const double excess = std::max((out.last - hip).norm() - m_feet[f].reach, 0.0),
                 firm = out.hold * out.hold * (out.hold * out.hold);
    const Vec3 way = out.place - hip;
    pull += std::min(excess, kStretch) * firm * way / std::max(way.norm(), 1e-3);
  }
  for (Vec3& joint : seen.pose) joint += pull;
  for (size_t i = 0; i < m_predictable.size(); ++i) seen.predicted[i] *= m_predictable[i];
  seen.lengths = past.lengths;
  resize(seen, past.size);
}

void EngineKinematic::foreseeFoot(const Past& past, const Foot& foot, const RowForesight& seen,
                                  FootForesight& out) const {
  const Gait& gait = m_gaits[m_footCentres.nearest(footFeatures(past, foot))];
  const Vec3 &hip = seen.pose[static_cast<size_t>(foot.hip)],
             &aim = seen.pose[static_cast<size_t>(foot.ankle)];
  out.last = past.at(0, foot.ankle);
  // A foot out of reach has to come along.
  const double stretch = std::max((out.last - hip).norm() - foot.reach, 0.0) / kStretch;
  out.hold = gait.hold * std::exp(-stretch * stretch);
  out.place = out.last + (1.0 - out.hold) * (aim - out.last);
  out.place.y() = std::max(out.place.y(), foot.floor);
  const auto at = static_cast<size_t>(3 * foot.ankle);
  out.foreseen = {seen.predicted[at], seen.predicted[at + 1]};
  out.knee = seen.predicted[static_cast<size_t>(3 * foot.knee) + 1];
  out.skew = gait.skew;
  out.kneeSlope = gait.kneeSlope;
  out.boneSlope = gait.boneSlope;
  out.slack = gait.slack;
  // Radial quantiles are relative to a length that is small for a slow foot.
  const auto floorWay = [&](size_t lag) {
    const Vec3 way = past.at(0, foot.ankle) - past.at(lag, foot.ankle);
    return std::hypot(way.x(), way.z());
  };
  const double speed = std::min(floorWay(1), floorWay(2) / 2.0),
               scale = std::min(0.06 + 0.45 * speed, 0.9 + 0.02 * speed);
  for (size_t i = 0; i < out.radii.size(); ++i) out.radii[i] = gait.radii[i] * scale;
}

double EngineKinematic::toInnovationRow(const RowForesight& seen, const float* pose,
                                        float* innovation) const {
  std::vector<double> local(3 * m_joints), residual(3 * m_joints);
  const double logDet = m_chart.toChart(seen, inCentimetres(pose), local);
  for (size_t i = 0; i < m_order.size(); ++i)
    residual[i] = local[m_order[i]] - seen.predicted[m_order[i]];
  const nn::RowMatrix& inverse = m_factorInverse[seen.regime];
  auto e = zerosFor(inverse);
  inverse.addTo(residual, e);
  for (size_t i = 0; i < m_order.size(); ++i) innovation[i] = static_cast<float>(e[i]);
  return logDet + m_factorLogDet[seen.regime] + m_unitsLogDet;
}

void EngineKinematic::toPoseRow(const RowForesight& seen, const float* innovation,
                                float* pose) const {
  const nn::RowMatrix& factor = m_factor[seen.regime];
  const std::vector<double> e(innovation, innovation + m_order.size());
  auto residual = zerosFor(factor);
  factor.addTo(e, residual);
  std::vector<double> local(m_order.size());
  for (size_t i = 0; i < m_order.size(); ++i)
    local[m_order[i]] = residual[i] + seen.predicted[m_order[i]];
  std::vector<Vec3> joints(m_joints);
  m_chart.fromChart(seen, local, joints);
  for (size_t j = 0; j < m_joints; ++j)
    for (size_t i = 0; i < 3; ++i)
      pose[3 * j + i] = static_cast<float>(
          (joints[j][static_cast<long>(i)] / 100.0 - m_poseMean[3 * j + i]) / m_poseStd[3 * j + i]);
}

}  // namespace marey::moglow
