#include "model/gradient/weights.h"

#include <set>

#include "base/error.h"

namespace marey {
namespace {

const std::string kPrefix = "weights/";

/// Every stored tensor of a module by name.
std::vector<std::pair<std::string, torch::Tensor>> storedTensors(const torch::nn::Module& module) {
  std::vector<std::pair<std::string, torch::Tensor>> out;
  for (const auto& item : module.named_parameters()) out.emplace_back(item.key(), item.value());
  for (const auto& item : module.named_buffers()) out.emplace_back(item.key(), item.value());
  return out;
}

}  // namespace

Tensor toTensor(const torch::Tensor& values) {
  const auto plain = values.detach().to(torch::kCPU).contiguous();
  const auto shape = plain.sizes().vec();
  if (plain.scalar_type() == torch::kFloat64)
    return Tensor::fromDoubles(shape, plain.data_ptr<double>());
  if (plain.scalar_type() == torch::kInt64)
    return Tensor::fromInt64(shape, plain.data_ptr<int64_t>());
  const auto floats = plain.to(torch::kFloat32);
  return Tensor::fromFloats(shape, floats.data_ptr<float>());
}

torch::Tensor fromTensor(const Tensor& values) {
  if (values.dtype == DType::F64) {
    auto doubles = values.toDoubles();
    return torch::from_blob(doubles.data(), values.shape, torch::kFloat64).clone();
  }
  auto floats = values.toFloats();
  return torch::from_blob(floats.data(), values.shape, torch::kFloat32).clone();
}

void storeWeights(const torch::nn::Module& module, TensorFile& file) {
  for (const auto& [name, value] : storedTensors(module))
    file.tensors[kPrefix + name] = toTensor(value);
}

void loadWeights(torch::nn::Module& module, const TensorFile& file, const std::string& origin) {
  const torch::NoGradGuard guard;
  std::set<std::string> expected;
  for (auto& [name, target] : storedTensors(module)) {
    expected.insert(kPrefix + name);
    const auto value = fromTensor(file.get(kPrefix + name, target.sizes().vec(), origin));
    if (!value.isfinite().all().item<bool>())
      throw InputError({.path = origin, .item = "tensor '" + name + "'"}, "finite weights",
                       "NaN or infinity");
    target.copy_(value);
  }
  for (const auto& [key, tensor] : file.tensors)
    if (key.starts_with(kPrefix) && !expected.contains(key))
      throw InputError({.path = origin, .item = "tensor '" + key.substr(kPrefix.size()) + "'"},
                       "only tensors that the model has", "an extra one");
}

}  // namespace marey
