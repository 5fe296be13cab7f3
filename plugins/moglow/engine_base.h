// The pose bases ('MG+') as sampling and scoring run them: the functions of LinearBase and
// KinematicBase row by row, in double precision, with every sum in one order. What comes out for a
// row is the same bits whatever rows are beside it, on any number of threads, on every set of
// kernels. The libtorch bases are fitted, train and stay as the plain path that this one is tested
// against. No libtorch type appears here.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "base/tensor_file.h"
#include "moglow/base_constants.h"
#include "moglow/body_facts.h"
#include "moglow/config.h"

namespace marey::moglow {

/// What is foreseen of one foot, see Foreseen and FootGate in bone_chart.h; lengths in cm.
struct FootForesight {
  Eigen::Vector3d last, place;
  double hold = 0.0;
  Eigen::Vector2d foreseen;
  double knee = 0.0, skew = 0.0;
  std::array<double, kGateKnots> radii{};
  double kneeSlope = 1.0, boneSlope = 1.0, slack = 0.0;
};

/// What a base makes of one frame's history and control, for the way in both directions.
struct RowForesight {
  std::vector<double>
      predicted;  ///< [D]: standardised pose (linear), chart coordinates (kinematic)
  std::vector<Eigen::Vector3d> pose;  ///< kinematic: joints where no foot is held, cm
  std::vector<double> lengths;        ///< kinematic: [J], of the bones that end in the joints, cm
  std::vector<FootForesight> feet;
  size_t regime = 0;
};

class EngineBase {
 public:
  virtual ~EngineBase() = default;

  /// history [rows, tau * D] and control [rows, (tau + 1 + lookahead) * C], standardised, oldest
  /// first. Features for the nets go to `features`, `stride` floats from row to row.
  void foresee(long rows, const float* history, const float* control, float* features, long stride,
               std::vector<RowForesight>& seen) const;
  /// Innovations [rows, D] to standardised poses [rows, D].
  void toPose(std::span<const RowForesight> seen, const float* innovation, float* pose) const;
  /// Standardised poses to innovations [rows, D] and log-determinants [rows].
  void toInnovation(std::span<const RowForesight> seen, const float* pose, float* innovation,
                    double* logDet) const;

 protected:
  explicit EngineBase(const Config& config);

 private:
  virtual void foreseeRow(const float* history, const float* control, float* features,
                          RowForesight& seen) const = 0;
  virtual void toPoseRow(const RowForesight& seen, const float* innovation, float* pose) const = 0;
  /// The log-determinant.
  virtual double toInnovationRow(const RowForesight& seen, const float* pose,
                                 float* innovation) const = 0;

  long m_poseDim, m_historyWidth, m_controlWidth;
};

/// Reads tensors that are known to be whole, stored as `name` ("weights/NAME.TENSOR"). Null without
/// a base.
std::unique_ptr<const EngineBase> makeEngineBase(const Config& config, const BodyFacts& body,
                                                 const TensorFile& file, const std::string& name);

}  // namespace marey::moglow
