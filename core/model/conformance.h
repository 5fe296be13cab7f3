// Comparison with vectors that the authors' published implementation computed.
#pragma once

#include <string>

#include "model/motion_model.h"

namespace marey {

struct ConformanceErrors {
  double latent = 0.0, loglik = 0.0, sample = 0.0;  ///< largest absolute differences
  int frames = 0;
};

/// `vectors`: an .npz with x, control (B, context + T, .), z (B, T, D), loglik_nats (B, T), and
/// x_sampled from latents z_in from the mean pose (zeros), all in standardised space.
/// Throws InputError when arrays are missing or do not fit the model.
ConformanceErrors checkConformance(const MotionModel& model, const std::string& vectors);

/// Mean and population standard deviation of the authors' `clips` array (N, T, 63 + 3) after
/// their augmentation: mirrored (their rule leaves x of joints 0 and 9-12 as it is) and
/// time-reversed clips are appended, as they do before fitting.
/// Throws InputError when the array is missing or has another width.
Standardiser standardiserFromArchive(const std::string& npz);

}  // namespace marey
