#include "experiment/sample_files.h"

#include <algorithm>
#include <cstring>
#include <mutex>

#include "base/error.h"
#include "base/hash.h"
#include "base/packing.h"
#include "experiment/motion_writers.h"
#include "io/clip_io.h"

namespace marey {
namespace {

/// Largest batch: more gains no speed.
constexpr int kMostTogether = 128;
/// What the motions of one batch may take while they are sampled.
constexpr double kBatchBytes = 128e6;

std::string_view bytesOf(const void* data, size_t size) {
  return {static_cast<const char*>(data), size};
}

/// All of what is asked beside the path, in bytes.
std::string bytesOf(const ControlRequest& r) {
  Packer packer;
  for (const LabelSpan& span : r.annotations.labels)
    packer.add(span.label).add(span.fromS).add(span.toS);
  for (const auto& [name, signal] : r.annotations.signals)
    packer.add(name).add(signal.fps).add(signal.startS).add(signal.values);
  for (const std::string& name : r.leftOut) packer.add(name);
  if (r.body) packer.add(jsonText(toJson(*r.body)));
  return packer.take();
}

/// Of all that makes the motions besides seed, temperature and model.
std::string steeringHash(const SampleRequest& r) {
  const std::string control = bytesOf(r.control);
  const std::string options = textOf(r.options);
  std::vector<std::string_view> parts = {
      bytesOf(r.path.data(), r.path.size() * sizeof(RootFrame)),
      bytesOf(r.startPoses.data(), static_cast<size_t>(r.startPoses.size()) * sizeof(float)),
      bytesOf(r.startControl.data(), static_cast<size_t>(r.startControl.size()) * sizeof(float)),
      control};
  if (!options.empty()) parts.emplace_back(options);
  return contentHash(parts);
}

size_t partsOf(int samples) {
  return static_cast<size_t>((samples + kMotionsOfPart - 1) / kMotionsOfPart);
}

UnfinishedFolder::Run runOf(const SampleFilesRequest& request) {
  UnfinishedFolder::Run run{.parts = partsOf(request.sampling.samples)};
  for (const auto& [key, value] : request.recipe.items())
    (key == "command" ? run.notes : run.identity)[key] = value;
  run.identity["samples"] = request.sampling.samples;
  run.identity["frames"] = request.sampling.path.size();
  run.identity["format"] = request.format;
  run.identity["steering"] = steeringHash(request.sampling);
  return run;
}

/// The folder as the first rank opened it, on every rank, and the parts that are to be made.
std::pair<UnfinishedFolder, std::vector<size_t>> openOnAll(
    const SampleFilesRequest& request, Ranks& ranks,
    const std::function<void(const UnfinishedFolder&)>& opened) {
  const std::string told = ranks.fromFirst([&] {
    const auto folder = UnfinishedFolder::open(request.out, runOf(request), request.resume);
    if (opened) opened(folder);
    return jsonText({{"place", folder.place().string()},
                     {"notes", folder.run().notes},
                     {"missing", folder.missing()}});
  });
  const Json facts = parseJson(told, "the first process");
  UnfinishedFolder::Run run = runOf(request);
  run.notes = facts["notes"];
  return {UnfinishedFolder::join(request.out, facts["place"].get<std::string>(), std::move(run)),
          facts["missing"].get<std::vector<size_t>>()};
}

Json toJson(const std::optional<FitResidual>& fit) {
  if (!fit) return nullptr;
  return {
      {"joints", fit->joints}, {"rms_m", fit->rmsM}, {"max_m", fit->maxM}, {"frames", fit->frames}};
}

std::optional<FitResidual> fitFromJson(const Json& value, const std::string& origin) {
  if (value.is_null()) return std::nullopt;
  JsonReader reader(value, origin);
  FitResidual out{reader.required<std::vector<std::string>>("joints"),
                  reader.required<std::vector<double>>("rms_m"),
                  reader.required<std::vector<double>>("max_m"),
                  reader.required<std::vector<int>>("frames")};
  reader.finish();
  return out;
}

std::optional<FitResidual> together(const std::optional<FitResidual>& a,
                                    const std::optional<FitResidual>& b) {
  return a && b ? pooled(*a, *b) : a ? a : b;
}

/// Makes the parts of one rank.
class PartMaker {
 public:
  PartMaker(const MotionModel& model, const SampleFilesRequest& request,
            const UnfinishedFolder& folder)
      : m_model(model), m_request(request), m_folder(folder), m_recipe(request.recipe) {
    // A resumed run repeats the broken one to the byte.
    for (const auto& [key, value] : folder.run().notes.items()) m_recipe[key] = value;
  }

