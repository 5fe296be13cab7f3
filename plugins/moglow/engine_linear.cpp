#include "moglow/engine_linear.h"

#include <algorithm>

#include "moglow/base_tensors.h"

namespace marey::moglow {
namespace {

std::vector<double> zerosFor(const nn::RowMatrix& matrix) {
  return std::vector<double>(static_cast<size_t>(matrix.paddedColumns()), 0.0);
}

void store(const std::vector<double>& values, long count, float* out) {
  for (long i = 0; i < count; ++i) out[i] = static_cast<float>(values[static_cast<size_t>(i)]);
}

}  // namespace

EngineLinear::EngineLinear(const Config& c, const BaseTensors& stored)
    : EngineBase(c),
      m_poseDim(c.poseDim),
      m_controlDim(c.controlDim),
      m_tau(c.tau),
      m_order(c.baseOrder),
      m_lookahead(c.lookahead) {
  m_weight = stored.transposed("weight");
  m_whiten = stored.transposed("whiten");
  m_unwhiten = stored.transposed("unwhiten");
  m_historyWhiten = stored.transposed("history_whiten");
  m_bias = stored.numbers("bias");
  m_historyMean = stored.numbers("history_mean");
  m_logDet = stored.number("log_det");
}

void EngineLinear::foreseeRow(const float* history, const float* control, float* features,
                              RowForesight& seen) const {
  const auto d = static_cast<size_t>(m_poseDim);
  std::vector<double> centred(d);
  for (long t = 0; t < m_tau; ++t) {
    const float* frame = history + t * m_poseDim;
    for (size_t j = 0; j < d; ++j) centred[j] = frame[j] - m_historyMean[j];
    auto whitened = zerosFor(m_historyWhiten);
    m_historyWhiten.addTo(centred, whitened);
    store(whitened, m_poseDim, features + t * m_poseDim);
  }
  std::copy_n(control, (m_tau + 1 + m_lookahead) * m_controlDim, features + m_tau * m_poseDim);
  // Newest pose first, then the present and the last control.
  std::vector<double> regressors;
  for (long lag = 1; lag <= m_order; ++lag) {
    const float* frame = history + (m_tau - lag) * m_poseDim;
    regressors.insert(regressors.end(), frame, frame + m_poseDim);
  }
  for (long lag = 0; lag <= 1; ++lag) {
    const float* at = control + (m_tau - lag) * m_controlDim;
    regressors.insert(regressors.end(), at, at + m_controlDim);
  }
  seen.predicted = m_bias;
  seen.predicted.resize(static_cast<size_t>(m_weight.paddedColumns()));
  m_weight.addTo(regressors, seen.predicted);
}

void EngineLinear::toPoseRow(const RowForesight& seen, const float* innovation, float* pose) const {
  const std::vector<double> e(innovation, innovation + m_poseDim);
  auto out = seen.predicted;
  m_unwhiten.addTo(e, out);
  store(out, m_poseDim, pose);
}

double EngineLinear::toInnovationRow(const RowForesight& seen, const float* pose,
                                     float* innovation) const {
  std::vector<double> residual(static_cast<size_t>(m_poseDim));
  for (size_t j = 0; j < residual.size(); ++j) residual[j] = pose[j] - seen.predicted[j];
  auto out = zerosFor(m_whiten);
  m_whiten.addTo(residual, out);
  store(out, m_poseDim, innovation);
  return m_logDet;
}

}  // namespace marey::moglow
