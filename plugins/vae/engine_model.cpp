#include "vae/engine_model.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <utility>

#include "vae/clip_request.h"

#include "base/error.h"
#include "model/model_parts.h"
#include "nn/engine/team.h"

namespace marey::vae {
namespace {

/// Rows of a product that a thread takes at once.
constexpr long kRowsTogether = 96;
/// Frames of the motions that are made together: bounds the memory, and is enough for products at
/// full speed.
constexpr long kFramesTogether = 16384;

std::vector<float> weightsNamed(const TensorFile& file, const std::string& name) {
  return file.tensors.at("weights/" + name).toFloats();
}

}  // namespace

/// Some of the requests, in order of falling length.
struct EngineModel::Group {
  std::span<const ClipRequest> requests;
  std::span<const size_t> chosen;
  nn::FrameRows frames;

  const ClipRequest& request(long sequence) const {
    return requests[chosen[static_cast<size_t>(sequence)]];
  }
  /// Calls work(row, sequence, frame) for every row of `frames`.
  template <typename Work>
  void forRows(const Work& work) const {
    for (long t = 0; t < frames.frames(); ++t) {
      const long first = frames.first[static_cast<size_t>(t)],
                 last = frames.first[static_cast<size_t>(t) + 1];
      for (long row = first; row < last; ++row) work(row, row - first, t);
    }
  }
};

EngineModel::EngineModel(ModelInfo info, const Config& config, TensorFile file,
                         nn::Precision precision)
    : m_info(std::move(info)),
      m_config(config),
      m_units(unitsOf(m_info)),
      m_kept(std::move(file)),
      m_decoder({.cell = nn::Cell::Lstm,
                 .inputs = inputs(),
                 .hidden = config.hidden,
                 .layers = config.layers},
                precision),
      m_output(m_decoder.outputs(), config.poseDim, precision),
      m_outputBias(static_cast<size_t>(m_output.panels() * nn::kPanel)) {
  for (long layer = 0; layer < config.layers; ++layer)
    for (const auto& [name, way] :
         {std::pair{"ahead", nn::Way::Ahead}, std::pair{"back", nn::Way::Back}}) {
      const std::string start = fmt::format("decoder.layer{}_{}_", layer, name);
      const auto ih = weightsNamed(m_kept, start + "weight_ih"),
                 hh = weightsNamed(m_kept, start + "weight_hh"),
                 ihBias = weightsNamed(m_kept, start + "bias_ih"),
                 hhBias = weightsNamed(m_kept, start + "bias_hh");
      m_decoder.setLayer(layer, way, {ih, hh, ihBias, hhBias});
    }
  const auto weight = weightsNamed(m_kept, "pose_weight"), bias = weightsNamed(m_kept, "pose_bias");
  const auto width = static_cast<size_t>(m_output.inputs());
  for (long j = 0; j < config.poseDim; ++j)
    m_output.set(j, 0, std::span(weight).subspan(static_cast<size_t>(j) * width, width));
  std::copy(bias.begin(), bias.end(), m_outputBias.data());
  if (!config.gaussian()) return;
  for (const float logVariance : weightsNamed(m_kept, "log_variance"))
    m_noise.push_back(std::exp(0.5f * logVariance));
}

void EngineModel::writeInputs(const Group& group, nn::AlignedFloats& out) const {
  const long controls = m_config.controlDim, width = inputs();
  group.forRows([&](long row, long sequence, long t) {
    const ClipRequest& request = group.request(sequence);
    float* to = out.data() + row * width;
    standardise(request.controls.row(t).data(), controls, m_units.controlMean, m_units.controlStd,
                to);
    std::copy_n(request.latents.data(), m_config.latent, to + controls);
  });
}

void EngineModel::toPoses(const Group& group, const nn::Inputs& hidden,
                          const std::function<void()>& between, std::vector<Matrix>& out) const {
  between();
  const long rows = group.frames.rows(), stride = m_output.panels() * nn::kPanel;
  nn::AlignedFloats values(static_cast<size_t>(rows * stride));
  std::atomic<long> next = 0;
  nn::runTeam(nn::teamThreads(), [&](nn::Team) {
    for (long row; (row = next.fetch_add(kRowsTogether)) < rows;) {
      const nn::Inputs own{hidden.values + row * hidden.stride, hidden.stride, hidden.count};
      m_output.multiply({.inputs = {&own, 1},
                         .end = m_output.panels(),
                         .start = m_outputBias.data(),
                         .out = values.data() + row * stride,
                         .outStride = stride,
                         .rows = std::min(kRowsTogether, rows - row)});
    }
  });
  group.forRows([&](long row, long sequence, long t) {
    const ClipRequest& request = group.request(sequence);
    Matrix& poses = out[group.chosen[static_cast<size_t>(sequence)]];
    const float* from = values.data() + row * stride;
    for (long j = 0; j < m_config.poseDim; ++j) {
      const auto at = static_cast<size_t>(j);
      const float noise =
          m_noise.empty() ? 0.f : m_noise[at] * request.latents(t, m_config.latent + j);
      poses(t, j) = (from[j] + noise) * m_units.poseStd[at] + m_units.poseMean[at];
    }
  });
}

std::vector<Matrix> EngineModel::generate(std::span<const ClipRequest> requests,
                                          const std::function<void()>& between) const {
  std::vector<Matrix> out;
  for (const ClipRequest& request : requests)
    out.emplace_back(framesOf(m_config, request), m_config.poseDim);
  std::vector<size_t> order(requests.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return out[a].rows() > out[b].rows(); });
  nn::BidirectionalStack::Work work;
  for (size_t first = 0; first < order.size();) {
    std::vector<long> lengths;
    long rows = 0;
    for (size_t i = first; i < order.size(); ++i) {
      rows += out[order[i]].rows();
      if (i > first && rows > kFramesTogether) break;
      lengths.push_back(out[order[i]].rows());
    }
    const Group group{requests, std::span(order).subspan(first, lengths.size()),
                      nn::FrameRows::of(lengths)};
    nn::AlignedFloats values(static_cast<size_t>(group.frames.rows() * inputs()));
    writeInputs(group, values);
    const nn::Inputs seen{values.data(), inputs(), inputs()};
    toPoses(group, m_decoder.forward(group.frames, seen, work, between), between, out);
    first += lengths.size();
  }
  return out;
}

TensorFile EngineModel::save() const {
  TensorFile file = m_kept;
  file.metadata = Json::object();
  storeCommon(m_info, file);
  return file;
}

}  // namespace marey::vae
