// A variational autoencoder over whole clips as a family of motion models (Greenwood et al. 2017;
// system 'VAE' of Henter et al. 2020, Sec. 4.3).
#pragma once

#include "model/model_family.h"

namespace marey::vae {

ModelFamily family();

}  // namespace marey::vae
