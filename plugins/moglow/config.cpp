#include "moglow/config.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace marey::moglow {
namespace {

template <size_t N>
void checkOneOf(const JsonReader& reader, const std::string& key, const std::string& value,
                const std::array<std::string_view, N>& allowed) {
  if (std::find(allowed.begin(), allowed.end(), value) != allowed.end()) return;
  std::string list;
  for (const auto& name : allowed) list += (list.empty() ? "" : ", ") + std::string(name);
  throw InputError(reader.place(key), "one of " + list, "'" + value + "'");
}

void checkRange(const JsonReader& reader, const std::string& key, double value, double low,
                double high) {
  if (!(value >= low && value <= high))
    throwInput(reader.place(key), fmt::format("a value from {} to {}", low, high), "{}", value);
}

void check(const Config& c, const JsonReader& reader) {
  checkRange(reader, "pose_dim", c.poseDim, 2, 10000);
  checkRange(reader, "control_dim", c.controlDim, 0, 10000);
  checkRange(reader, "tau", c.tau, 1, 1000);
  checkRange(reader, "lookahead", c.lookahead, 0, 1000);
  checkRange(reader, "steps", c.steps, 1, 1000);
  checkRange(reader, "hidden", c.hidden, 1, 16384);
  checkRange(reader, "lstm_layers", c.layers, 1, 16);
  checkRange(reader, "dropout", c.dropout, 0.0, 1.0);
  checkOneOf<3>(reader, "cell", c.cell, {"lstm", "gru", "feedforward"});
  checkOneOf<2>(reader, "base", c.base, {"normal", "student_t"});
  checkOneOf<3>(reader, "start", c.start, {"orthogonal", "whitening", "reversal"});
  checkOneOf<3>(reader, "pose_base", c.poseBase, {"none", "linear", "kinematic"});
  if (c.base == "student_t") checkRange(reader, "df", c.df, 1e-3, 1e9);
  checkRange(reader, "observation_floor_mm", c.observationFloorMm, 0.0, 100.0);
  if (c.poseBase == "none") return;
  checkRange(reader, "base_order", c.baseOrder, 1, c.tau);
  checkRange(reader, "base_ridge", c.baseRidge, 0.0, 1e6);
  checkRange(reader, "base_floor", c.baseFloor, 1e-12, 1.0);
  if (c.poseBase != "kinematic") return;
  checkRange(reader, "base_order", c.baseOrder, 3, c.tau);
  checkRange(reader, "dropout", c.dropout, 0.0, 0.0);
  checkRange(reader, "regimes", c.regimes, 1, 4096);
  checkRange(reader, "regime_shrinkage", c.regimeShrinkage, 0.0, 1e9);
  checkRange(reader, "foot_clusters", c.footClusters, 1, 4096);
  checkRange(reader, "net_features", c.netFeatures, 1, c.poseDim * c.baseOrder);
  checkRange(reader, "contacts", c.contacts, 1, 64);
  checkOneOf<2>(reader, "bone_lengths", c.boneLengths, {"trained", "history"});
  if (c.boneLengths == "history" && !c.hasMotionBase())
    throw InputError(reader.place("bone_lengths"),
                     "'trained' without an observation floor: samples go through the same base",
                     "'history'");
}

/// The authors' JSON groups. Dimensions are not in it: they come from the checkpoint.
Config fromHparams(const Json& value, const std::string& origin) {
  JsonReader root(value, origin);
  JsonReader glow = root.object("Glow"), data = root.object("Data");
  Config out;
  out.steps = glow.required<int>("K");
  out.hidden = glow.required<int>("hidden_channels");
  out.layers = 2;  // the published network ignores its own 'num_layers'
  out.lu = glow.optional<bool>("LU_decomposed", true);
  out.cell = glow.optional<std::string>("network_model", "LSTM");
  std::transform(out.cell.begin(), out.cell.end(), out.cell.begin(),
                 [](unsigned char ch) { return std::tolower(ch); });
  if (out.cell == "ff") out.cell = "feedforward";
  const auto coupling = glow.optional<std::string>("flow_coupling", "affine");
  checkOneOf<1>(glow, "flow_coupling", coupling, {"affine"});
  const auto permutation = glow.optional<std::string>("flow_permutation", "invconv");
  checkOneOf<1>(glow, "flow_permutation", permutation, {"invconv"});
  const auto distribution = glow.optional<std::string>("distribution", "normal");
  checkOneOf<3>(glow, "distribution", distribution, {"normal", "studentT", "student_t"});
  out.base = distribution == "normal" ? "normal" : "student_t";
  if (out.base == "student_t") out.df = glow.required<double>("distribution_param");
  out.tau = data.required<int>("seqlen");
  out.lookahead = data.optional<int>("n_lookahead", 0);
  out.dropout = data.optional<double>("dropout", 0.95);
  check(out, glow);
  return out;
}

}  // namespace

