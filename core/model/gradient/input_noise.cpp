#include "model/gradient/input_noise.h"

#include "base/error.h"
#include "model/gradient/schedules.h"

namespace marey {
namespace {

torch::Tensor disturbed(const TrainingConfig& config, const torch::Tensor& values,
                        at::Generator& generator) {
  torch::Tensor out = values;
  if (config.inputNoise > 0.0)
    out = out + config.inputNoise *
                    torch::randn(values.sizes(), generator, torch::kFloat32).to(values.device());
  // The mean of standardised values is zero.
  if (config.inputDropout > 0.0)
    out = out * torch::rand(values.sizes(), generator).ge(config.inputDropout).to(values.options());
  return out;
}

}  // namespace

void disturbInputs(const TrainingConfig& config, at::Generator& generator, TrainingBatch& batch) {
  if (config.inputNoise > 0.0 || config.inputDropout > 0.0) {
    batch.seen = disturbed(config, batch.pose, generator);
    batch.control = disturbed(config, batch.control, generator);
  }
  if (config.scheduledSampling.none()) return;
  const double share = ownOutputShareAt(config.scheduledSampling, batch.step);
  batch.own = torch::rand(batch.mask.sizes(), generator).lt(share).to(batch.mask.options());
}

void requireSuitedInputs(const TrainingConfig& config, const TrainableModel& net,
                         const std::string& origin) {
  if (!config.scheduledSampling.none() && !net.seesOwnPoses())
    throw InputError({.path = origin, .item = "key 'training.scheduled_sampling'"},
                     "a model that is trained on its own past poses", "one that is not");
}

}  // namespace marey
