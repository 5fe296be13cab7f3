// How good a net in training is, on clips that it does not see. Internal (libtorch types).
#pragma once

#include <cmath>

#include "model/gradient/run_setup.h"

namespace marey {

/// Mean losses in the objective's unit; NaN where there are no such clips.
struct Judged {
  double valid = std::nan(""), test = std::nan("");
};

/// Of the net as it is. Every process calls it.
Judged judge(RunSetup& setup);
/// A loss in nats per frame of standardised poses in likelihoodUnit; NaN where the objective is no
/// likelihood.
double natsPerFrame(const RunSetup& setup, double loss);
/// What a stored model says of it.
void addTo(Json& provenance, const RunSetup& setup, const Judged& judged);

}  // namespace marey