  /// Their records.
  std::vector<std::string> make(std::span<const size_t> parts, Progress& progress) {
    for (const size_t part : parts) m_total += motionsOf(part);
    const int most = motionsTogether(m_model.info(), m_request.sampling.path.size());
    const auto keep = [this](const FeatureSequence& motion, int sample) { write(motion, sample); };
    MotionWriters writers(m_request.writers, static_cast<size_t>(most), keep);
    for (size_t i = 0; i < parts.size();) {
      // Parts that follow each other are sampled together, as far as memory allows.
      size_t last = i + 1;
      int count = motionsOf(parts[i]);
      while (last < parts.size() && parts[last] == parts[last - 1] + 1 &&
             count + motionsOf(parts[last]) <= most)
        count += motionsOf(parts[last++]);
      const int begin = static_cast<int>(parts[i]) * kMotionsOfPart;
      for (int first = begin; first < begin + count; first += most)
        sample(first, std::min(most, begin + count - first), writers, progress);
      i = last;
    }
    writers.finish([&] { tell(writers, progress); });
    progress.report(1.0, "written");
    std::vector<std::string> records;
    for (const size_t part : parts) records.push_back(jsonText(m_folder.recordOf(part)));
    return records;
  }

 private:
  /// What is known of a part before it is complete.
  struct Part {
    std::vector<std::vector<std::string>> files;
    std::vector<std::optional<FitResidual>> fits;
    int written = 0;
  };

  int motionsOf(size_t part) const {
    return std::min(kMotionsOfPart,
                    m_request.sampling.samples - static_cast<int>(part) * kMotionsOfPart);
  }

  void tell(const MotionWriters& writers, Progress& progress) const {
    progress.throwIfCancelled();
    progress.report(0.5 * (m_sampled + writers.written()) / m_total, "writing");
  }

  void sample(int first, int count, MotionWriters& writers, Progress& progress) {
    SampleRequest request = m_request.sampling;
    request.firstSample = first;
    request.samples = count;
    const double done = 0.5 * (m_sampled + writers.written()) / m_total;
    Progress part = progress.part(done, done + 0.5 * count / m_total);
    auto motions = sampleSequences(m_model, request, part);
    m_sampled += count;
    for (int b = 0; b < count; ++b)
      writers.push(std::move(motions[static_cast<size_t>(b)]), first + b,
                   [&] { tell(writers, progress); });
  }

  void write(const FeatureSequence& motion, int sample) {
    const Clip clip = sampledClip(m_model, motion);
    io::WriteOptions options{.format = m_request.format};
    options.recipe = m_recipe;
    options.recipe["sample"] = clip.name;
    const auto written =
        io::writeClip(clip, m_folder.place() / (clip.name + "." + m_request.format), options);
    std::vector<std::string> files;
    for (const auto& file : written.files) files.push_back(file.filename().string());
    const std::lock_guard lock(m_mutex);
    finishMotion(sample, std::move(files), written.fit);
  }

  void finishMotion(int sample, std::vector<std::string> files, std::optional<FitResidual> fit) {
    const size_t number = static_cast<size_t>(sample / kMotionsOfPart);
    const auto motions = static_cast<size_t>(motionsOf(number));
    Part& part = m_open[number];
    part.files.resize(motions);
    part.fits.resize(motions);
    part.files[static_cast<size_t>(sample % kMotionsOfPart)] = std::move(files);
    part.fits[static_cast<size_t>(sample % kMotionsOfPart)] = std::move(fit);
    if (++part.written < static_cast<int>(motions)) return;
    std::optional<FitResidual> fits;
    for (const auto& one : part.fits) fits = together(fits, one);
    m_folder.record(number, {{"files", part.files}, {"fit", toJson(fits)}});
    m_open.erase(number);
  }

  const MotionModel& m_model;
  const SampleFilesRequest& m_request;
  const UnfinishedFolder& m_folder;
  Json m_recipe;
  int m_total = 0, m_sampled = 0;
  std::mutex m_mutex;
  std::map<size_t, Part> m_open;
};

}  // namespace

int motionsTogether(const ModelInfo& info, size_t frames) {
  const double bytes =
      static_cast<double>(frames) * (info.poseDim + info.controlDim) * sizeof(float);
  return static_cast<int>(std::clamp(kBatchBytes / bytes, 1.0, double{kMostTogether}));
}

SampleFiles writeSampleFiles(const MotionModel& model, const SampleFilesRequest& request,
                             Ranks& ranks, Progress& progress,
                             const std::function<void(const UnfinishedFolder&)>& opened) {
  const auto [folder, missing] = openOnAll(request, ranks, opened);
  const auto records = ranks.gather(
      missing.size(),
      [&, &folder = folder, &missing = missing](size_t first, size_t last, Progress& share) {
        return PartMaker(model, request, folder)
            .make(std::span(missing).subspan(first, last - first), share);
      },
      progress);
  SampleFiles out;
  if (!ranks.first()) return out;
  std::vector<std::string> all;
  size_t next = 0;
  for (size_t part = 0; part < folder.run().parts; ++part) {
    const bool made = next < missing.size() && missing[next] == part;
    const std::string origin = fmt::format("{}, part {}", folder.place().string(), part);
    const Json record = made ? parseJson(records[next++], origin) : folder.recordOf(part);
    JsonReader reader(record, origin);
    const auto files = reader.required<std::vector<std::vector<std::string>>>("files");
    for (const auto& ofMotion : files) {
      out.clips.push_back((request.out / ofMotion.front()).string());
      all.insert(all.end(), ofMotion.begin(), ofMotion.end());
    }
    if (made) out.sampled += static_cast<int>(files.size());
    out.fit = together(out.fit, fitFromJson(reader.raw("fit"), origin));
    reader.finish();
  }
  folder.commit(all);
  return out;
}

}  // namespace marey
