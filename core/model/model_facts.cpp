#include "base/error.h"
#include "model/motion_model.h"

namespace marey {
namespace {

std::string latentText(const LatentSpec& latent) {
  if (latent.width == 0) return "none: equal control gives equal motion";
  return fmt::format(
      "{} values {}, {}", latent.width,
      latent.per == LatentSpec::Per::Clip ? "a motion" : "a frame",
      latent.degreesOfFreedom > 0.0
          ? fmt::format("Student-t with {:g} degrees of freedom", latent.degreesOfFreedom)
          : "standard normal");
}

std::string densityText(DensityKind kind) {
  if (kind == DensityKind::Exact) return "exact";
  return kind == DensityKind::Bound ? "a lower bound" : "none";
}

std::string seenText(const ModelInfo& info) {
  if (!info.causal) return "all frames of the control";
  std::string out = fmt::format("{} past and {} future frames", info.context, info.lookahead);
  if (!info.hash.empty())
    out += fmt::format(" ({:g} s and {:g} s)", info.context / info.features.fps,
                       info.lookahead / info.features.fps);
  return out;
}

}  // namespace

std::vector<ModelFact> factsOf(const ModelInfo& info) {
  std::vector<ModelFact> out{
      {"sees", seenText(info)},
      {"causal", info.causal ? "yes" : "no: it needs all control first"},
      {"latent", latentText(info.latent)},
      {"likelihood", densityText(info.density)},
  };
  for (const SamplingOption& option : info.optionSchema)
    out.push_back({"option " + option.name, textOf(option)});
  out.insert(out.end(), info.facts.begin(), info.facts.end());
  return out;
}

}  // namespace marey
