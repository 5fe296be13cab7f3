// Hyper-parameters of the variational autoencoder (Henter et al. 2020, Sec. 4.3, system 'VAE'; its
// architecture is that of Greenwood et al. 2017).
#pragma once

#include <string>

#include "base/json.h"

namespace marey::vae {

struct Config {
  int poseDim = 63;
  int controlDim = 3;
  int hidden = 256;  ///< units of a layer, each way
  int layers = 2;    ///< bidirectional LSTM layers in encoder and decoder
  int latent = 2;    ///< values per clip
  /// deterministic: motion is the decoder's mean, as published; gaussian: it has noise around that,
  /// of a learnt variance per channel.
  std::string decoder = "deterministic";
  double kldWeight = 1.0;     ///< of a clip's divergence, once it has warmed up
  int kldWarmupSteps = 1000;  ///< over which that weight rises from zero

  bool gaussian() const { return decoder == "gaussian"; }
};

/// From the "model" object of a configuration, or the whole of it. Throws InputError naming the
/// key.
Config configFromJson(const Json& value, const std::string& origin);
Json toJson(const Config& config);
/// Trainable ones, in closed form.
int64_t parametersOf(const Config& config);

}  // namespace marey::vae
