#include "model/data_set.h"

#include <cmath>

#include "base/error.h"
#include "base/format_version.h"
#include "base/hash.h"
#include "model/control_data.h"
#include "motion/representation/representation.h"

namespace marey {
namespace {

void checkSameSkeleton(const std::vector<Clip>& clips, const Skeleton& first,
                       const std::string& firstName) {
  for (const Clip& clip : clips) {
    const std::string& path = clip.source.path.empty() ? clip.name : clip.source.path;
    if (clip.skeleton->names == first.names && clip.skeleton->parents == first.parents) continue;
    throwInput({.path = path}, fmt::format("the {} joints of {}", first.jointCount(), firstName),
               "{} joints, or other names", clip.jointCount());
  }
}

std::vector<float> meanBoneLengths(const std::vector<Clip>& clips) {
  const auto bones = clips.front().skeleton->bones();
  std::vector<double> sums(bones.size(), 0.0);
  double frames = 0.0;
  for (const Clip& clip : clips) {
    for (int t = 0; t < clip.frameCount(); ++t)
      for (size_t b = 0; b < bones.size(); ++b)
        sums[b] += (clip.at(t, bones[b].first) - clip.at(t, bones[b].second)).norm();
    frames += clip.frameCount();
  }
  std::vector<float> out;
  for (const double sum : sums) out.push_back(static_cast<float>(sum / frames));
  return out;
}

std::vector<FeatureSequence> extractAll(const std::vector<Clip>& clips, const FeatureSpec& spec,
                                        const std::shared_ptr<const Skeleton>& skeleton,
                                        const Bodies& bodies, Progress& progress) {
  std::vector<FeatureSequence> out;
  for (const Clip& clip : clips) {
    progress.throwIfCancelled();
    const auto body = bodies.of(clip);
    out.push_back(extractFeatures(clip, spec, body ? body : skeleton));
    out.back().body = body;
    progress.report(static_cast<double>(out.size()) / static_cast<double>(clips.size()), clip.name);
  }
  return out;
}

void augment(std::vector<FeatureSequence>& sequences, const PrepareOptions& options,
             const Skeleton& skeleton) {
  if (options.mirror)
    for (size_t i = 0, n = sequences.size(); i < n; ++i) {
      const Skeleton& body = sequences[i].body ? *sequences[i].body : skeleton;
      sequences.push_back(mirrored(sequences[i], options.features, body));
      sequences.back().name += "|mirror";
    }
  if (options.reverse)
    for (size_t i = 0, n = sequences.size(); i < n; ++i) {
      sequences.push_back(timeReversed(sequences[i], options.features));
      sequences.back().name += "|reverse";
    }
}

/// Of clips and, as the first of `sequences`, what they became.
Json sourcesOf(const std::vector<Clip>& clips, const std::vector<FeatureSequence>& sequences) {
  Json out = Json::array();
  for (size_t i = 0; i < clips.size(); ++i) {
    const Clip& clip = clips[i];
    out.push_back({{"name", clip.name},
                   {"format", clip.source.format},
                   {"unit", clip.source.unit},
                   {"up", clip.source.up},
                   {"fps", clip.source.fps},
                   {"frames", clip.frameCount()}});
    if (sequences[i].fitM > 0.0) out.back()["rotations_fitted_within_m"] = sequences[i].fitM;
  }
  return out;
}

}  // namespace

DataSet prepareDataSet(const std::vector<Clip>& train, const std::vector<Clip>& test,
                       const PrepareOptions& options, Progress& progress) {
  if (train.empty()) throw InputError({.path = "training clips"}, "at least one", "none");
  if (!(options.windowS > 0.0) || !(options.hopS > 0.0))
    throwInput({.path = "window and hop"}, "seconds above zero", "{} and {}", options.windowS,
               options.hopS);
  checkSameSkeleton(train, *train.front().skeleton, train.front().name);
  checkSameSkeleton(test, *train.front().skeleton, train.front().name);
  const Representation& poses = representationOf(options.features, "data set");
  DataSet out{.options = options, .skeleton = poses.skeletonOf(train, options.features)};
  FeatureSpec& features = out.options.features;
  features.layout = poses.name;
  features.control = completedLayout(features.control, train);
  out.boneLengthsM = meanBoneLengths(train);
  const Bodies bodies(train, test, features);
  Progress trainProgress = progress.part(0.0, 0.7), testProgress = progress.part(0.7, 0.8);
  out.train = extractAll(train, features, out.skeleton, bodies, trainProgress);
  out.test = extractAll(test, features, out.skeleton, bodies, testProgress);
  augment(out.train, out.options, *out.skeleton);
  const Moments pose = poseMoments(out.train), control = controlMoments(out.train, features);
  out.standardiser = {pose.mean, pose.std, control.mean, control.std};
  for (auto* sequences : {&out.train, &out.test})
    for (FeatureSequence& s : *sequences)
      fillAbsent(features.control, features.fps, control.mean, s.control);
  out.provenance = {{"train", sourcesOf(train, out.train)}, {"test", sourcesOf(test, out.test)}};
  progress.report(1.0, "prepared");
  return out;
}

std::vector<Window> cutWindows(const std::vector<FeatureSequence>& sequences, int windowFrames,
                               int hopFrames) {
  std::vector<Window> out;
  for (size_t s = 0; s < sequences.size(); ++s) {
    const int frames = sequences[s].frameCount();
    int first = 0;
    for (; first + windowFrames <= frames; first += hopFrames)
      out.push_back({static_cast<int>(s), first, windowFrames});
    const int reached = first == 0 ? 0 : first - hopFrames + windowFrames;
    if (frames <= windowFrames && first == 0)
      out.push_back({static_cast<int>(s), 0, frames});
    else if (reached < frames)
      out.push_back({static_cast<int>(s), frames - windowFrames, windowFrames});
  }
  return out;
}

void requireFinite(const std::vector<FeatureSequence>& sequences, const std::string& origin) {
  for (const auto& s : sequences)
    for (long t = 0; t < s.pose.rows(); ++t)
      if (!s.pose.row(t).allFinite() || !s.control.row(t).allFinite())
        throw InputError({.path = origin, .frame = t + 1, .item = "sequence '" + s.name + "'"},
                         "finite poses and controls", "NaN or infinity");
}

namespace {

/// Bodies of their own as numbers in a list, in the order in which they come.
class StoredBodies {
 public:
  int64_t numberOf(const FeatureSequence& s) {
    if (!s.body) return -1;
    for (size_t i = 0; i < m_bodies.size(); ++i)
      if (m_bodies[i] == s.body || *m_bodies[i] == *s.body) return static_cast<int64_t>(i);
    m_bodies.push_back(s.body);
    return static_cast<int64_t>(m_bodies.size()) - 1;
  }
  Json toJson() const {
    Json out = Json::array();
    for (const auto& body : m_bodies) out.push_back(marey::toJson(*body));
    return out;
  }
  static std::vector<std::shared_ptr<const Skeleton>> read(const TensorFile& file,
                                                           const std::string& origin) {
    std::vector<std::shared_ptr<const Skeleton>> out;
    if (!file.metadata.contains("bodies")) return out;
    for (const Json& body : file.metadata["bodies"]) out.push_back(skeletonFromJson(body, origin));
    return out;
  }
  bool none() const { return m_bodies.empty(); }

