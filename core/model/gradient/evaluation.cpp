#include "model/gradient/evaluation.h"

#include <algorithm>
#include <cmath>

#include <ATen/CPUGeneratorImpl.h>

namespace marey {
namespace {

constexpr int64_t kTogether = 16;  ///< windows
constexpr uint64_t kSeed = 22;     ///< of the observation noise

}  // namespace

double meanLoss(TrainableModel& net, const Batches& batches, const TrainingNoise& noise,
                nn::ProcessGroup& group) {
  const c10::InferenceMode guard;
  net.eval();
  double sum = 0.0, weight = 0.0;
  const auto [rank, size] = group.rank();
  for (int64_t first = rank * kTogether; first < batches.windowCount(); first += size * kTogether) {
    auto batch = batches.inOrder(first, std::min(kTogether, batches.windowCount() - first));
    auto generator = at::detail::createCPUGenerator(kSeed + static_cast<uint64_t>(first));
    batch.noise = noise.draw(batch, generator);
    const double counted = net.weight(batch);
    if (counted == 0.0) continue;
    sum += net.loss(batch).sum.item<double>();
    weight += counted;
  }
  auto both = torch::tensor({sum, weight}, torch::kFloat64);
  group.sum(both);
  weight = both[1].item<double>();
  return weight > 0.0 ? both[0].item<double>() / weight : std::nan("");
}

}  // namespace marey
