// The linear base (linear_base.h) on the engine.
#pragma once

#include "moglow/engine_base.h"
#include "nn/engine/row_matrix.h"

namespace marey::moglow {

class BaseTensors;

class EngineLinear : public EngineBase {
 public:
  EngineLinear(const Config& config, const BaseTensors& stored);

 private:
  void foreseeRow(const float* history, const float* control, float* features,
                  RowForesight& seen) const override;
  void toPoseRow(const RowForesight& seen, const float* innovation, float* pose) const override;
  double toInnovationRow(const RowForesight& seen, const float* pose,
                         float* innovation) const override;

  long m_poseDim, m_controlDim, m_tau, m_order, m_lookahead;
  nn::RowMatrix m_weight, m_whiten, m_unwhiten, m_historyWhiten;
  std::vector<double> m_bias, m_historyMean;
  double m_logDet;
};

}  // namespace marey::moglow
