// The numbers by which the kinematic base sees the past: those of its regressions, of feet and of
// regimes. Internal (libtorch types).
#pragma once

#include "moglow/kinematic_body.h"

namespace marey::moglow {

/// The last pose, the movements before it and the control, [N, D * order + 3 * order].
torch::Tensor regressors(const KinematicBody& body, const Past& past);
/// Those, and squeezed speeds of feet and toes behind them.
torch::Tensor richRegressors(const KinematicBody& body, const Past& past);
/// [N, kFootFeatures]; `slow`, cm: what counts as slow for a foot in a frame.
torch::Tensor footFeatures(const KinematicBody& body, const Past& past, size_t foot,
                           const torch::Tensor& slow);
/// Lengths that a foot's radial quantiles are relative to, [N, feet] cm: small for a slow foot.
torch::Tensor footScales(const KinematicBody& body, const Past& past);
torch::Tensor regimeFeatures(const KinematicBody& body, const Past& past);
int64_t regimeFeatureCount(const KinematicBody& body);

}  // namespace marey::moglow
