// From stored tensors to the flow engine's packed ones, and back.
#include <cmath>

#include <Eigen/Dense>

#include "base/error.h"
#include "nn/flow/flow_engine.h"

namespace marey::nn {
namespace {

using Shape = std::vector<int64_t>;
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::string stepName(long index) {
  return "step" + std::to_string(index) + "_";
}

std::string layerName(const char* tensor, long layer) {
  return std::string("coupling.net.") + tensor + "_l" + std::to_string(layer);
}

/// Takes a tensor out of the file.
std::vector<float> taken(TensorFile& file, const std::string& name) {
  const auto found = file.tensors.find(name);
  auto out = found->second.toFloats();
  file.tensors.erase(found);
  return out;
}

std::vector<float> read(const TensorFile& file, const std::string& name) {
  return file.tensors.at(name).toFloats();
}

Square squareOf(const TensorFile& file, const std::string& name, long size) {
  const auto values = file.tensors.at(name).toDoubles();
  return Eigen::Map<const Square>(values.data(), size, size);
}

Eigen::VectorXd vectorOf(const TensorFile& file, const std::string& name) {
  const auto values = file.tensors.at(name).toDoubles();
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<long>(values.size()));
}

/// Matrix of an invertible linear layer: P (L + I) (U + diag(sign * exp(logS))), or as it is.
Square linearOf(const TensorFile& file, const std::string& step, long size, bool lu) {
  if (!lu) return squareOf(file, step + "linear.weight", size);
  Square lower = squareOf(file, step + "linear.lower", size),
         upper = squareOf(file, step + "linear.upper", size);
  const Eigen::VectorXd diagonal = vectorOf(file, step + "linear.sign_s").array() *
                                   vectorOf(file, step + "linear.log_s").array().exp();
  lower = lower.triangularView<Eigen::StrictlyLower>();
  upper = upper.triangularView<Eigen::StrictlyUpper>();
  return squareOf(file, step + "linear.permutation", size) *
         (lower + Square::Identity(size, size)) * (upper + Square(diagonal.asDiagonal()));
}

/// y = matrix x + start.
void pack(const Square& matrix, const Eigen::VectorXd& start, PackedMatrix& packed,
          AlignedFloats& packedStart) {
  packed = PackedMatrix(matrix.cols(), matrix.rows(), Precision::Float32);
  packedStart = AlignedFloats(static_cast<size_t>(packed.panels() * kPanel));
  for (long row = 0; row < matrix.rows(); ++row) {
    const Eigen::RowVectorXf weights = matrix.row(row).cast<float>();
    packed.set(row, 0, {weights.data(), static_cast<size_t>(weights.size())});
    packedStart.data()[row] = static_cast<float>(start(row));
  }
}

/// Column of an output of the coupling net: pairs of shift and scale, in blocks of 16 each.
long outputColumn(long output) {
  const long channel = output / 2;
  return channel / kLanes * kPanel + output % 2 * kLanes + channel % kLanes;
}

long roundedUp(long value, long to) {
  return (value + to - 1) / to * to;
}

}  // namespace

std::vector<std::pair<std::string, Shape>> flowTensors(const FlowSpec& spec) {
  const int64_t d = spec.channels, h = spec.net.hidden, gates = gatesOf(cellNamed(spec.net.cell));
  std::vector<std::pair<std::string, Shape>> out;
  for (long k = 0; k < spec.steps; ++k) {
    const auto add = [&](const std::string& name, Shape shape) {
      out.emplace_back(stepName(k) + name, std::move(shape));
    };
    add("actnorm.bias", {d});
    add("actnorm.logs", {d});
    if (spec.lu) {
      for (const char* square : {"permutation", "lower", "upper"})
        add(std::string("linear.") + square, {d, d});
      for (const char* vector : {"log_s", "sign_s"}) add(std::string("linear.") + vector, {d});
    } else {
      add("linear.weight", {d, d});
    }
    for (int64_t layer = 0; layer < spec.net.layers; ++layer) {
      add(layerName("weight_ih", layer), {gates * h, layer == 0 ? d / 2 + spec.conditioning : h});
      add(layerName("bias_ih", layer), {gates * h});
      if (spec.net.cell == "feedforward") continue;
      add(layerName("weight_hh", layer), {gates * h, h});
      add(layerName("bias_hh", layer), {gates * h});
    }
    add("coupling.net.out_weight", {2 * (d - d / 2), h});
    add("coupling.net.out_bias", {2 * (d - d / 2)});
  }
  return out;
}

StackShape FlowEngine::stackShape() const {
  return {.cell = cellNamed(m_spec.net.cell),
          .inputs = passed() + m_spec.conditioning,
          .hidden = m_spec.net.hidden,
          .layers = m_spec.net.layers};
}

