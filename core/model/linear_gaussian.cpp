#include "model/linear_gaussian.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"

namespace marey {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kRidge = 1e-4;    ///< of regressors of unit variance
constexpr long kMostRows = 60000;  ///< frames that the fit looks at, evenly chosen
constexpr long kTogether = 2048;   ///< rows of a product
constexpr const char* kWeight = "yardstick/weight";
constexpr const char* kBias = "yardstick/bias";
constexpr const char* kFactor = "yardstick/factor";
constexpr const char* kDirections = "yardstick/floor_directions";

long widthOf(const FeatureSequence& s, int order) {
  return order * s.pose.cols() + 2 * s.control.cols();
}

/// Regressors of frame t.
void regressors(const FeatureSequence& s, int order, long t, Eigen::Ref<VectorXd> out) {
  const long d = s.pose.cols(), c = s.control.cols();
  for (int lag = 1; lag <= order; ++lag)
    out.segment((lag - 1) * d, d) = s.pose.row(t - lag).cast<double>();
  out.segment(order * d, c) = s.control.row(t).cast<double>();
  out.segment(order * d + c, c) = s.control.row(t - 1).cast<double>();
}

/// [regressors, pose] of frame t.
void jointRow(const FeatureSequence& s, int order, long t, Eigen::Ref<VectorXd> out) {
  const long d = s.pose.cols();
  regressors(s, order, t, out.head(out.size() - d));
  out.tail(d) = s.pose.row(t).cast<double>();
}

/// Means and second moments of [regressors, pose].
struct Moments {
  VectorXd mean;
  MatrixXd covariance;
};

Moments momentsOf(const std::vector<FeatureSequence>& sequences, int order) {
  std::vector<std::pair<const FeatureSequence*, long>> rows;
  for (const FeatureSequence& s : sequences)
    for (long t = order; t < s.pose.rows(); ++t) rows.emplace_back(&s, t);
  if (rows.empty())
    throwInput({.path = "training data"}, fmt::format("clips of more than {} frames", order),
               "none");
  const auto all = static_cast<long>(rows.size()), count = std::min(all, kMostRows);
  const long x = widthOf(*rows.front().first, order), width = x + rows.front().first->pose.cols();
  // Seen from the first row, so that what never changes has a variance of exactly zero.
  VectorXd origin(width), sum = VectorXd::Zero(width);
  jointRow(*rows.front().first, order, rows.front().second, origin);
  MatrixXd square = MatrixXd::Zero(width, width);
  MatrixXd block(width, kTogether);
  for (long first = 0; first < count; first += kTogether) {
    const long n = std::min(kTogether, count - first);
    for (long i = 0; i < n; ++i) {
      const auto [s, t] = rows[static_cast<size_t>((first + i) * all / count)];
      jointRow(*s, order, t, block.col(i));
    }
    block.leftCols(n).colwise() -= origin;
    sum += block.leftCols(n).rowwise().sum();
    square.selfadjointView<Eigen::Lower>().rankUpdate(block.leftCols(n));
  }
  const VectorXd mean = sum / static_cast<double>(count);
  MatrixXd covariance = square.selfadjointView<Eigen::Lower>();
  covariance = covariance / static_cast<double>(count) - mean * mean.transpose();
  return {mean + origin, covariance};
}

/// Floors [D] in units of floorM.
VectorXd scalesOf(const std::vector<double>& scale, long width) {
  if (scale.empty()) return VectorXd::Ones(width);
  return Eigen::Map<const VectorXd>(scale.data(), width);
}

}  // namespace

LinearGaussian fitLinearGaussian(const std::vector<FeatureSequence>& sequences, int order,
                                 double floorM, std::vector<double> floorScale) {
  const Moments m = momentsOf(sequences, order);
  const long d = sequences.front().pose.cols(), x = m.mean.size() - d;
  // What never changes in training keeps a scale that makes its weight vanish.
  const VectorXd scale = m.covariance.diagonal().head(x).cwiseMax(1e-12).cwiseSqrt();
  const MatrixXd cross = scale.cwiseInverse().asDiagonal() * m.covariance.topRightCorner(x, d);
  MatrixXd gram = scale.cwiseInverse().asDiagonal() * m.covariance.topLeftCorner(x, x) *
                  scale.cwiseInverse().asDiagonal();
  const MatrixXd plain = gram;
  gram.diagonal().array() += kRidge;
  const MatrixXd w = gram.llt().solve(cross).transpose();  // [D, X], of unit regressors
  const MatrixXd explained = w * cross;
  MatrixXd left = m.covariance.bottomRightCorner(d, d) - explained - explained.transpose() +
                  w * plain * w.transpose();
  const VectorXd floors = scalesOf(floorScale, d);
  LinearGaussian out{.order = order, .floorM = floorM, .floorScale = std::move(floorScale)};
  out.weight = w * scale.cwiseInverse().asDiagonal();
  out.bias = m.mean.tail(d) - out.weight * m.mean.head(x);
  const MatrixXd inFloors =
      floors.cwiseInverse().asDiagonal() * left * floors.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> axes(inFloors, Eigen::EigenvaluesOnly);
  out.floorDirections = static_cast<int>((axes.eigenvalues().array() <= floorM * floorM).count());
  left.diagonal().array() += floorM * floorM * floors.array().square();
  out.factor = left.llt().matrixL();
  return out;
}

