#include "model/data_set.h"

#include <cmath>

#include "base/error.h"
#include "base/hash.h"
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

struct Moments {
  std::vector<float> mean, std;
};

/// Population mean and standard deviation of columns. A constant column gets deviation 1, so
/// that standardising leaves it finite.
template <typename Member>
Moments momentsOf(const std::vector<FeatureSequence>& sequences, Member member) {
  const long width = (sequences.front().*member).cols();
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(width), squares = sum;
  double n = 0.0;
  for (const auto& s : sequences) {
    sum += (s.*member).template cast<double>().colwise().sum();
    n += static_cast<double>((s.*member).rows());
  }
  const Eigen::RowVectorXd mean = sum / n;
  for (const auto& s : sequences)
    squares += ((s.*member).template cast<double>().rowwise() - mean)
                   .array()
                   .square()
                   .matrix()
                   .colwise()
                   .sum();
  Moments out;
  for (long i = 0; i < width; ++i) {
    const double deviation = std::sqrt(squares(i) / n);
    out.mean.push_back(static_cast<float>(mean(i)));
    out.std.push_back(deviation > 1e-6 ? static_cast<float>(deviation) : 1.f);
  }
  return out;
}

std::vector<FeatureSequence> extractAll(const std::vector<Clip>& clips, const FeatureSpec& spec,
                                        const std::shared_ptr<const Skeleton>& skeleton,
                                        Progress& progress) {
  std::vector<FeatureSequence> out;
  for (const Clip& clip : clips) {
    progress.throwIfCancelled();
    out.push_back(extractFeatures(clip, spec, skeleton));
    progress.report(static_cast<double>(out.size()) / static_cast<double>(clips.size()), clip.name);
  }
  return out;
}

void augment(std::vector<FeatureSequence>& sequences, const PrepareOptions& options,
             const Skeleton& skeleton) {
  if (options.mirror)
    for (size_t i = 0, n = sequences.size(); i < n; ++i) {
      sequences.push_back(mirrored(sequences[i], options.features, skeleton));
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
  out.options.features.layout = poses.name;
  out.boneLengthsM = meanBoneLengths(train);
  Progress trainProgress = progress.part(0.0, 0.7), testProgress = progress.part(0.7, 0.8);
  out.train = extractAll(train, options.features, out.skeleton, trainProgress);
  out.test = extractAll(test, options.features, out.skeleton, testProgress);
  augment(out.train, options, *out.skeleton);
  const Moments pose = momentsOf(out.train, &FeatureSequence::pose);
  const Moments control = momentsOf(out.train, &FeatureSequence::control);
  out.standardiser = {pose.mean, pose.std, control.mean, control.std};
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

void storeSequences(const std::string& prefix, const std::vector<FeatureSequence>& sequences,
                    TensorFile& file) {
  long rows = 0;
  for (const auto& s : sequences) rows += s.pose.rows();
  const long poseDim = sequences.empty() ? 0 : sequences.front().pose.cols();
  const long controlDim = sequences.empty() ? 0 : sequences.front().control.cols();
  Matrix pose(rows, poseDim), control(rows, controlDim);
  std::vector<int64_t> lengths;
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
  }
  const auto count = static_cast<int64_t>(sequences.size());
  file.tensors[prefix + "/pose"] = Tensor::fromFloats({rows, poseDim}, pose.data());
  file.tensors[prefix + "/control"] = Tensor::fromFloats({rows, controlDim}, control.data());
  file.tensors[prefix + "/lengths"] = Tensor::fromInt64({count}, lengths.data());
  file.tensors[prefix + "/start"] = Tensor::fromDoubles({count, 3}, starts.data());
  file.metadata[prefix + "_names"] = names;
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
  file.metadata["config"] = {{"window_s", data.options.windowS},
                             {"hop_s", data.options.hopS},
                             {"mirror", data.options.mirror},
                             {"reverse", data.options.reverse}};
  file.tensors["bone_lengths_m"] = Tensor::fromFloats(
      {static_cast<int64_t>(data.boneLengthsM.size())}, data.boneLengthsM.data());
  storeSequences("train", data.train, file);
  storeSequences("test", data.test, file);
  writeTensorFile(path, file);
}

DataSet readDataSet(const std::filesystem::path& path) {
  const std::string origin = path.string();
  const TensorFile file = readTensorFile(path);
  if (file.metadata.value("kind", "") != "dataset")
    throw InputError({.path = origin}, "a data set made by `marey prepare`", "another file");
  const ModelInfo common = loadCommon(file, origin);
  JsonReader config(common.config, origin, "config.");
  DataSet out;
  out.options.features = common.features;
  out.options.windowS = config.required<double>("window_s");
  out.options.hopS = config.required<double>("hop_s");
  out.options.mirror = config.required<bool>("mirror");
  out.options.reverse = config.required<bool>("reverse");
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