FlowEngine::FlowEngine(const FlowSpec& spec, TensorFile& file, const std::string& prefix,
                       Precision precision, const std::string& origin)
    : m_spec(spec),
      m_prefix(prefix),
      m_precision(precision),
      m_channels(spec.channels),
      // Room for whole panels, and for whole blocks of the channels that are transformed.
      m_stride(roundedUp(std::max(roundedUp(m_channels, kPanel),
                                  passed() + roundedUp(m_channels - passed(), kLanes)),
                         kLanes)) {
  for (long k = 0; k < spec.steps; ++k) m_steps.push_back(packed(k, file, origin));
}

void FlowEngine::packMixing(Step& step, const std::string& prefix, const TensorFile& file,
                            const std::string& origin) const {
  const Square linear = linearOf(file, prefix, m_channels, m_spec.lu);
  const Eigen::FullPivLU<Square> lu(linear);
  if (!lu.isInvertible())
    throw InputError({.path = origin, .item = "tensor '" + prefix + "linear'"},
                     "an invertible matrix", "a singular one");
  const Eigen::VectorXd bias = vectorOf(file, prefix + "actnorm.bias"),
                        logs = vectorOf(file, prefix + "actnorm.logs");
  const Square toLatent = linear * logs.array().exp().matrix().asDiagonal();
  const Square toData = (-logs).array().exp().matrix().asDiagonal() * lu.inverse();
  pack(toLatent, toLatent * bias, step.toLatent, step.toLatentStart);
  pack(toData, -bias, step.toData, step.toDataStart);
  step.logDet = logs.sum() + lu.matrixLU().diagonal().array().abs().log().sum();
}

FlowEngine::Step FlowEngine::packed(long index, TensorFile& file, const std::string& origin) const {
  const std::string prefix = m_prefix + stepName(index);
  Step out{.stack = RecurrentStack(stackShape(), m_precision),
           .output = PackedMatrix(m_spec.net.hidden, blocks() * kPanel, m_precision),
           .outputBias = AlignedFloats(static_cast<size_t>(blocks() * kPanel))};
  const bool recurrent = m_spec.net.cell != "feedforward";
  for (long layer = 0; layer < m_spec.net.layers; ++layer) {
    const auto name = [&](const char* tensor) { return prefix + layerName(tensor, layer); };
    const auto input = taken(file, name("weight_ih")), inputBias = read(file, name("bias_ih"));
    std::vector<float> recurrentWeights, recurrentBias;
    if (recurrent) {
      recurrentWeights = taken(file, name("weight_hh"));
      recurrentBias = read(file, name("bias_hh"));
    }
    out.stack.setLayer(layer, {input, recurrentWeights, inputBias, recurrentBias});
  }
  const auto weights = taken(file, prefix + "coupling.net.out_weight"),
             bias = read(file, prefix + "coupling.net.out_bias");
  const auto hidden = static_cast<size_t>(m_spec.net.hidden);
  for (size_t row = 0; row < bias.size(); ++row) {
    const long column = outputColumn(static_cast<long>(row));
    out.output.set(column, 0, std::span(weights).subspan(row * hidden, hidden));
    out.outputBias.data()[column] = bias[row];
  }
  packMixing(out, prefix, file, origin);
  return out;
}

void FlowEngine::restore(TensorFile& file) const {
  const long gates = gatesOf(cellNamed(m_spec.net.cell)), h = m_spec.net.hidden;
  for (size_t k = 0; k < m_steps.size(); ++k) {
    const std::string prefix = m_prefix + stepName(static_cast<long>(k));
    const Step& step = m_steps[k];
    for (long layer = 0; layer < m_spec.net.layers; ++layer) {
      const auto put = [&](const char* tensor, const std::vector<float>& values) {
        const auto width = static_cast<int64_t>(values.size()) / (gates * h);
        file.tensors[prefix + layerName(tensor, layer)] =
            Tensor::fromFloats({gates * h, width}, values.data());
      };
      put("weight_ih", step.stack.inputWeights(layer));
      if (m_spec.net.cell != "feedforward") put("weight_hh", step.stack.recurrentWeights(layer));
    }
    const long outputs = 2 * (m_channels - passed());
    std::vector<float> weights(static_cast<size_t>(outputs * h));
    for (long row = 0; row < outputs; ++row)
      step.output.get(
          outputColumn(row), 0,
          std::span(weights).subspan(static_cast<size_t>(row * h), static_cast<size_t>(h)));
    file.tensors[prefix + "coupling.net.out_weight"] =
        Tensor::fromFloats({outputs, h}, weights.data());
  }
}

size_t FlowEngine::bytes() const {
  size_t out = 0;
  for (const Step& step : m_steps)
    out += step.stack.bytes() + step.output.bytes() + step.toData.bytes() + step.toLatent.bytes();
  return out;
}

}  // namespace marey::nn
