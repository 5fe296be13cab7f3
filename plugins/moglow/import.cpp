#include <regex>

#include "pickle/state_dicts.h"
#include "pickle/torch_checkpoint.h"

#include "model/gradient/weights.h"
#include "moglow/family.h"
#include "moglow/reference_model.h"

namespace marey::moglow {
namespace {

/// The authors' names -> ours; empty for a name that is none of theirs.
std::string ourName(const std::string& theirs) {
  static const std::regex pattern(R"(flow\.layers\.(\d+)\.(actnorm|invconv|f)\.(.+))");
  static const std::map<std::string, std::string> leaves{
      {"actnorm.bias", "_actnorm.bias"},
      {"actnorm.logs", "_actnorm.logs"},
      {"invconv.weight", "_linear.weight"},
      {"invconv.p", "_linear.permutation"},
      {"invconv.l", "_linear.lower"},
      {"invconv.u", "_linear.upper"},
      {"invconv.log_s", "_linear.log_s"},
      {"invconv.sign_s", "_linear.sign_s"},
      {"f.linear.weight", "_coupling.net.out_weight"},
      {"f.linear.bias", "_coupling.net.out_bias"}};
  std::smatch match;
  if (!std::regex_match(theirs, match, pattern)) return {};
  const std::string leaf = match[2].str() + "." + match[3].str();
  std::string tail;
  if (const auto found = leaves.find(leaf); found != leaves.end()) {
    tail = found->second;
  } else if (leaf.starts_with("f.lstm.") || leaf.starts_with("f.gru.")) {
    tail = "_coupling.net." + leaf.substr(leaf.find('.', 2) + 1);
  } else {
    return {};
  }
  return "weights/flow.step" + match[1].str() + tail;
}

constexpr const char* kFirstTensor = "flow.layers.0.actnorm.bias";

/// Where the authors' name begins in a key of a state dict; see state_dicts.h.
size_t authorsNameStart(std::string_view key) {
  constexpr std::string_view layers = "flow.layers.";
  for (size_t at = key.find(layers); at != std::string_view::npos; at = key.find(layers, at + 1))
    if (at == 0 || key[at - 1] == '.') return at;
  return std::string_view::npos;
}

/// Channels from the first actnorm, control width from the first input weight.
void inferDimensions(const std::map<std::string, Tensor>& state, Config& config,
                     const std::string& origin) {
  const auto bias = state.find(kFirstTensor);
  if (bias == state.end())
    throw InputError({.path = origin},
                     std::string("a MoGlow checkpoint (tensor '") + kFirstTensor + "')",
                     "no such tensor");
  config.poseDim = static_cast<int>(bias->second.count());
  for (const char* name :
       {"flow.layers.0.f.lstm.weight_ih_l0", "flow.layers.0.f.gru.weight_ih_l0"}) {
    const auto found = state.find(name);
    if (found == state.end() || found->second.shape.size() != 2) continue;
    const int64_t controls =
        found->second.shape[1] - config.poseDim / 2 - int64_t{config.tau} * config.poseDim;
    const int frames = config.tau + 1 + config.lookahead;
    if (controls < 0 || controls % frames != 0)
      throwInput({.path = origin, .item = std::string("tensor '") + name + "'"},
                 fmt::format("inputs for {} past poses of {} values and {} control frames",
                             config.tau, config.poseDim, frames),
                 "{} inputs", found->second.shape[1]);
    config.controlDim = static_cast<int>(controls / frames);
  }
}

bool hasDimensions(const Json& json) {
  return json.contains("pose_dim");
}

}  // namespace

std::unique_ptr<MotionModel> importCheckpoint(const ImportRequest& request) {
  Config config = configFromJson(request.config, request.configOrigin);
  TorchCheckpoint file = readTorchCheckpoint(request.checkpoint, stateDictFilter(authorsNameStart));
  const std::string origin =
      request.checkpoint + (file.isSafetensors ? " (a safetensors file)" : "");
  const StateDict state =
      chooseStateDict(std::move(file), authorsNameStart, kFirstTensor, request.stateDict, origin);
  if (!hasDimensions(request.config)) inferDimensions(state.tensors, config, origin);
  TensorFile weights;
  for (const auto& [name, tensor] : state.tensors) {
    const std::string key = ourName(name);
    if (key.empty())
      throw InputError({.path = origin, .item = "tensor '" + name + "'"}, "a tensor of MoGlow",
                       "one of another model");
    Tensor plain = tensor;
    // The authors keep channels in the middle of (1, D, 1).
    if (name.find(".actnorm.") != std::string::npos) plain.shape = {tensor.count()};
    weights.tensors[key] = std::move(plain);
  }
  auto net = std::make_shared<Net>(config, BodyFacts{}, 0);
  loadWeights(*net, weights, origin);
  ModelInfo info;
  info.family = "moglow";
  info.variant = request.variant;
  info.poseDim = config.poseDim;
  info.controlDim = config.controlDim;
  info.context = config.tau;
  info.lookahead = config.lookahead;
  info.latent = {.width = config.poseDim, .degreesOfFreedom = config.degreesOfFreedom()};
  info.density = DensityKind::Exact;
  info.config = toJson(config);
  info.parameters = 0;
  for (const auto& p : net->parameters()) info.parameters += p.numel();
  info.standardiser = request.standardiser;
  info.provenance = {
      {"imported_from", request.checkpoint.substr(request.checkpoint.rfind('/') + 1)},
      {"state_dict", state.name},
      {"left_out", state.leftOut},
      {"standardiser", request.standardiser.empty() ? "none" : "refitted"}};
  return std::make_unique<ReferenceModel>(std::move(info), std::move(net));
}

}  // namespace marey::moglow
