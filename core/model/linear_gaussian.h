// The yardstick beside every likelihood: what a linear-Gaussian autoregression without a network
// makes of the same frames,
//
//   x_t ~ N(A [x_{t-1}, ..., x_{t-order}] + B [c_t, c_{t-1}] + b, S + F^2),
//
// poses in the units of their representation, F the diagonal of their floors, control as in
// FeatureSequence. A, B, b by ridge regression on training sequences, S the covariance of what that
// leaves, and the models' own observation floor.
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Dense>

#include "base/tensor_file.h"
#include "motion/features.h"

namespace marey {

struct LinearGaussian {
  int order = 0;
  double floorM = 0.0;
  std::vector<double> floorScale = {};  ///< [D]: of the floor (floorScales); empty: 1
  Eigen::MatrixXd weight;   ///< [D, order * D + 2 * C]: newest pose first, then c_t and c_{t-1}
  Eigen::VectorXd bias;     ///< [D]
  Eigen::MatrixXd factor;   ///< [D, D]: lower triangular, factor factor' = S + F^2
  int floorDirections = 0;  ///< eigenvalues of S, in floors, that are at most 1
};

/// Throws InputError where no sequence has more than `order` frames.
LinearGaussian fitLinearGaussian(const std::vector<FeatureSequence>& sequences, int order,
                                 double floorM, std::vector<double> floorScale = {});

/// Log-density of frames first .. of a sequence in nats, poses in their units: its mean over noise
/// of the floor on the frame that is foreseen, in closed form. `first` >= order.
std::vector<double> logDensity(const LinearGaussian& model, const FeatureSequence& sequence,
                               int first);

/// The joint of every frame first .. that the others explain least: the one with which a frame
/// gains most nats if it may go where the others make it likeliest. For poses whose values are the
/// positions of joints, three each.
std::vector<int> leastExplainedJoints(const LinearGaussian& model, const FeatureSequence& sequence,
                                      int first);

void store(const LinearGaussian& model, TensorFile& file);
/// Null where the file has none. Throws InputError naming `origin`.
std::shared_ptr<const LinearGaussian> loadLinearGaussian(const TensorFile& file, int poseDim,
                                                         int controlDim, double floorM,
                                                         std::vector<double> floorScale,
                                                         const std::string& origin);

}  // namespace marey
