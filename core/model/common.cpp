#include <cmath>
#include <numeric>

#include "base/format_version.h"
#include "base/hash.h"
#include "base/tensor_metadata.h"
#include "model/linear_gaussian.h"
#include "model/model_family.h"
#include "model/pose_units.h"
#include "motion/control/encode_control.h"
#include "motion/representation/representation.h"

namespace marey {
namespace {

Tensor vectorTensor(const std::vector<float>& values) {
  return Tensor::fromFloats({static_cast<int64_t>(values.size())}, values.data());
}

std::vector<float> loadVector(const TensorFile& file, const std::string& key, int64_t size,
                              const std::string& origin, bool positive) {
  auto out = file.get(key, {size}, origin).toFloats();
  for (const float v : out)
    if (!std::isfinite(v) || (positive && v <= 0.f))
      throwInput({.path = origin, .item = "tensor '" + key + "'"},
                 positive ? "finite values above zero" : "finite values", "{}", v);
  return out;
}

}  // namespace

void requireSameJoints(const ModelInfo& info, const Clip& clip, const std::string& path) {
  const int joints = jointsOf(info);
  if (clip.jointCount() != joints)
    throwInput({.path = path}, fmt::format("{} joints, as the model has", joints), "{}",
               clip.jointCount());
  if (!info.skeleton || !clip.skeleton) return;
  const auto &wanted = info.skeleton->names, &found = clip.skeleton->names;
  for (size_t j = 0; j < wanted.size(); ++j)
    if (wanted[j] != found[j])
      throwInput({.path = path, .item = fmt::format("joint {}", j)},
                 fmt::format("'{}', as the model has", wanted[j]), "'{}'", found[j]);
}

FeatureSequence featuresOf(const ModelInfo& info, const Clip& clip) {
  const bool own = channelOf(info.features.control, ControlKind::Skeleton) != nullptr;
  auto body = own ? representationOf(info.features, clip.name).skeletonOf({clip}, info.features)
                  : info.skeleton;
  FeatureSequence out = extractFeatures(clip, info.features, body);
  if (own) out.body = std::move(body);
  fillAbsent(info.features.control, info.features.fps, info.standardiser.controlMean, out.control);
  return out;
}

double Standardiser::logDetPerFrame() const {
  return std::accumulate(poseStd.begin(), poseStd.end(), 0.0, [](double sum, float s) {
    return sum - std::log(static_cast<double>(s));
  });
}

std::vector<SamplingOption> optionSchemaOf(const std::string& path,
                                           std::span<const ModelFamily> families) {
  const Json metadata = readTensorMetadata(path);
  JsonReader reader(metadata, path);
  const ModelFamily& family = familyNamed(reader.required<std::string>("family"), families, path);
  return family.describe(reader.raw("config"), path).optionSchema;
}

void requireKnownConfigKeys(const Json& config, const std::string& origin) {
  if (!config.is_object() || !(config.contains("family") || config.contains("model"))) return;
  JsonReader reader(config, origin);
  readFormatVersion(reader, kConfigVersion);
  reader.optional<std::string>("family", "");
  reader.optional<std::string>("name", "");
  reader.optional<std::string>("notes", "");
  for (const char* key : {"model", "training"})
    if (reader.has(key)) reader.raw(key);
  reader.finish();
}

const ModelFamily& familyNamed(const std::string& name, std::span<const ModelFamily> families,
                               const std::string& origin) {
  std::string known;
  for (const auto& family : families) {
    if (family.name == name) return family;
    known += (known.empty() ? "" : ", ") + family.name;
  }
  throw InputError({.path = origin, .item = "key 'family'"}, "one of " + known, "'" + name + "'");
}

std::unique_ptr<MotionModel> loadModel(const std::string& path,
                                       std::span<const ModelFamily> families,
                                       const LoadOptions& options) {
  TensorFile file = readTensorFile(path);
  JsonReader reader(file.metadata, path);
  if (reader.optional<std::string>("kind", "") != "model")
    throw InputError(
        {.path = path}, "a Marey model",
        file.metadata.empty()
            ? "a safetensors file of another program (marey model import reads it)"
            : "a file of kind '" + reader.optional<std::string>("kind", "unknown") + "'");
  readFormatVersion(reader, kModelVersion);  // before the family, which may be newer too
  const ModelFamily& family = familyNamed(reader.required<std::string>("family"), families, path);
  return family.load(std::move(file), path, options);
}

const ModelFamily& familyOf(const Json& config, std::span<const ModelFamily> families,
                            const std::string& origin) {
  JsonReader reader(config, origin);
  requireKnownConfigKeys(config, origin);
  if (reader.has("family"))
    return familyNamed(reader.required<std::string>("family"), families, origin);
  for (const auto& family : families)
    if (family.recognises && family.recognises(config)) return family;
  throw InputError({.path = origin, .item = "key 'family'"}, "the name of a model family", "none");
}

std::string nameOf(DensityKind kind) {
  if (kind == DensityKind::Exact) return "exact";
  return kind == DensityKind::Bound ? "bound" : "none";
}

SequenceScore DensityEstimator::observe(RolloutState& state, const Matrix& poses,
                                        const Matrix& controls) const {
  const ObservedSequence one{&poses, &controls};
  return std::move(observeMany({&state, 1}, {&one, 1}, [] {}).front());
}

const FrameGenerator& requireRollout(const MotionModel& model) {
  if (const auto* ability = model.rollout()) return *ability;
  const ModelInfo& info = model.info();
  throw InputError({.path = info.variant.empty() ? info.family : info.variant},
                   "a model that makes motion frame by frame", "one that needs all control first");
}

const DensityEstimator& requireDensity(const MotionModel& model) {
  if (const auto* ability = model.density()) return *ability;
  const ModelInfo& info = model.info();
  throw InputError({.path = info.variant.empty() ? info.family : info.variant},
                   "a model with a likelihood", "one that has none (" + info.family + ")");
}

Json toJson(const FeatureSpec& spec) {
  Json out = {{"layout", spec.layout},
              {"fps", spec.fps},
              {"root_sigma_s", spec.rootSigmaS},
              {"facing_sigma_s", spec.facingSigmaS}};
  if (!isRootMotionAlone(spec.control)) out["control"] = toJson(spec.control);
  return out;
}

FeatureSpec featureSpecFromJson(const Json& value, const std::string& origin) {
  JsonReader reader(value, origin, "features.");
  FeatureSpec out;
  out.layout =
      representationNamed(reader.required<std::string>("layout"), reader.place("layout")).name;
  out.fps = reader.required<double>("fps");
  out.rootSigmaS = reader.required<double>("root_sigma_s");
  out.facingSigmaS = reader.required<double>("facing_sigma_s");
  if (reader.has("control")) out.control = controlLayoutFromJson(reader.raw("control"), origin);
  reader.finish();
  if (!(out.fps > 0.0)) throwInput(reader.place("fps"), "a positive rate", "{}", out.fps);
  return out;
}

Json toJson(const Skeleton& skeleton) {
  Json offsets = Json::array();
  for (const auto& o : skeleton.offsets) offsets.push_back({o.x(), o.y(), o.z()});
  Json ends = Json::array();
  for (const auto& e : skeleton.endSites)
    ends.push_back(
        {{"parent", e.parent}, {"offset_m", {e.offset.x(), e.offset.y(), e.offset.z()}}});
  Json out = {{"names", skeleton.names},
              {"parents", skeleton.parents},
              {"offsets_m", offsets},
              {"end_sites", ends}};
  if (skeleton.rest.empty()) return out;
  out["rest_wxyz"] = Json::array();
  for (const auto& q : skeleton.rest) out["rest_wxyz"].push_back({q.w(), q.x(), q.y(), q.z()});
  return out;
}

namespace {

Skeleton::EndSite endSiteFromJson(const Json& value, const std::string& origin, int joints) {
  JsonReader reader(value, origin, "skeleton.end_sites.");
  const auto parent = reader.required<int>("parent");
  const auto offset = reader.required<std::vector<float>>("offset_m");
  reader.finish();
  if (parent < 0 || parent >= joints)
    throwInput(reader.place("parent"), fmt::format("a joint below {}", joints), "{}", parent);
  if (offset.size() != 3) throwInput(reader.place("offset_m"), "3 values", "{}", offset.size());
  return {parent, {offset[0], offset[1], offset[2]}};
}

}  // namespace

std::shared_ptr<const Skeleton> skeletonFromJson(const Json& value, const std::string& origin) {
  JsonReader reader(value, origin, "skeleton.");
  auto out = std::make_shared<Skeleton>();
  out->names = reader.required<std::vector<std::string>>("names");
  out->parents = reader.required<std::vector<int>>("parents");
  for (const auto& o : reader.required<std::vector<std::vector<float>>>("offsets_m")) {
    if (o.size() != 3) throwInput(reader.place("offsets_m"), "3 values per joint", "{}", o.size());
    out->offsets.emplace_back(o[0], o[1], o[2]);
  }
  // Files written before end sites were kept have none.
  if (reader.has("end_sites"))
    for (const Json& end : reader.raw("end_sites"))
      out->endSites.push_back(endSiteFromJson(end, origin, out->jointCount()));
  if (reader.has("rest_wxyz"))
    for (const auto& q : reader.required<std::vector<std::vector<float>>>("rest_wxyz")) {
      if (q.size() != 4)
        throwInput(reader.place("rest_wxyz"), "4 values per joint", "{}", q.size());
      out->rest.emplace_back(q[0], q[1], q[2], q[3]);
    }
  validate(*out, origin);
  return out;
}

void storeCommon(const ModelInfo& info, TensorFile& file) {
  file.metadata["kind"] = "model";
  file.metadata["version"] = kModelVersion;
  file.metadata["family"] = info.family;
  file.metadata["variant"] = info.variant;
  file.metadata["pose_dim"] = info.poseDim;
  file.metadata["control_dim"] = info.controlDim;
  file.metadata["config"] = info.config;
  file.metadata["features"] = toJson(info.features);
  file.metadata["provenance"] = info.provenance;
  if (!info.observation.none()) file.metadata["observation"] = toJson(info.observation);
  if (info.yardstick) store(*info.yardstick, file);
  if (info.skeleton) file.metadata["skeleton"] = toJson(*info.skeleton);
  if (info.standardiser.empty()) return;
  file.tensors["standardiser/pose_mean"] = vectorTensor(info.standardiser.poseMean);
  file.tensors["standardiser/pose_std"] = vectorTensor(info.standardiser.poseStd);
  file.tensors["standardiser/control_mean"] = vectorTensor(info.standardiser.controlMean);
  file.tensors["standardiser/control_std"] = vectorTensor(info.standardiser.controlStd);
}

ModelInfo loadCommon(const TensorFile& file, const std::string& origin) {
  JsonReader reader(file.metadata, origin);
  ModelInfo out;
  out.family = reader.required<std::string>("family");
  out.variant = reader.optional<std::string>("variant", "");
  out.poseDim = reader.required<int>("pose_dim");
  out.controlDim = reader.required<int>("control_dim");
  out.config = reader.raw("config");
  out.features = featureSpecFromJson(reader.raw("features"), origin);
  if (reader.has("provenance")) out.provenance = reader.raw("provenance");
  if (reader.has("observation"))
    out.observation = observationNoiseFromJson(reader.raw("observation"), origin);
  if (reader.has("skeleton")) out.skeleton = skeletonFromJson(reader.raw("skeleton"), origin);
  requireFittingPoses(out, origin);
  out.yardstick = loadLinearGaussian(file, out.poseDim, out.controlDim, out.observation.floorM,
                                     floorScales(channelsOf(out)), origin);
  if (file.tensors.contains("standardiser/pose_mean")) {
    out.standardiser = {
        loadVector(file, "standardiser/pose_mean", out.poseDim, origin, false),
        loadVector(file, "standardiser/pose_std", out.poseDim, origin, true),
        loadVector(file, "standardiser/control_mean", out.controlDim, origin, false),
        loadVector(file, "standardiser/control_std", out.controlDim, origin, true)};
  }
  out.hash = contentHash(file);
  return out;
}

}  // namespace marey
