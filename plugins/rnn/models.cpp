#include "rnn/models.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "model/gradient/weights.h"
#include "model/model_parts.h"

namespace marey::rnn {
namespace {

nn::StackShape shapeOf(const Config& c) {
  return {
      .cell = nn::cellNamed(c.cell), .inputs = c.inputs(), .hidden = c.hidden, .layers = c.layers};
}

nn::RecurrentNet packed(const Config& c, const TensorFile& file, nn::Precision precision) {
  const auto read = [&](const std::string& name) {
    return file.tensors.at("weights/" + name).toFloats();
  };
  nn::RecurrentNet out(shapeOf(c), c.poseDim, precision);
  for (int layer = 0; layer < c.layers; ++layer) {
    const std::string suffix = "_l" + std::to_string(layer);
    const auto input = read("weight_ih" + suffix), recurrent = read("weight_hh" + suffix),
               inputBias = read("bias_ih" + suffix), recurrentBias = read("bias_hh" + suffix);
    out.setLayer(layer, {input, recurrent, inputBias, recurrentBias});
  }
  out.setOutput(read("out_weight"), read("out_bias"));
  return out;
}

/// A value: a copy is a fork.
struct EngineState {
  nn::StackState stack;
  nn::AlignedFloats control, pose;
  nn::AlignedFloats before;  ///< [rows, D], standardised: the last poses; with feedback
};

/// The last frame [rows, D] of standardised histories.
template <typename Put>
void forLastPoses(const Matrix& history, const ModelInfo& info, const Standardiser& units,
                  const Put& put) {
  const long d = info.poseDim;
  for (long b = 0; b < history.rows(); ++b)
    for (long j = 0; j < d; ++j) {
      const auto at = static_cast<size_t>(j);
      put(b, j, (history(b, history.cols() - d + j) - units.poseMean[at]) / units.poseStd[at]);
    }
}

}  // namespace

EngineModel::EngineModel(ModelInfo info, const Config& config, TensorFile file,
                         nn::Precision precision)
    : m_info(std::move(info)),
      m_config(config),
      m_units(unitsOf(m_info)),
      m_file(std::move(file)),
      m_net(packed(config, m_file, precision)) {}

RolloutState EngineModel::start(int batch, const Matrix& history) const {
  // Without feedback poses are no input of this model: a history is taken and of no effect.
  if (history.size() > 0)
    requireShape("history", history, batch, static_cast<long>(m_info.context) * m_info.poseDim);
  const auto rows = static_cast<size_t>(batch);
  const auto seen = static_cast<size_t>(m_config.feedback ? m_config.poseDim : 0);
  EngineState out{
      .stack = m_net.start(batch),
      .control = nn::AlignedFloats(rows * static_cast<size_t>(m_config.controlInputs())),
      .pose = nn::AlignedFloats(rows * static_cast<size_t>(m_net.outputStride())),
      .before = nn::AlignedFloats(rows * seen)};
  if (m_config.feedback)
    forLastPoses(history, m_info, m_units, [&](long b, long j, float value) {
      out.before.data()[b * m_config.poseDim + j] = value;
    });
  return {std::move(out)};
}

Matrix EngineModel::sampleFrame(RolloutState& state, const Matrix& controlWindow,
                                const Matrix& latent) const {
  auto& s = std::any_cast<EngineState&>(state.value);
  const long rows = s.stack.rows, width = m_config.controlInputs(), d = m_config.poseDim;
  requireShape("control window", controlWindow, rows, width);
  requireShape("latent", latent, rows, 0);
  standardise(controlWindow.data(), controlWindow.size(), m_units.controlMean, m_units.controlStd,
              s.control.data());
  const std::array<nn::Inputs, 2> seen{{{s.control.data(), width, width}, {s.before.data(), d, d}}};
  m_net.step({seen.data(), m_config.feedback ? size_t{2} : size_t{1}}, s.stack, s.pose.data());
  Matrix out(rows, d);
  for (long b = 0; b < rows; ++b) {
    const float* pose = s.pose.data() + b * m_net.outputStride();
    if (m_config.feedback) std::copy_n(pose, d, s.before.data() + b * d);
    for (long j = 0; j < d; ++j)
      out(b, j) = pose[j] * m_units.poseStd[static_cast<size_t>(j)] +
                  m_units.poseMean[static_cast<size_t>(j)];
  }
  return out;
}

TensorFile EngineModel::save() const {
  TensorFile file = m_file;
  file.metadata = Json::object();
  storeCommon(m_info, file);
  return file;
}

namespace {

/// A value: tensors are never changed in place.
struct Rollout {
  Net::State state;
  torch::Tensor before;  ///< [B, D], standardised: the last poses; with feedback
};

}  // namespace

ReferenceModel::ReferenceModel(ModelInfo info, std::shared_ptr<Net> net, torch::ScalarType type)
    : m_info(std::move(info)), m_net(std::move(net)), m_type(type), m_units(unitsOf(m_info)) {
  m_net->eval();
  m_net->to(type);
}

RolloutState ReferenceModel::start(int batch, const Matrix& history) const {
  if (history.size() > 0)
    requireShape("history", history, batch, static_cast<long>(m_info.context) * m_info.poseDim);
  Rollout out;
  if (!m_net->config().feedback) return {out};
  out.before = torch::zeros({batch, m_info.poseDim}, m_type);
  forLastPoses(history, m_info, m_units,
               [&](long b, long j, float value) { out.before[b][j] = value; });
  return {out};
}

Matrix ReferenceModel::sampleFrame(RolloutState& state, const Matrix& controlWindow,
                                   const Matrix& latent) const {
  const c10::InferenceMode guard;
  auto& rollout = std::any_cast<Rollout&>(state.value);
  requireShape("control window", controlWindow, controlWindow.rows(),
               m_net->config().controlInputs());
  requireShape("latent", latent, controlWindow.rows(), 0);
  Matrix standard(controlWindow.rows(), controlWindow.cols());
  standardise(controlWindow.data(), controlWindow.size(), m_units.controlMean, m_units.controlStd,
              standard.data());
  auto inputs = torch::from_blob(standard.data(), {standard.rows(), 1, standard.cols()}).to(m_type);
  if (m_net->config().feedback) inputs = torch::cat({inputs, rollout.before.unsqueeze(1)}, 2);
  const auto made = m_net->poses(inputs, rollout.state).squeeze(1);
  if (m_net->config().feedback) rollout.before = made;
  const auto poses = (made * torch::tensor(m_units.poseStd).to(m_type) +
                      torch::tensor(m_units.poseMean).to(m_type))
                         .to(torch::kFloat32)
                         .contiguous();
  return Eigen::Map<const Matrix>(poses.data_ptr<float>(), poses.size(0), poses.size(1));
}

TensorFile ReferenceModel::save() const {
  if (m_type != torch::kFloat32)
    throw InputError({.path = m_info.variant}, "weights as they are stored", "doubles");
  TensorFile file;
  storeCommon(m_info, file);
  storeWeights(*m_net, file);
  return file;
}

}  // namespace marey::rnn