Config configFromJson(const Json& value, const std::string& origin) {
  if (value.is_object() && value.contains("Glow")) return fromHparams(value, origin);
  if (value.is_object() && value.contains("model") && value["model"].is_object())
    return configFromJson(value["model"], origin);
  JsonReader reader(value, origin);
  Config c;
  c.poseDim = reader.optional("pose_dim", c.poseDim);
  c.controlDim = reader.optional("control_dim", c.controlDim);
  c.tau = reader.optional("tau", c.tau);
  c.lookahead = reader.optional("lookahead", c.lookahead);
  c.steps = reader.required<int>("steps");
  c.hidden = reader.required<int>("hidden");
  c.layers = reader.optional("lstm_layers", c.layers);
  c.cell = reader.optional("cell", c.cell);
  c.lu = reader.optional("lu", c.lu);
  c.base = reader.optional("base", c.base);
  c.df = reader.optional("df", c.df);
  c.dropout = reader.optional("dropout", c.dropout);
  c.start = reader.optional("start", c.start);
  c.poseBase = reader.optional("pose_base", c.poseBase);
  c.observationFloorMm = reader.optional("observation_floor_mm", c.observationFloorMm);
  c.baseOrder = reader.optional("base_order", std::min(c.baseOrder, c.tau));
  const bool kinematic = c.poseBase == "kinematic";
  c.baseRidge = reader.optional("base_ridge", kinematic ? 0.028 : c.baseRidge);
  c.baseFloor = reader.optional("base_floor", kinematic ? 1e-7 : c.baseFloor);
  if (kinematic) {
    c.regimes = reader.optional("regimes", c.regimes);
    c.regimeShrinkage = reader.optional("regime_shrinkage", c.regimeShrinkage);
    c.footClusters = reader.optional("foot_clusters", c.footClusters);
    c.netFeatures = reader.optional("net_features", c.netFeatures);
    c.contacts = reader.optional("contacts", c.contacts);
    c.feetPassFlow = reader.optional("feet_pass_flow", c.feetPassFlow);
    c.boneLengths = reader.optional("bone_lengths", c.boneLengths);
  }
  // Facts that conformance files state beside the configuration.
  for (const char* key : {"batch", "frames", "scale", "split", "channels", "parameters"})
    if (reader.has(key)) reader.raw(key);
  reader.finish();
  check(c, reader);
  return c;
}

Json toJson(const Config& c) {
  Json out = {{"pose_dim", c.poseDim},
              {"control_dim", c.controlDim},
              {"tau", c.tau},
              {"lookahead", c.lookahead},
              {"steps", c.steps},
              {"hidden", c.hidden},
              {"lstm_layers", c.layers},
              {"cell", c.cell},
              {"lu", c.lu},
              {"base", c.base},
              {"dropout", c.dropout},
              {"start", c.start},
              {"pose_base", c.poseBase}};
  if (c.base == "student_t") out["df"] = c.df;
  if (c.observationFloorMm > 0.0) out["observation_floor_mm"] = c.observationFloorMm;
  if (c.poseBase != "none") {
    out["base_order"] = c.baseOrder;
    out["base_ridge"] = c.baseRidge;
    out["base_floor"] = c.baseFloor;
  }
  if (c.poseBase == "kinematic") {
    out["regimes"] = c.regimes;
    out["regime_shrinkage"] = c.regimeShrinkage;
    out["foot_clusters"] = c.footClusters;
    out["net_features"] = c.netFeatures;
    out["contacts"] = c.contacts;
    out["feet_pass_flow"] = c.feetPassFlow;
    out["bone_lengths"] = c.boneLengths;
  }
  return out;
}

}  // namespace marey::moglow
