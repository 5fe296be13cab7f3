#include "moglow/stored_weights.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "model/gradient/weights.h"
#include "nn/flow/flow_engine.h"

namespace marey::moglow {
namespace {

const std::string kStored = "weights/", kFlow = "flow.";

bool isFinite(const Tensor& tensor) {
  const auto values = tensor.toFloats();
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

/// Tensors of the base are named under it.
struct BaseHolder : torch::nn::Module {
  BaseHolder(const std::string& name, const std::shared_ptr<PoseBase>& base) {
    register_module(name, base);
  }
};

}  // namespace

void checkFlow(const Config& config, const TensorFile& file, const std::string& origin) {
  std::set<std::string> expected;
  for (const auto& [tensor, shape] : nn::flowTensors(config.flow())) {
    const std::string name = kFlow + tensor;
    expected.insert(kStored + name);
    if (!isFinite(file.get(kStored + name, shape, origin)))
      throw InputError({.path = origin, .item = "tensor '" + name + "'"}, "finite weights",
                       "NaN or infinity");
  }
  const auto ofBase = [&](const std::string& key) {
    return (config.based() && key.starts_with(kStored + "base.")) ||
           (config.hasMotionBase() && key.starts_with(kStored + "motion."));
  };
  for (const auto& [key, tensor] : file.tensors)
    if (key.starts_with(kStored) && !expected.contains(key) && !ofBase(key))
      throw InputError({.path = origin, .item = "tensor '" + key.substr(kStored.size()) + "'"},
                       "only tensors that the model has", "an extra one");
}

std::unique_ptr<const EngineBase> loadBase(const Config& config, const BodyFacts& body,
                                           const TensorFile& file, const std::string& name,
                                           const std::string& origin) {
  const auto plain = makePoseBase(config, body);
  if (!plain) return nullptr;
  // The plain path's names and shapes are those that have to be there.
  TensorFile own;
  for (const auto& [key, tensor] : file.tensors)
    if (key.starts_with(kStored + name + ".")) own.tensors[key] = tensor;
  BaseHolder holder(name, plain);
  loadWeights(holder, own, origin);
  return makeEngineBase(config, body, file, name);
}

}  // namespace marey::moglow
