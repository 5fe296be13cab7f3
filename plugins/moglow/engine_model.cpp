#include "moglow/engine_model.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "model/model_parts.h"
#include "moglow/engine_rollout.h"

namespace marey::moglow {
namespace {

constexpr const char* kStoredFlow = "weights/flow.";  ///< what the names of its tensors begin with

}  // namespace

EngineModel::EngineModel(ModelInfo info, const Config& config, TensorFile file,
                         std::unique_ptr<const EngineBase> base,
                         std::unique_ptr<const EngineBase> motion, nn::Precision precision,
                         const std::string& origin)
    : m_info(std::move(info)),
      m_config(config),
      m_units(unitsOf(m_info)),
      m_kept(std::move(file)),
      m_flow(config.flow(), m_kept, kStoredFlow, precision, origin),
      m_base(std::move(base)),
      m_motion(std::move(motion)) {}

EngineModel::~EngineModel() = default;

RolloutState EngineModel::start(int batch, const Matrix& history) const {
  const auto rows = static_cast<size_t>(batch);
  Rollout out{.history = nn::AlignedFloats(rows * static_cast<size_t>(historyWidth())),
              .control = nn::AlignedFloats(rows * static_cast<size_t>(controlWidth())),
              .features = nn::AlignedFloats(rows * static_cast<size_t>(featureWidth())),
              .pose = nn::AlignedFloats(m_base ? rows * static_cast<size_t>(m_config.poseDim) : 0),
              .flow = m_flow.start(batch)};
  if (history.rows() > 0) {
    requireShape("history", history, batch, historyWidth());
    standardise(history.data(), history.size(), m_units.poseMean, m_units.poseStd,
                out.history.data());
  }
  return {std::move(out)};
}

Matrix EngineModel::sampleFrame(RolloutState& state, const Matrix& controlWindow,
                                const Matrix& latent) const {
  auto& r = std::any_cast<Rollout&>(state.value);
  const long rows = r.flow.rows, d = m_config.poseDim, passed = m_config.passedChannels(),
             stride = m_flow.stride(), width = historyWidth();
  requireShape("control window", controlWindow, rows, controlWidth());
  requireShape("latent", latent, rows, d);
  standardise(controlWindow.data(), controlWindow.size(), m_units.controlMean, m_units.controlStd,
              r.control.data());
  const std::array<nn::Inputs, 2> plain{
      {{r.history.data(), width, width}, {r.control.data(), controlWidth(), controlWidth()}}};
  const nn::Inputs seen{r.features.data(), featureWidth(), featureWidth()};
  if (m_base)
    motionBase()->foresee(rows, r.history.data(), r.control.data(), r.features.data(),
                          featureWidth(), r.foreseen);
  for (long b = 0; b < rows; ++b) {
    const float* z = latent.row(b).data();
    std::copy(z + passed, z + d, r.flow.values.data() + b * stride);
    // The passed channels are the last of what the nets see.
    if (passed > 0) std::copy(z, z + passed, r.features.data() + (b + 1) * featureWidth() - passed);
  }
  m_flow.toData(r.flow, m_base ? std::span<const nn::Inputs>(&seen, 1) : plain);
  Matrix out(rows, d);
  for (long b = 0; b < rows; ++b) {
    std::copy(latent.row(b).data(), latent.row(b).data() + passed, out.row(b).data());
    std::copy(r.flow.values.data() + b * stride, r.flow.values.data() + b * stride + d - passed,
              out.row(b).data() + passed);
  }
  if (m_base) {
    motionBase()->toPose(r.foreseen, out.data(), r.pose.data());
    std::copy(r.pose.data(), r.pose.data() + rows * d, out.data());
  }
  for (long b = 0; b < rows; ++b) {
    float *history = r.history.data() + b * width, *pose = out.row(b).data();
    std::copy(history + d, history + width, history);
    std::copy(pose, pose + d, history + width - d);
    for (long j = 0; j < d; ++j)
      pose[j] = pose[j] * m_units.poseStd[static_cast<size_t>(j)] +
                m_units.poseMean[static_cast<size_t>(j)];
  }
  return out;
}

TensorFile EngineModel::save() const {
  if (m_flow.precision() != nn::Precision::Float32)
    throw InputError({.path = m_info.variant}, "weights loaded in full precision", "rounded ones");
  TensorFile file = m_kept;
  m_flow.restore(file);
  file.metadata = Json::object();
  storeCommon(m_info, file);
  return file;
}

}  // namespace marey::moglow
