#include "motion/pose_solver.h"

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/SVD>

namespace marey {
namespace {

using Matrix3d = Eigen::Matrix3d;

/// Offsets shorter than this say nothing of a direction (a micrometre).
constexpr double kShortestM = 1e-6;
/// Children this near to one line (second singular value over the first) leave the twist to noise.
constexpr double kOneLine = 0.05;

Matrix3d crossMatrix(const Vec3d& v) {
  Matrix3d out;
  out << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return out;
}

Vec3d wanted(std::span<const Vec3> target, int joint) {
  return target[static_cast<size_t>(joint)].cast<double>();
}

}  // namespace

/// Normal equations: matrix * step = -gradient.
struct PoseSolver::System {
  Eigen::MatrixXd matrix;    ///< lower triangle
  Eigen::VectorXd gradient;  ///< half of it, as usual in least squares
  Eigen::VectorXd damping;
};

PoseSolver::PoseSolver(const Skeleton& skeleton)
    : m_parents(skeleton.parents),
      m_children(skeleton.names.size()),
      m_below(skeleton.names.size(), 1),
      m_observed(skeleton.names.size(), Observed::Nothing),
      m_axes(skeleton.names.size(), Vec3d::Zero()),
      m_anchors(skeleton.names.size(), -1),
      m_unknown(skeleton.names.size(), -1) {
  for (const auto& offset : skeleton.offsets) m_offsets.push_back(offset.cast<double>());
  for (size_t j = skeleton.names.size(); j-- > 1;) {
    const auto parent = static_cast<size_t>(m_parents[j]);
    m_below[parent] += m_below[j];
    m_children[parent].push_back(static_cast<int>(j));
  }
  for (size_t j = 0; j < m_children.size(); ++j) {
    Eigen::Matrix3Xd spread = Eigen::Matrix3Xd::Zero(3, static_cast<int>(m_children[j].size()) + 3);
    for (size_t c = 0; c < m_children[j].size(); ++c)
      spread.col(static_cast<int>(c)) = m_offsets[static_cast<size_t>(m_children[j][c])];
    const Eigen::JacobiSVD<Eigen::Matrix3Xd> svd(spread, Eigen::ComputeFullU);
    const Vec3d sizes = svd.singularValues();
    if (sizes[0] < kShortestM) continue;
    m_observed[j] = sizes[1] < kOneLine * sizes[0] ? Observed::Direction : Observed::Rotation;
    m_axes[j] = svd.matrixU().col(0);
    m_unknown[j] = m_unknowns;
    m_unknowns += 3;
  }
  for (size_t j = 1; j < m_anchors.size(); ++j) {
    const auto parent = static_cast<size_t>(m_parents[j]);
    m_anchors[j] = m_observed[parent] == Observed::Rotation ? m_parents[j] : m_anchors[parent];
  }
}

std::vector<Vec3d> PoseSolver::positions(const WorldPose& pose) const {
  std::vector<Vec3d> out(m_parents.size(), pose.root);
  for (size_t j = 1; j < out.size(); ++j) {
    const auto parent = static_cast<size_t>(m_parents[j]);
    out[j] = out[parent] + pose.rotations[parent] * m_offsets[j];
  }
  return out;
}

double PoseSolver::cost(const WorldPose& pose, std::span<const Vec3> target,
                        const Hold* hold) const {
  const std::vector<Vec3d> at = positions(pose);
  double out = 0.0;
  for (size_t j = 0; j < at.size(); ++j)
    out += (at[j] - wanted(target, static_cast<int>(j))).squaredNorm();
  for (size_t j = 0; hold != nullptr && j < at.size(); ++j)
    if (m_observed[j] == Observed::Rotation)
      out += hold->weight * strayed(pose, hold->before, j).squaredNorm();
  return out;
}

Quatd PoseSolver::alignedJoint(int joint, const Quatd& parent, std::span<const Vec3> target) const {
  const auto j = static_cast<size_t>(joint);
  Matrix3d moment = Matrix3d::Zero();
  for (const int child : m_children[j])
    moment += (wanted(target, child) - wanted(target, joint)) *
              m_offsets[static_cast<size_t>(child)].transpose();
  if (m_observed[j] == Observed::Direction) {
    const Vec3d direction = moment * m_axes[j];
    const bool points = direction.norm() > kShortestM * kShortestM;
    return points ? shortestArc(parent * m_axes[j], direction) * parent : parent;
  }
  if (m_observed[j] == Observed::Nothing) return parent;
  const Eigen::JacobiSVD<Matrix3d> svd(moment, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d proper = Matrix3d::Identity();
  proper(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  return Quatd(Matrix3d(svd.matrixU() * proper * svd.matrixV().transpose())).normalized();
}

WorldPose PoseSolver::aligned(std::span<const Vec3> target) const {
  WorldPose out{wanted(target, 0), {}};
  for (size_t j = 0; j < m_parents.size(); ++j) {
    const Quatd parent =
        j == 0 ? Quatd::Identity() : out.rotations[static_cast<size_t>(m_parents[j])];
    out.rotations.push_back(alignedJoint(static_cast<int>(j), parent, target));
  }
  return out;
}

void PoseSolver::build(const WorldPose& pose, std::span<const Vec3> target, System& system) const {
  const size_t joints = m_parents.size();
  std::vector<Vec3d> error = positions(pose);  // then summed over subtrees
  std::vector<Vec3d> bone(joints, Vec3d::Zero());
  for (size_t j = 0; j < joints; ++j) error[j] -= wanted(target, static_cast<int>(j));
  for (size_t j = joints; j-- > 1;) {
    const auto parent = static_cast<size_t>(m_parents[j]);
    error[parent] += error[j];
    bone[j] = pose.rotations[parent] * m_offsets[j];
  }
  system.matrix.setZero(m_unknowns, m_unknowns);
  system.gradient.setZero(m_unknowns);
  system.gradient.head<3>() = error[0];
  system.matrix.topLeftCorner<3, 3>() = m_below[0] * Matrix3d::Identity();
  for (size_t b = 1; b < joints; ++b) {
    const int row = m_unknown[static_cast<size_t>(m_parents[b])];
    if (row < 0) continue;
    // A turn w of the parent moves the bone's whole subtree by w x bone.
    const double count = m_below[b];
    system.gradient.segment<3>(row) += bone[b].cross(error[b]);
    system.matrix.block<3, 3>(row, 0) += count * crossMatrix(bone[b]);
    for (int c = static_cast<int>(b); c > 0; c = m_parents[static_cast<size_t>(c)]) {
      const int column = m_unknown[static_cast<size_t>(m_parents[static_cast<size_t>(c)])];
      if (column < 0) continue;
      const Vec3d& other = bone[static_cast<size_t>(c)];
      const Matrix3d block =
          bone[b].dot(other) * Matrix3d::Identity() - other * bone[b].transpose();
      system.matrix.block<3, 3>(row, column) += count * block;
    }
  }
  system.damping.resize(m_unknowns);
  for (int i = 0; i < m_unknowns; i += 3)
    system.damping.segment<3>(i).setConstant(system.matrix.diagonal().segment<3>(i).sum() / 2.0 +
                                             1e-12);
}

Vec3d PoseSolver::strayed(const WorldPose& pose, const WorldPose& before, size_t joint) const {
  Quatd carried = before.rotations[joint];
  if (m_anchors[joint] >= 0) {
    const auto anchor = static_cast<size_t>(m_anchors[joint]);
    carried = pose.rotations[anchor] * before.rotations[anchor].conjugate() * carried;
  }
  return logMap(pose.rotations[joint] * carried.conjugate());
}

void PoseSolver::addHold(const WorldPose& pose, const Hold& hold, System& system) const {
  const Matrix3d block = hold.weight * Matrix3d::Identity();
  for (size_t j = 0; j < m_observed.size(); ++j) {
    if (m_observed[j] != Observed::Rotation) continue;
    const Vec3d pull = hold.weight * strayed(pose, hold.before, j);
    const int row = m_unknown[j];
    system.gradient.segment<3>(row) += pull;
    system.matrix.block<3, 3>(row, row) += block;
    if (m_anchors[j] < 0) continue;
    const int column = m_unknown[static_cast<size_t>(m_anchors[j])];
    system.gradient.segment<3>(column) -= pull;
    system.matrix.block<3, 3>(column, column) += block;
    system.matrix.block<3, 3>(row, column) -= block;
  }
}

WorldPose PoseSolver::stepped(const WorldPose& pose, const Eigen::VectorXd& step) const {
  WorldPose out = pose;
  out.root += step.head<3>();
  for (size_t j = 0; j < m_unknown.size(); ++j)
    if (m_unknown[j] >= 0)
      out.rotations[j] = (expMap(step.segment<3>(m_unknown[j])) * pose.rotations[j]).normalized();
  return out;
}

double PoseSolver::solve(std::span<const Vec3> target, WorldPose& pose, const Hold* hold) const {
  constexpr int kMostSteps = 60;
  constexpr double kLeastDamping = 1e-7, kMostDamping = 1e6;
  constexpr double kLeastStep = 1e-7;   // metres and radians
  constexpr double kLeastGain = 1e-12;  // of the cost
  WorldPose start = aligned(target);
  const double startCost = cost(start, target, hold);
  if (pose.rotations.size() != start.rotations.size() || startCost < cost(pose, target, hold))
    pose = std::move(start);
  double best = cost(pose, target, hold);
  System system;
  double damping = 1e-4;
  bool moved = true;
  for (int i = 0; i < kMostSteps && damping < kMostDamping; ++i) {
    if (moved) {
      build(pose, target, system);
      if (hold != nullptr) addHold(pose, *hold, system);
    }
    Eigen::MatrixXd damped = system.matrix;
    damped.diagonal() += damping * system.damping;
    const Eigen::VectorXd step = -damped.llt().solve(system.gradient);
    if (step.cwiseAbs().maxCoeff() < kLeastStep) break;
    WorldPose next = stepped(pose, step);
    const double found = cost(next, target, hold);
    moved = found < best;
    if (!moved) {
      damping *= 10.0;
      continue;
    }
    const double gain = best - found;
    pose = std::move(next);
    best = found;
    if (gain < kLeastGain * best) break;
    damping = std::max(damping / 10.0, kLeastDamping);
  }
  return best;
}

}  // namespace marey
