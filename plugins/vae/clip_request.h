// What both paths of the model do with a request. No libtorch type appears here.
#pragma once

#include "vae/config.h"

#include "model/motion_model.h"

namespace marey::vae {

/// A deterministic decoder needs a clip's latent alone. A Gaussian one needs noise in every frame
/// besides: of each frame's values the last ones, the clip's latent being the first of its first
/// frame.
LatentSpec latentSpec(const Config& config);

/// Frames of a request. Throws InputError where its shapes do not fit.
long framesOf(const Config& config, const ClipRequest& request);

}  // namespace marey::vae
