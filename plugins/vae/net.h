// A conditional variational autoencoder over whole clips (Kingma and Welling 2014; Greenwood et al.
// 2017; system 'VAE' of Henter et al. 2020, Sec. 4.3) as it is trained. Values are standardised.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vae/config.h"

#include "model/gradient/trainable.h"

namespace marey::vae {

/// LSTM layers that go through a sequence both ways; each sees both ways of the one below it.
class BidirectionalLstm : public torch::nn::Module {
 public:
  BidirectionalLstm(int64_t inputs, int64_t hidden, int64_t layers, at::Generator& generator);
  /// [B, T, inputs] -> [B, T, 2 * hidden], what goes ahead first. `reversed` [B, T, 1] from
  /// reversedFrames: frames that are padding have no effect on those that are real.
  torch::Tensor forward(const torch::Tensor& input, const torch::Tensor& reversed) const;

 private:
  struct Layer {
    std::vector<torch::Tensor> ahead, back;  ///< input, recurrent, two biases
  };
  int64_t m_hidden;
  std::vector<Layer> m_layers;
};

/// [B, T, 1], int64: the frame that comes in each one's place when the real frames of a row, which
/// are its first, are reversed. Its own inverse.
torch::Tensor reversedFrames(const torch::Tensor& mask);

/// What an encoder says of a clip: a normal distribution of its latent, [B, latent] each.
struct Posterior {
  torch::Tensor mean, logVariance;
};
/// Kullback-Leibler divergence from the standard normal, nats per clip [B].
torch::Tensor divergence(const Posterior& posterior);

class Net : public TrainableModel {
 public:
  Net(const Config& config, uint64_t seed);

  Objective objective() const override;
  int64_t context() const override { return 0; }
  int64_t lookahead() const override { return 0; }
  /// [B, latent], standard normal: where in its posterior each clip's latent lies.
  torch::Tensor draw(const TrainingBatch& batch, at::Generator& generator) const override;
  /// Sum over real frames of the reconstruction's error, and over windows of their divergence times
  /// its weight at the batch's step. Without draws the latent is the posterior's mean and the
  /// weight the full one: figures of checkpoints compare with each other.
  Loss loss(const TrainingBatch& batch) override;

  /// Of poses [B, T, D] with controls [B, T, C], real where mask [B, T] is 1.
  Posterior encode(const torch::Tensor& pose, const torch::Tensor& control,
                   const torch::Tensor& mask) const;
  /// Mean poses [B, T, D] given latents [B, latent].
  torch::Tensor decode(const torch::Tensor& latent, const torch::Tensor& control,
                       const torch::Tensor& mask) const;
  /// Standard deviation [D] of the noise around them; undefined for a deterministic decoder.
  torch::Tensor noise() const;
  const Config& config() const { return m_config; }

 private:
  torch::Tensor errorPerFrame(const torch::Tensor& pose, const torch::Tensor& mean) const;
  double kldWeight(const TrainingBatch& batch) const;

  Config m_config;
  std::shared_ptr<BidirectionalLstm> m_encoder, m_decoder;
  torch::Tensor m_latentWeight, m_latentBias, m_poseWeight, m_poseBias;
  torch::Tensor m_logVariance;  ///< [D], of a Gaussian decoder
};

}  // namespace marey::vae
