#include "model/gradient/judge.h"

#include "model/gradient/evaluation.h"
#include "model/pose_units.h"

namespace marey {
namespace {

double meanLossOf(RunSetup& setup, const std::optional<Batches>& batches) {
  if (!batches) return std::nan("");
  return meanLoss(setup.net(), *batches, setup.training.noise, *setup.group);
}

}  // namespace

Judged judge(RunSetup& setup) {
  return {meanLossOf(setup, setup.training.valid), meanLossOf(setup, setup.training.test)};
}

double natsPerFrame(const RunSetup& setup, double loss) {
  if (!setup.objective.likelihood) return std::nan("");
  const DataSet& data = setup.data;
  return -loss +
         toShownPerFrame(data.standardiser,
                         channelsOf(data.options.features, data.skeleton.get(), data.poseDim()));
}

void addTo(Json& provenance, const RunSetup& setup, const Judged& judged) {
  const bool likelihood = setup.objective.likelihood;
  const auto add = [&](const char* which, double loss) {
    if (std::isnan(loss)) return;
    provenance[std::string(which) + (likelihood ? "_nats_per_frame" : "_loss")] =
        likelihood ? natsPerFrame(setup, loss) : loss;
  };
  add("valid", judged.valid);
  add("test", judged.test);
  if (likelihood)
    provenance["likelihood_unit"] = likelihoodUnit(setup.data.options.features);
  else
    provenance["loss_unit"] = setup.objective.unit;
}

}  // namespace marey
