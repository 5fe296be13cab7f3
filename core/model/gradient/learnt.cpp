#include "model/gradient/learnt.h"

#include "model/gradient/trainable.h"

namespace marey {

std::set<std::string> learntTensors(const TrainableModel& net) {
  std::set<std::string> out;
  for (const auto& item : net.named_parameters()) out.insert("weights/" + item.key());
  return out;
}

std::set<std::string> learntTensors(const ModelFamily& family, const ModelInfo& info) {
  if (!family.makeTrainee) return {};
  const TraineeData data{info.poseDim, info.controlDim, info.skeleton, info.standardiser,
                         info.features};
  return learntTensors(*family.makeTrainee(info.config, info.variant, data, 0).net);
}

}  // namespace marey
