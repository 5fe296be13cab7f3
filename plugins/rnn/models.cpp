#include "rnn/models.h"

#include "base/error.h"
#include "model/model_parts.h"
#include "model/weights.h"

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
};

}  // namespace

EngineModel::EngineModel(ModelInfo info, const Config& config, TensorFile file,
                         nn::Precision precision)
    : m_info(std::move(info)),
      m_config(config),
      m_units(unitsOf(m_info)),
      m_file(std::move(file)),
      m_net(packed(config, m_file, precision)) {}

RolloutState EngineModel::start(int batch, const Matrix& history) const {
  // Poses are no input of this model: a history is taken and of no effect.
  if (history.size() > 0)
    requireShape("history", history, batch, static_cast<long>(m_info.context) * m_info.poseDim);
  const auto rows = static_cast<size_t>(batch);
  return {EngineState{.stack = m_net.start(batch),
                      .control = nn::AlignedFloats(rows * static_cast<size_t>(m_config.inputs())),
                      .pose = nn::AlignedFloats(rows * static_cast<size_t>(m_net.outputStride()))}};
}

Matrix EngineModel::sampleFrame(RolloutState& state, const Matrix& controlWindow,
                                const Matrix& latent) const {
  auto& s = std::any_cast<EngineState&>(state.value);
  const long rows = s.stack.rows, inputs = m_config.inputs();
  requireShape("control window", controlWindow, rows, inputs);
  requireShape("latent", latent, rows, 0);
  standardise(controlWindow.data(), controlWindow.size(), m_units.controlMean, m_units.controlStd,
              s.control.data());
  const nn::Inputs seen{s.control.data(), inputs, inputs};
  m_net.step({&seen, 1}, s.stack, s.pose.data());
  Matrix out(rows, m_config.poseDim);
  for (long b = 0; b < rows; ++b)
    for (long j = 0; j < m_config.poseDim; ++j)
      out(b, j) =
          s.pose.data()[b * m_net.outputStride() + j] * m_units.poseStd[static_cast<size_t>(j)] +
          m_units.poseMean[static_cast<size_t>(j)];
  return out;
}

TensorFile EngineModel::save() const {
  TensorFile file = m_file;
  file.metadata = Json::object();
  storeCommon(m_info, file);
  return file;
}

ReferenceModel::ReferenceModel(ModelInfo info, std::shared_ptr<Net> net, torch::ScalarType type)
    : m_info(std::move(info)), m_net(std::move(net)), m_type(type), m_units(unitsOf(m_info)) {
  m_net->eval();
  m_net->to(type);
}

RolloutState ReferenceModel::start(int batch, const Matrix& history) const {
  if (history.size() > 0)
    requireShape("history", history, batch, static_cast<long>(m_info.context) * m_info.poseDim);
  return {Net::State{}};
}

Matrix ReferenceModel::sampleFrame(RolloutState& state, const Matrix& controlWindow,
                                   const Matrix& latent) const {
  const c10::InferenceMode guard;
  requireShape("control window", controlWindow, controlWindow.rows(), m_net->config().inputs());
  requireShape("latent", latent, controlWindow.rows(), 0);
  Matrix standard(controlWindow.rows(), controlWindow.cols());
  standardise(controlWindow.data(), controlWindow.size(), m_units.controlMean, m_units.controlStd,
              standard.data());
  const auto windows =
      torch::from_blob(standard.data(), {standard.rows(), 1, standard.cols()}).to(m_type);
  const auto made = m_net->poses(windows, std::any_cast<Net::State&>(state.value)).squeeze(1);
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
