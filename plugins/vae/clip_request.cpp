#include "vae/clip_request.h"

#include "base/error.h"
#include "model/model_parts.h"

namespace marey::vae {

LatentSpec latentSpec(const Config& config) {
  if (config.gaussian())
    return {.width = config.latent + config.poseDim, .per = LatentSpec::Per::Frame};
  return {.width = config.latent, .per = LatentSpec::Per::Clip};
}

long framesOf(const Config& config, const ClipRequest& request) {
  const long frames = request.controls.rows();
  if (frames == 0) throw InputError({.path = "controls"}, "at least one frame", "none");
  requireShape("controls", request.controls, frames, config.controlDim);
  const LatentSpec spec = latentSpec(config);
  requireShape("latents", request.latents, spec.per == LatentSpec::Per::Clip ? 1 : frames,
               spec.width);
  if (request.history.size() > 0)
    throwInput({.path = "history"}, "none: this model sees no past poses", "{} frames",
               request.history.rows());
  return frames;
}

}  // namespace marey::vae