 private:
  std::vector<std::shared_ptr<const Skeleton>> m_bodies;
};

void storeSequences(const std::string& prefix, const std::vector<FeatureSequence>& sequences,
                    StoredBodies& bodies, TensorFile& file) {
  long rows = 0;
  for (const auto& s : sequences) rows += s.pose.rows();
  const long poseDim = sequences.empty() ? 0 : sequences.front().pose.cols();
  const long controlDim = sequences.empty() ? 0 : sequences.front().control.cols();
  Matrix pose(rows, poseDim), control(rows, controlDim);
  std::vector<int64_t> lengths, numbers;
  std::vector<double> starts;
  Json names = Json::array();
  long at = 0;
  for (const auto& s : sequences) {
    pose.middleRows(at, s.pose.rows()) = s.pose;
    control.middleRows(at, s.pose.rows()) = s.control;
    at += s.pose.rows();
    lengths.push_back(s.pose.rows());
    starts.insert(starts.end(), {s.start.x, s.start.z, s.start.heading});
    names.push_back(s.name);
    numbers.push_back(bodies.numberOf(s));
  }
  const auto count = static_cast<int64_t>(sequences.size());
  file.tensors[prefix + "/pose"] = Tensor::fromFloats({rows, poseDim}, pose.data());
  file.tensors[prefix + "/control"] = Tensor::fromFloats({rows, controlDim}, control.data());
  file.tensors[prefix + "/lengths"] = Tensor::fromInt64({count}, lengths.data());
  file.tensors[prefix + "/start"] = Tensor::fromDoubles({count, 3}, starts.data());
  file.metadata[prefix + "_names"] = names;
  if (!bodies.none()) file.tensors[prefix + "/body"] = Tensor::fromInt64({count}, numbers.data());
}

Matrix matrixOf(const Tensor& tensor) {
  const auto values = tensor.toFloats();
  return Eigen::Map<const Matrix>(values.data(), tensor.shape[0], tensor.shape[1]);
}

std::vector<FeatureSequence> loadSequences(const std::string& prefix, const TensorFile& file,
                                           const std::string& origin) {
  const auto lengths = file.get(prefix + "/lengths", {-1}, origin).toInt64();
  const Matrix pose = matrixOf(file.get(prefix + "/pose", {-1, -1}, origin));
  const Matrix control = matrixOf(file.get(prefix + "/control", {pose.rows(), -1}, origin));
  const auto count = static_cast<int64_t>(lengths.size());
  const auto starts = file.get(prefix + "/start", {count, 3}, origin).toDoubles();
  JsonReader reader(file.metadata, origin);
  const auto names = reader.required<std::vector<std::string>>(prefix + "_names");
  const auto bodies = StoredBodies::read(file, origin);
  std::vector<int64_t> numbers(lengths.size(), -1);
  if (file.tensors.contains(prefix + "/body"))
    numbers = file.get(prefix + "/body", {count}, origin).toInt64();
  std::vector<FeatureSequence> out;
  int64_t at = 0;
  for (size_t i = 0; i < lengths.size(); ++i) {
    if (lengths[i] < 1 || lengths[i] > pose.rows() - at || i >= names.size())
      throwInput({.path = origin, .item = prefix + " sequence " + std::to_string(i)},
                 "frames within the data", "{} frames", lengths[i]);
    out.push_back({names[i],
                   pose.middleRows(at, lengths[i]),
                   control.middleRows(at, lengths[i]),
                   {starts[3 * i], starts[3 * i + 1], starts[3 * i + 2]}});
    if (numbers[i] >= static_cast<int64_t>(bodies.size()))
      throwInput({.path = origin, .item = prefix + " sequence " + std::to_string(i)},
                 fmt::format("one of {} bodies", bodies.size()), "number {}", numbers[i]);
    if (numbers[i] >= 0) out.back().body = bodies[static_cast<size_t>(numbers[i])];
    at += lengths[i];
  }
  requireFinite(out, origin);
  return out;
}

}  // namespace

void writeDataSet(const std::filesystem::path& path, const DataSet& data) {
  ModelInfo common;
  common.features = data.options.features;
  common.skeleton = data.skeleton;
  common.standardiser = data.standardiser;
  common.poseDim = data.poseDim();
  common.controlDim = data.controlDim();
  common.provenance = data.provenance;
  TensorFile file;
  storeCommon(common, file);
  file.metadata["kind"] = "dataset";
  file.metadata["version"] = kDataSetVersion;
  file.metadata["config"] = {{"window_s", data.options.windowS},
                             {"hop_s", data.options.hopS},
                             {"mirror", data.options.mirror},
                             {"reverse", data.options.reverse}};
  file.tensors["bone_lengths_m"] = Tensor::fromFloats(
      {static_cast<int64_t>(data.boneLengthsM.size())}, data.boneLengthsM.data());
  StoredBodies bodies;
  storeSequences("train", data.train, bodies, file);
  storeSequences("test", data.test, bodies, file);
  if (!bodies.none()) file.metadata["bodies"] = bodies.toJson();
  writeTensorFile(path, file);
}

DataSet readDataSet(const std::filesystem::path& path) {
  const std::string origin = path.string();
  const TensorFile file = readTensorFile(path);
  if (file.metadata.value("kind", "") != "dataset")
    throw InputError({.path = origin}, "a data set made by `marey prepare`", "another file");
  JsonReader metadata(file.metadata, origin);
  readFormatVersion(metadata, kDataSetVersion);
  const ModelInfo common = loadCommon(file, origin);
  JsonReader config(common.config, origin, "config.");
  DataSet out;
  out.options.features = common.features;
  out.options.windowS = config.required<double>("window_s");
  out.options.hopS = config.required<double>("hop_s");
  out.options.mirror = config.required<bool>("mirror");
  out.options.reverse = config.required<bool>("reverse");
  config.finish();
  out.skeleton = common.skeleton;
  if (!out.skeleton) throw InputError({.path = origin}, "a data set with a skeleton", "none");
  out.standardiser = common.standardiser;
  out.provenance = common.provenance;
  out.hash = common.hash;
  out.boneLengthsM =
      file.get("bone_lengths_m", {static_cast<int64_t>(out.skeleton->bones().size())}, origin)
          .toFloats();
  out.train = loadSequences("train", file, origin);
  out.test = loadSequences("test", file, origin);
  if (out.train.empty()) throw InputError({.path = origin}, "training sequences", "none");
  return out;
}

}  // namespace marey
