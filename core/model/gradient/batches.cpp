#include "model/gradient/batches.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "base/random.h"

namespace marey {
namespace {

torch::Tensor standardised(const std::vector<FeatureSequence>& sequences,
                           Matrix FeatureSequence::*member, const std::vector<float>& mean,
                           const std::vector<float>& std) {
  int64_t rows = 0;
  for (const auto& s : sequences) rows += (s.*member).rows();
  auto out = torch::empty({rows, static_cast<int64_t>(mean.size())});
  float* to = out.data_ptr<float>();
  for (const auto& s : sequences) {
    const Matrix& m = s.*member;
    std::copy(m.data(), m.data() + m.size(), to);
    to += m.size();
  }
  return (out - torch::tensor(mean)) / torch::tensor(std);
}

std::string recordedName(const std::string& name) {
  return name.substr(0, name.find('|'));
}

}  // namespace

Batches::Batches(const std::vector<FeatureSequence>& sequences, const Standardiser& standardiser,
                 int windowFrames, int hopFrames, torch::Device device)
    : m_windows(cutWindows(sequences, windowFrames, hopFrames)), m_windowFrames(windowFrames) {
  int64_t offset = 0;
  for (const auto& s : sequences) {
    m_offsets.push_back(offset);
    m_lengths.push_back(s.frameCount());
    offset += s.frameCount();
  }
  m_pose =
      standardised(sequences, &FeatureSequence::pose, standardiser.poseMean, standardiser.poseStd)
          .to(device);
  m_control = standardised(sequences, &FeatureSequence::control, standardiser.controlMean,
                           standardiser.controlStd)
                  .to(device);
}

void Batches::hideControl(const FeatureSpec& features, double share) {
  m_hiddenShare = share;
  for (const ControlColumns& at : columnsOf(features.control, features.fps))
    if (at.presence >= 0) m_hidden.push_back({at.first, at.end() - at.first});
}

/// Zero is the mean of a control, and the presence of one that is left out.
void Batches::hide(uint64_t seed, int64_t step, TrainingBatch& batch) const {
  const int64_t windows = batch.control.size(0);
  for (size_t c = 0; c < m_hidden.size(); ++c)
    for (int64_t i = 0; i < windows; ++i) {
      const RandomKey key{.seed = seed,
                          .sample = static_cast<uint32_t>(i),
                          .frame = static_cast<uint32_t>(step),
                          .stage = RandomStage::Control};
      if (uniformAt(key, static_cast<uint32_t>(c)) < m_hiddenShare)
        batch.control.select(0, i).narrow(-1, m_hidden[c].first, m_hidden[c].width).zero_();
    }
}

void Batches::shuffleFor(uint64_t seed, int64_t epoch) {
  if (m_epoch == epoch) return;
  m_order.resize(m_windows.size());
  std::iota(m_order.begin(), m_order.end(), 0);
  const RandomKey key{
      .seed = seed, .frame = static_cast<uint32_t>(epoch), .stage = RandomStage::Shuffle};
  for (size_t i = m_order.size(); i-- > 1;) {
    const double u = uniformAt(key, static_cast<uint32_t>(i));
    std::swap(m_order[i], m_order[static_cast<size_t>(u * static_cast<double>(i + 1))]);
  }
  m_epoch = epoch;
}

TrainingBatch Batches::forStep(uint64_t seed, int64_t step, int64_t batch) {
  std::vector<int64_t> chosen;
  for (int64_t i = step * batch; i < (step + 1) * batch; ++i) {
    shuffleFor(seed, i / windowCount());
    chosen.push_back(m_order[static_cast<size_t>(i % windowCount())]);
  }
  TrainingBatch out = gather(chosen);
  hide(seed, step, out);
  return out;
}

TrainingBatch Batches::inOrder(int64_t first, int64_t count) const {
  std::vector<int64_t> chosen(static_cast<size_t>(count));
  std::iota(chosen.begin(), chosen.end(), first);
  return gather(chosen);
}

TrainingBatch Batches::gather(const std::vector<int64_t>& windows) const {
  const auto b = static_cast<int64_t>(windows.size());
  std::vector<int64_t> rows(static_cast<size_t>(b * m_windowFrames));
  std::vector<float> mask(rows.size(), 0.f);
  for (int64_t i = 0; i < b; ++i) {
    const Window& w = m_windows[static_cast<size_t>(windows[static_cast<size_t>(i)])];
    for (int64_t t = 0; t < m_windowFrames; ++t) {
      // Padding repeats the window's last frame; the mask leaves it out of the loss.
      const auto at = static_cast<size_t>(i * m_windowFrames + t);
      rows[at] =
          m_offsets[static_cast<size_t>(w.sequence)] + w.first + std::min<int64_t>(t, w.length - 1);
      mask[at] = t < w.length ? 1.f : 0.f;
    }
  }
  const auto index = torch::tensor(rows).to(m_pose.device());
  return {m_pose.index_select(0, index).view({b, m_windowFrames, -1}),
          m_control.index_select(0, index).view({b, m_windowFrames, -1}),
          torch::tensor(mask).view({b, m_windowFrames}).to(m_pose.device())};
}

TrainingFrames Batches::frames(int64_t context, int64_t lookahead) const {
  std::vector<int64_t> usable;
  for (size_t s = 0; s < m_offsets.size(); ++s)
    for (int64_t t = context; t < m_lengths[s] - lookahead; ++t) usable.push_back(m_offsets[s] + t);
  return {m_pose, m_control, torch::tensor(usable, torch::kInt64).to(m_pose.device()), {}};
}

std::pair<std::vector<FeatureSequence>, std::vector<FeatureSequence>> splitValidation(
    const std::vector<FeatureSequence>& sequences, double share) {
  std::map<std::string, size_t> recorded;
  for (const auto& s : sequences) recorded.emplace(recordedName(s.name), 0);
  const auto wanted = static_cast<size_t>(std::floor(share * static_cast<double>(recorded.size())));
  size_t index = 0;
  for (auto& [name, number] : recorded) number = index++;
  const size_t stride = wanted == 0 ? 0 : recorded.size() / wanted;
  std::pair<std::vector<FeatureSequence>, std::vector<FeatureSequence>> out;
  for (const auto& s : sequences) {
    const bool held = stride > 0 && recorded[recordedName(s.name)] % stride == stride - 1;
    if (!held) out.first.push_back(s);
    // Augmented versions are for training only: validation hears each clip once.
    if (held && s.name == recordedName(s.name)) out.second.push_back(s);
  }
  return out;
}

}  // namespace marey
