// Parameters and buffers of a torch module in a tensor file. Internal (libtorch types).
#pragma once

#include <string>

#include "base/tensor_file.h"
#include "nn/torch/torch.h"

namespace marey {

/// As "weights/NAME", float32.
void storeWeights(const torch::nn::Module& module, TensorFile& file);
/// Strict: throws InputError when a tensor is missing, extra, mis-shaped or not finite.
void loadWeights(torch::nn::Module& module, const TensorFile& file, const std::string& origin);

Tensor toTensor(const torch::Tensor& values);
torch::Tensor fromTensor(const Tensor& values);

}  // namespace marey