std::vector<double> logDensity(const LinearGaussian& model, const FeatureSequence& sequence,
                               int first) {
  const long d = sequence.pose.cols();
  const auto lower = model.factor.triangularView<Eigen::Lower>();
  // The mean of a quadratic form over noise: what it is without, and the trace.
  const MatrixXd floors(scalesOf(model.floorScale, d).asDiagonal());
  const double trace = lower.solve(floors).squaredNorm();
  const double constant = -0.5 * static_cast<double>(d) * std::log(2.0 * std::numbers::pi) -
                          model.factor.diagonal().array().log().sum() -
                          0.5 * model.floorM * model.floorM * trace;
  std::vector<double> out;
  VectorXd x(widthOf(sequence, model.order));
  for (long t = first; t < sequence.pose.rows(); ++t) {
    regressors(sequence, model.order, t, x);
    const VectorXd error =
        sequence.pose.row(t).transpose().cast<double>() - model.weight * x - model.bias;
    out.push_back(constant - 0.5 * lower.solve(error).squaredNorm());
  }
  return out;
}

std::vector<int> leastExplainedJoints(const LinearGaussian& model, const FeatureSequence& sequence,
                                      int first) {
  const long d = sequence.pose.cols(), joints = d / 3;  // positions alone
  const MatrixXd inverse =
      model.factor.triangularView<Eigen::Lower>().solve(MatrixXd::Identity(d, d));
  const MatrixXd precision = inverse.transpose() * inverse;
  // Freed values of a normal density gain g' P^-1 g / 2, P their part of the precision.
  std::vector<Eigen::Matrix3d> freed;
  for (long j = 0; j < joints; ++j)
    freed.emplace_back(precision.block<3, 3>(3 * j, 3 * j).inverse());
  std::vector<int> out;
  VectorXd x(widthOf(sequence, model.order));
  for (long t = first; t < sequence.pose.rows(); ++t) {
    regressors(sequence, model.order, t, x);
    const VectorXd pull = precision * (sequence.pose.row(t).transpose().cast<double>() -
                                       model.weight * x - model.bias);
    double most = -1.0;
    int joint = 0;
    for (long j = 0; j < joints; ++j) {
      const Eigen::Vector3d g = pull.segment<3>(3 * j);
      const double gain = 0.5 * g.dot(freed[static_cast<size_t>(j)] * g);
      if (gain <= most) continue;
      most = gain;
      joint = static_cast<int>(j);
    }
    out.push_back(joint);
  }
  return out;
}

void store(const LinearGaussian& model, TensorFile& file) {
  const auto add = [&](const char* name, const MatrixXd& m) {
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = m;
    file.tensors[name] = Tensor::fromDoubles({m.rows(), m.cols()}, rows.data());
  };
  add(kWeight, model.weight);
  add(kBias, model.bias);
  add(kFactor, model.factor);
  const int64_t directions = model.floorDirections;
  file.tensors[kDirections] = Tensor::fromInt64({1}, &directions);
}

std::shared_ptr<const LinearGaussian> loadLinearGaussian(const TensorFile& file, int poseDim,
                                                         int controlDim, double floorM,
                                                         std::vector<double> floorScale,
                                                         const std::string& origin) {
  const auto stored = file.tensors.find(kWeight);
  if (stored == file.tensors.end()) return nullptr;
  const auto matrix = [&](const char* name, int64_t rows, int64_t cols) -> MatrixXd {
    const auto values = file.get(name, {rows, cols}, origin).toDoubles();
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const MatrixXd out = Eigen::Map<const RowMajor>(values.data(), rows, cols);
    if (!out.allFinite())
      throwInput({.path = origin, .item = std::string("tensor '") + name + "'"}, "finite values",
                 "NaN or infinity");
    return out;
  };
  const auto& shape = stored->second.shape;
  const int64_t poses = (shape.size() == 2 ? shape[1] : 0) - 2 * int64_t{controlDim};
  if (poses < poseDim || poses % poseDim != 0)
    throwInput({.path = origin, .item = std::string("tensor '") + kWeight + "'"},
               fmt::format("columns for whole poses of {} values and two controls of {}", poseDim,
                           controlDim),
               "{}", stored->second.shapeText());
  auto out = std::make_shared<LinearGaussian>();
  out->order = static_cast<int>(poses / poseDim);
  out->floorM = floorM;
  out->floorScale = std::move(floorScale);
  out->weight = matrix(kWeight, poseDim, shape[1]);
  out->bias = matrix(kBias, poseDim, 1);
  out->factor = matrix(kFactor, poseDim, poseDim);
  if (!(out->factor.diagonal().minCoeff() > 0.0))
    throwInput({.path = origin, .item = std::string("tensor '") + kFactor + "'"},
               "a diagonal above zero", "{}", out->factor.diagonal().minCoeff());
  out->floorDirections = static_cast<int>(file.get(kDirections, {1}, origin).toInt64().front());
  return out;
}

}  // namespace marey
