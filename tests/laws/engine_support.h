// Sequences that the tests of the engine score; and the truth that they compare it with, with what
// rounding may do to it.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/random.h"
#include "model/motion_model.h"
#include "moglow/family.h"

namespace marey {

struct Sequence {
  Matrix poses, controls;
};

/// All of them together, from mean poses.
inline std::vector<SequenceScore> scoresOf(const MotionModel& model,
                                           const std::vector<Sequence>& sequences) {
  std::vector<RolloutState> states;
  std::vector<ObservedSequence> observed;
  for (const Sequence& s : sequences) {
    states.push_back(model.rollout()->start(1, {}));
    observed.push_back({&s.poses, &s.controls});
  }
  return model.density()->observeMany(states, observed, [] {});
}

/// Truth is the plain path in double precision. A sum of n products in float32 is the exact one of
/// weights changed by at most n 2^-24 of themselves, in whatever order it is added up (Higham,
/// Accuracy and Stability of Numerical Algorithms, 2002, Sec. 3.1), and a standardised value is
/// that of a scale changed by 2^-23. So the truths of models that are changed by random shares of
/// that size say how far float32 may be off at each place. What one machine's order of sums does is
/// some sqrt(n) times less; four times the furthest of four draws is exceeded by an error of the
/// draws' own size once in 10^3, of half that size once in 10^5.
class Truth {
 public:
  static constexpr uint32_t kDraws = 4;
  static constexpr float kFactor = 4.f;

  /// Of a family whose network's tensors begin with `network`.
  explicit Truth(const TensorFile& file, ModelFamily family = moglow::family(),
                 const std::string& network = "weights/flow.")
      : m_family(std::move(family)), m_exact(load(file)) {
    const double inputs = widest(file, "weight_ih") + widest(file, "weight_hh");
    for (uint32_t draw = 1; draw <= kDraws; ++draw) {
      TensorFile changed = file;
      uint32_t number = 0;
      for (auto& [name, tensor] : changed.tensors) {
        const double share = name.starts_with(network) ? inputs * 0x1p-24
                             : name.starts_with("standardiser/") && name.ends_with("_std")
                                 ? 0x1p-22  // two units of the last place at most
                                 : 0.0;
        if (share == 0.0 || name.ends_with(".permutation") || name.ends_with(".sign_s")) continue;
        auto values = tensor.toFloats();
        change(values, share, draw, number++);
        tensor = Tensor::fromFloats(tensor.shape, values.data());
      }
      m_changed.push_back(load(changed));
    }
  }

  const MotionModel& exact() const { return *m_exact; }
  /// Of a draw from 1 to kDraws.
  const MotionModel& changed(uint32_t draw) const { return *m_changed[draw - 1]; }

 private:
  /// Most columns of the matrices of a name: terms of a sum.
  static double widest(const TensorFile& file, const std::string& part) {
    int64_t out = 0;
    for (const auto& [name, tensor] : file.tensors)
      if (name.find(part) != std::string::npos) out = std::max(out, tensor.shape.at(1));
    return static_cast<double>(out);
  }
  /// Adds up to `share` of every value's size.
  static void change(std::span<float> values, double share, uint32_t draw, uint32_t number) {
    for (size_t i = 0; i < values.size(); ++i) {
      const double u =
          uniformAt({.seed = 9, .sample = draw, .frame = number, .stage = RandomStage::Test},
                    static_cast<uint32_t>(i));
      values[i] = static_cast<float>(values[i] * (1.0 + (2.0 * u - 1.0) * share));
    }
  }
  std::unique_ptr<MotionModel> load(const TensorFile& file) const {
    return m_family.load(file, "truth", {.execution = Execution::Exact});
  }

  ModelFamily m_family;
  std::unique_ptr<MotionModel> m_exact;
  std::vector<std::unique_ptr<MotionModel>> m_changed;
};

/// How far each row may be from the truth's, given those of the draws, and with the rounding of
/// the result itself.
inline Eigen::VectorXf rowLimits(const Matrix& truth, const std::vector<Matrix>& draws) {
  Eigen::VectorXf out = 0x1p-23f * truth.cwiseAbs().rowwise().maxCoeff();
  Eigen::VectorXf furthest = Eigen::VectorXf::Zero(out.size());
  for (const Matrix& draw : draws)
    furthest = furthest.cwiseMax((draw - truth).cwiseAbs().rowwise().maxCoeff());
  return out + Truth::kFactor * furthest;
}

/// Scores by every draw: [draw][sequence].
inline std::vector<std::vector<SequenceScore>> scoreDrawsOf(
    const Truth& truth, const std::vector<Sequence>& sequences) {
  std::vector<std::vector<SequenceScore>> out;
  for (uint32_t draw = 1; draw <= Truth::kDraws; ++draw)
    out.push_back(scoresOf(truth.changed(draw), sequences));
  return out;
}

/// How far the log-likelihood of a frame may be from the truth's.
inline double natsLimit(const std::vector<SequenceScore>& truth,
                        const std::vector<std::vector<SequenceScore>>& draws, size_t sequence,
                        size_t frame) {
  const double nats = truth[sequence].loglikNats[frame];
  double furthest = 0.0;
  for (const auto& draw : draws)
    furthest = std::max(furthest, std::abs(draw[sequence].loglikNats[frame] - nats));
  return Truth::kFactor * furthest + 0x1p-23 * std::abs(nats);
}

}  // namespace marey
