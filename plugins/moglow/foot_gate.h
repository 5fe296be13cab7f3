// The gate of a foot: a change of variables between where a foot goes in one frame, seen in the
// plane across its bone, and two values that are standard normal.
//
// A planted foot stays to a fraction of a millimetre in most frames and leaves in a few, towards
// where the rest of the body says. No Gaussian can say both. The gate is radial: a distance from
// the centre becomes the quantile of a chi distribution with 2 degrees of freedom, so that any
// spread of distances is exact; and its circles are shifted as they grow, o = s (e + k), so that
// large distances prefer the direction k. Both are invertible in closed form:
//
//   s = (-o.k + sqrt((o.k)^2 + (1 - k.k) o.o)) / (1 - k.k),   |dz/do| = rho rho'(s) / (s (1 +
//   e.k)).
#pragma once

#include "moglow/base_constants.h"
#include "nn/torch/torch.h"

namespace marey::moglow {

/// The gates of N places.
struct Gate {
  torch::Tensor radii;  ///< [N, kGateKnots], cm, increasing
  torch::Tensor shift;  ///< [N, 2]: k above, shorter than 1
};

struct Gated {
  torch::Tensor value;   ///< [N, 2]
  torch::Tensor logDet;  ///< [N]
};

/// Offsets from the gate's centre [N, 2] in cm -> normal values, and back.
Gated throughGate(const Gate& gate, const torch::Tensor& offset);
torch::Tensor backThroughGate(const Gate& gate, const torch::Tensor& value);

/// s above of radial values rho [N], for radii [N, kGateKnots].
torch::Tensor gateRadius(const torch::Tensor& radii, const torch::Tensor& rho);

/// s above of offsets [N, 2] for shifts [N, 2]: their distance from the centre.
torch::Tensor gateDistance(const torch::Tensor& offset, const torch::Tensor& shift);

/// The quantiles of distances [N] at all knots but the last, which lies at `far` or twice as far
/// as the one before: what no frame of the data did is improbable, not impossible. Steps are at
/// least `floor`.
torch::Tensor gateQuantiles(const torch::Tensor& distances, double floor, double far = 0.0);

}  // namespace marey::moglow
