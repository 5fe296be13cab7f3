#include "model/gradient/training_state.h"

#include <cmath>

#include "base/format_version.h"
#include "model/gradient/weights.h"

namespace marey {
namespace {

constexpr int kStateVersion = 1;

void restore(torch::Tensor& target, const TensorFile& file, const std::string& key,
             const std::string& origin) {
  target.copy_(fromTensor(file.get(key, target.sizes().vec(), origin)));
}

/// Options that are newer than a run have their defaults in it.
Json storedIdentity(const Json& identity, const std::string& key, const std::string& origin) {
  if (!identity.contains(key)) return {};
  return key == "training" ? identityOf(trainingConfigFromJson(identity[key], origin))
                           : identity[key];
}

}  // namespace

void saveState(const std::filesystem::path& path, const TrainingState& state,
               const torch::nn::Module& net, const Optimiser& optimiser, const Json& identity) {
  TensorFile file;
  file.metadata = {{"kind", "training-state"},      {"version", kStateVersion},
                   {"identity", identity},          {"step", state.step},
                   {"updates", state.updates},      {"seconds", state.seconds},
                   {"non_finite", state.nonFinite}, {"snapshots", state.snapshots}};
  if (std::isfinite(state.bestValid)) file.metadata["best_valid"] = state.bestValid;
  storeWeights(net, file);
  const auto& moments = optimiser.momentNames();
  for (const auto& [name, slot] : optimiser.slots)
    for (size_t i = 0; i < moments.size(); ++i)
      file.tensors[moments[i] + "/" + name] = toTensor(slot.moments[i]);
  for (const auto& [name, value] : state.average) file.tensors["average/" + name] = toTensor(value);
  writeTensorFile(path, file);
}

TrainingState loadState(const std::filesystem::path& path, torch::nn::Module& net,
                        Optimiser& optimiser, const Json& identity) {
  const torch::NoGradGuard guard;
  const std::string origin = path.string();
  const TensorFile file = readTensorFile(path);
  JsonReader reader(file.metadata, origin);
  readFormatVersion(reader, kStateVersion);
  for (const auto& [key, value] : identity.items()) {
    const Json stored = storedIdentity(reader.raw("identity"), key, origin);
    if (stored != value)
      throw InputError({.path = origin, .item = key}, "the run that is resumed: " + value.dump(),
                       stored.is_null() ? "none" : stored.dump());
  }
  TrainingState out;
  out.step = reader.required<int64_t>("step");
  out.updates = reader.required<int64_t>("updates");
  out.seconds = reader.required<double>("seconds");
  out.nonFinite = reader.required<int>("non_finite");
  out.snapshots = reader.required<int64_t>("snapshots");
  out.bestValid = reader.optional("best_valid", out.bestValid);
  loadWeights(net, file, origin);
  const auto& moments = optimiser.momentNames();
  for (auto& [name, slot] : optimiser.slots) {
    for (size_t i = 0; i < moments.size(); ++i)
      restore(slot.moments[i], file, moments[i] + "/" + name, origin);
    if (!file.tensors.contains("average/" + name)) continue;
    out.average[name] = torch::zeros_like(slot.parameter);
    restore(out.average[name], file, "average/" + name, origin);
  }
  return out;
}

void addToAverage(const torch::nn::Module& net, double decay, TrainingState& state) {
  const torch::NoGradGuard guard;
  // A short memory at first, so that the random start is forgotten.
  const auto updates = static_cast<double>(state.updates);
  const double kept = std::min(decay, (1.0 + updates) / (10.0 + updates));
  if (!state.average.empty())
    for (const auto& item : net.named_parameters())
      state.average[item.key()].lerp_(item.value(), 1.0 - kept);
}

AveragedWeights::AveragedWeights(torch::nn::Module& net, const TrainingState& state) : m_net(net) {
  const torch::NoGradGuard guard;
  if (state.average.empty()) return;
  for (auto& item : m_net.named_parameters()) {
    m_own[item.key()] = item.value().clone();
    item.value().copy_(state.average.at(item.key()));
  }
}

AveragedWeights::~AveragedWeights() {
  const torch::NoGradGuard guard;
  for (auto& item : m_net.named_parameters())
    if (const auto own = m_own.find(item.key()); own != m_own.end())
      item.value().copy_(own->second);
}

}  // namespace marey
