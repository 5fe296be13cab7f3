#include "motion/representation/mirror_plan.h"

#include <Eigen/SVD>

#include "motion/representation/rest_pose.h"
#include "motion/roles.h"

namespace marey {
namespace {

/// Share of the identity in what a correction is fitted to: where offsets leave a turn open, it is
/// none.
constexpr double kNoTurn = 1e-6;

/// M q M: the axis is mirrored as an axial vector.
Quatd reflected(const Quatd& q) {
  return {q.w(), q.x(), -q.y(), -q.z()};
}

Vec3d reflected(const Vec3d& v) {
  return {-v.x(), v.y(), v.z()};
}

std::vector<Quatd> worldOf(const std::vector<Quatd>& local, const std::vector<int>& parents) {
  std::vector<Quatd> out = local;
  for (size_t j = 1; j < out.size(); ++j)
    out[j] = (out[static_cast<size_t>(parents[j])] * local[j]).normalized();
  return out;
}

/// The rotation R with the least sum of |R from - to|^2 (Kabsch 1976).
Quatd nearestTurn(const Eigen::Matrix3d& covariance) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d flip = Eigen::Matrix3d::Identity();
  flip(2, 2) = svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0 ? -1.0 : 1.0;
  return Quatd(svd.matrixU() * flip * svd.matrixV().transpose()).normalized();
}

}  // namespace

MirrorPlan::MirrorPlan(const Skeleton& skeleton)
    : m_parents(skeleton.parents), m_other(rolesOf(skeleton).mirror) {
  const auto rest = worldOf(restRotations(skeleton), m_parents);
  std::vector<Eigen::Matrix3d> covariances(rest.size(), Eigen::Matrix3d::Zero());
  for (size_t j = 0; j < rest.size(); ++j)
    m_turns.push_back(reflected(rest[static_cast<size_t>(m_other[j])]).conjugate() * rest[j]);
  for (size_t child = 1; child < rest.size(); ++child) {
    const auto j = static_cast<size_t>(m_parents[child]);
    const auto opposite = static_cast<size_t>(m_other[child]);
    // Trees that differ between the sides say nothing here.
    if (m_parents[opposite] != m_other[j]) continue;
    covariances[j] +=
        (m_turns[j].conjugate() * reflected(skeleton.offsets[opposite].cast<double>().eval())) *
        skeleton.offsets[child].cast<double>().transpose();
  }
  for (size_t j = 0; j < rest.size(); ++j) {
    const double size = covariances[j].norm();
    if (size == 0.0) continue;
    covariances[j].diagonal().array() += kNoTurn * size;
    m_turns[j] = (m_turns[j] * nearestTurn(covariances[j])).normalized();
  }
}

std::vector<Quatd> MirrorPlan::mirrored(const std::vector<Quatd>& local) const {
  const std::vector<Quatd> world = worldOf(local, m_parents);
  std::vector<Quatd> out(world.size()), turned(world.size());
  for (size_t j = 0; j < world.size(); ++j) {
    turned[j] = reflected(world[static_cast<size_t>(m_other[j])]) * m_turns[j];
    out[j] = j == 0 ? turned[j] : turned[static_cast<size_t>(m_parents[j])].conjugate() * turned[j];
  }
  return out;
}

}  // namespace marey
