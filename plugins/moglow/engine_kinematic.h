// The kinematic base (kinematic_base.h) on the engine: the same steps for one row.
#pragma once

#include "moglow/engine_base.h"
#include "moglow/engine_chart.h"
#include "nn/engine/row_matrix.h"

namespace marey::moglow {

class BaseTensors;

class EngineKinematic : public EngineBase {
 public:
  EngineKinematic(const Config& config, const BodyFacts& body, const BaseTensors& stored);

 private:
  /// Past frames in the present root frame, newest first; cm, rad, shrunk to the trained body.
  struct Past {
    std::vector<std::vector<Eigen::Vector3d>> poses;  ///< [order][J]
    std::vector<double> control;                      ///< [3 * order]
    std::vector<double> lengths;                      ///< [J], cm, not shrunk
    double size = 1.0;
    const Eigen::Vector3d& at(size_t lag, int joint) const {
      return poses[lag][static_cast<size_t>(joint)];
    }
    /// How far a joint went in a past frame.
    Eigen::Vector3d movement(size_t lag, int joint) const {
      return at(lag, joint) - at(lag + 1, joint);
    }
  };
  /// Centres of clusters, [features, clusters].
  struct Centres {
    size_t features = 0, clusters = 0;
    std::vector<double> values;
    size_t nearest(std::span<const double> point) const;
  };
  struct Foot {
    int ankle, toe, hip, other, knee;
    double side;          ///< +1 for a left foot, -1 for a right one
    double floor, reach;  ///< cm: lowest height, longest way to the hip
  };
  /// What a cluster of a foot's movement says of its gate.
  struct Gait {
    double hold, skew, kneeSlope, boneSlope, slack;
    std::array<double, kGateKnots> radii;
  };

  void foreseeRow(const float* history, const float* control, float* features,
                  RowForesight& seen) const override;
  void toPoseRow(const RowForesight& seen, const float* innovation, float* pose) const override;
  double toInnovationRow(const RowForesight& seen, const float* pose,
                         float* innovation) const override;

  void readGaits(const BaseTensors& stored);
  static Centres centresOf(const std::vector<double>& rows, size_t features);
  Past pastOf(const float* history, const float* control) const;
  void meetBody(Past& past) const;
  std::vector<double> regressors(const Past& past) const;
  std::vector<double> footFeatures(const Past& past, const Foot& foot) const;
  std::vector<double> regimeFeatures(const Past& past) const;
  void netFeatures(const Past& past, std::span<const double> regressors, float* out) const;
  void foreseePose(const Past& past, std::span<const double> regressors, RowForesight& seen) const;
  void foreseeFoot(const Past& past, const Foot& foot, const RowForesight& seen,
                   FootForesight& out) const;
  std::vector<Eigen::Vector3d> inCentimetres(const float* pose) const;

  Config m_config;
  size_t m_joints;
  std::vector<Foot> m_feet;
  std::vector<int> m_contacts, m_parents;
  std::vector<size_t> m_order;  ///< [D]: feet's held coordinates first
  std::vector<double> m_poseMean, m_poseStd, m_controlMean, m_controlStd, m_predictable, m_lengths;
  EngineChart m_chart;
  std::vector<double> m_foreseenMean, m_foreseenBias, m_richMean, m_netMean, m_speedScale,
      m_controlScale, m_factorLogDet;
  nn::RowMatrix m_foreseenWeight, m_netProjection;
  std::vector<nn::RowMatrix> m_richWeight, m_factor, m_factorInverse;  ///< per regime
  Centres m_footCentres, m_regimeCentres;
  std::vector<Gait> m_gaits;
  double m_slowMovement, m_unitsLogDet, m_allLengths;
};

}  // namespace marey::moglow
