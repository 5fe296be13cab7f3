// Clusters of rows, as the kinematic base looks things up. Internal (libtorch types).
#pragma once

#include "nn/torch/torch.h"

namespace marey::moglow {

/// The centre [K, F] that is nearest to each row [N, F].
torch::Tensor nearest(const torch::Tensor& features, const torch::Tensor& centres);
/// Lloyd's k-means from a fixed random choice of rows.
torch::Tensor clusterCentres(const torch::Tensor& features, int64_t count);

}  // namespace marey::moglow
