// Layers of a conditional normalising flow over sequences (Kingma & Dhariwal 2018, "Glow";
// Henter et al. 2020, Sec. 3). `toLatent` maps data to latent, `toData` back.
//
// Shapes: values [B, T, D], conditioning [B, T, C], log-determinants [B, T] (of toLatent).
// Recurrent state is a value passed in and out; a default-constructed one starts at zero.
// Throws torch's c10::Error on wrong shapes; nothing here checks for NaN (the callers do).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "nn/flow/flow_spec.h"
#include "nn/torch/torch.h"

namespace marey::nn {

struct Transformed {
  torch::Tensor value;   ///< [B, T, D]
  torch::Tensor logDet;  ///< [B, T]: log |det d latent / d data|
};

/// State of one recurrent net: hidden (and cell) [layers, B, H]; undefined means zero.
struct RecurrentState {
  torch::Tensor hidden;
  torch::Tensor cell;
};
using FlowState = std::vector<RecurrentState>;  ///< one per step of flow

/// Channel-wise affine map z = (x + bias) * exp(logs).
class ActNorm : public torch::nn::Module {
 public:
  explicit ActNorm(int64_t channels);
  Transformed toLatent(const torch::Tensor& x) const;
  torch::Tensor toData(const torch::Tensor& z) const;
  /// Zero mean and unit variance of the frames [N, D] given. A channel whose standard deviation
  /// is below `constant` is only centred: blown up, it would rule every gradient.
  void initialise(const torch::Tensor& frames, double constant = 1e-3);

  torch::Tensor bias, logs;  ///< [D]
};

/// Invertible linear map z = W x, W = P (L + I) (U + diag(sign * exp(logS))), or a free W.
class InvertibleLinear : public torch::nn::Module {
 public:
  InvertibleLinear(int64_t channels, bool lu, at::Generator& generator);
  Transformed toLatent(const torch::Tensor& x) const;
  torch::Tensor toData(const torch::Tensor& z) const;
  torch::Tensor weight() const;
  /// Becomes the given matrix [D, D]. Throws NumericError when it is singular.
  void assign(const torch::Tensor& matrix);
  bool lu() const { return m_lu; }
  torch::Tensor logDet() const;

  torch::Tensor free;                                    ///< [D, D]; only without LU
  torch::Tensor permutation, lower, upper, logS, signS;  ///< only with LU

 private:
  bool m_lu;
};

/// [B, T, inputs] -> [B, T, outputs]; the last, linear layer starts at zero.
class CouplingNet : public torch::nn::Module {
 public:
  CouplingNet(int64_t inputs, int64_t outputs, CouplingNetSpec spec, at::Generator& generator);
  torch::Tensor forward(const torch::Tensor& input, RecurrentState& state) const;
  /// Per layer input, recurrent, two biases (plain layers: input and bias); the output layer's
  /// last.
  std::vector<torch::Tensor> weights() const;

 private:
  torch::Tensor hiddenOutput(const torch::Tensor& input, RecurrentState& state) const;

  CouplingNetSpec m_spec;
  std::vector<torch::Tensor> m_weights;  ///< per layer: input, recurrent, two biases
  torch::Tensor m_outWeight, m_outBias;
};

/// Affine coupling: z1 (first floor(D/2) channels) passes, z2' = (z2 + shift) * scale, with
/// shift = even, scale = sigmoid(odd + 2) + 1e-6 of the net's outputs on [z1, conditioning].
class AffineCoupling : public torch::nn::Module {
 public:
  AffineCoupling(int64_t channels, int64_t conditioning, const CouplingNetSpec& spec,
                 at::Generator& generator);
  Transformed toLatent(const torch::Tensor& x, const torch::Tensor& conditioning,
                       RecurrentState& state) const;
  torch::Tensor toData(const torch::Tensor& z, const torch::Tensor& conditioning,
                       RecurrentState& state) const;
  const CouplingNet& net() const { return *m_net; }

 private:
  struct ShiftScale {
    torch::Tensor shift, scale;
  };
  ShiftScale shiftScale(const torch::Tensor& passed, const torch::Tensor& conditioning,
                        RecurrentState& state) const;

  int64_t m_passed;
  std::shared_ptr<CouplingNet> m_net;
};

/// K steps of actnorm, invertible linear and affine coupling.
class Flow : public torch::nn::Module {
 public:
  Flow(const FlowSpec& spec, at::Generator& generator);
  Transformed toLatent(const torch::Tensor& x, const torch::Tensor& conditioning,
                       FlowState& state) const;
  torch::Tensor toData(const torch::Tensor& z, const torch::Tensor& conditioning,
                       FlowState& state) const;
  enum class Start {
    Orthogonal,  ///< random rotations, as published
    Whitening,   ///< the same, but the first step becomes PCA whitening
    Reversal,    ///< every linear layer reverses the channels
  };
  /// Data-dependent start on frames x [N, 1, D] with conditioning [N, 1, C]: every actnorm
  /// normalises what reaches it.
  void initialise(const torch::Tensor& x, const torch::Tensor& conditioning, Start start);
  const FlowSpec& spec() const { return m_spec; }
  struct Step {
    std::shared_ptr<ActNorm> actnorm;
    std::shared_ptr<InvertibleLinear> linear;
    std::shared_ptr<AffineCoupling> coupling;
  };
  const std::vector<Step>& steps() const { return m_steps; }

 private:
  FlowSpec m_spec;
  std::vector<Step> m_steps;
};

/// Base distribution of the latent, per frame. df <= 0: standard normal; else a multivariate
/// Student-t with df degrees of freedom and identity scale.
torch::Tensor baseLogDensity(const torch::Tensor& z, double df);

/// PCA whitening matrix W [D, D] of a covariance: W S W' = I; eigenvalues below `floor` times
/// the largest are raised to that.
torch::Tensor whitening(const torch::Tensor& covariance, double floor);

}  // namespace marey::nn
