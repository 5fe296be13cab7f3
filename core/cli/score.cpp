// marey score: log-likelihood of every frame of clips under a model.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <numeric>
#include <span>

#include "families.h"

#include "cli/command.h"
#include "cli/readers.h"
#include "experiment/packed_motion.h"
#include "io/annotation_files.h"
#include "model/likelihood.h"
#include "model/pose_units.h"

namespace marey::cli {
namespace {

struct Options {
  std::string model, weights = "float32";
  std::vector<std::string> clips;
  bool standardised = false;
  io::ReadOptions read;
};

/// Clips read before they are scored together.
constexpr size_t kTogether = 64;

std::string unitOf(const ModelInfo& info, bool standardised) {
  return standardised || info.standardiser.empty() ? kStandardisedUnit : likelihoodUnit(info);
}

/// The scored clips.
class Scores {
 public:
  Scores(const ModelInfo& info, bool standardised)
      : m_info(info), m_unit(unitOf(info, standardised)) {}

  void add(ClipScore score) { m_scores.push_back(std::move(score)); }

  Json json() const {
    Json clips = Json::array();
    for (const ClipScore& score : m_scores)
      if (!score.tooShort()) clips.push_back(clipJson(score));
    const LikelihoodSummary s = summary();
    const double mean = s.nats;
    Json out = {
        {"clips", std::move(clips)},
        {"kind", nameOf(m_info.density)},
        {"unit", m_unit},
        {"frames", s.frames},
        {"first_frame", s.firstFrame},
        {"mean_nats_per_frame", finiteOrNull(mean)},
        {"linear_gaussian_nats_per_frame", finiteOrNull(s.linearGaussian)},
        {"observation_floor_mm",
         m_info.observation.none() ? Json() : Json(m_info.observation.floorMm())},
        {"observation_floor", m_info.observation.none() ? Json() : Json(floorSizeText(m_info))},
        {"observation_draws", m_info.observation.draws},
        {"pose_dim", m_info.poseDim},
        {"floor_directions", finiteOrNull(s.floorDirections)},
        {"effective_dimensions", finiteOrNull(s.effectiveDimensions)},
        {"nats_per_effective_dimension", finiteOrNull(mean / s.effectiveDimensions)},
        {"floor", floorText(m_info)}};
    if (m_unit != kStandardisedUnit && allLengths(m_info))
      out["mean_nats_per_frame_cm"] = finiteOrNull(mean);
    out["too_short"] = Json::array();
    for (const ShortClip& clip : s.tooShort)
      out["too_short"].push_back(
          {{"name", clip.name}, {"frames", clip.frames}, {"needed", clip.needed}});
    return out;
  }

  std::string table() const {
    std::string out = fmt::format("{}\n{:<44} {:>7} {:>12} {:>10} {:>8}\n", m_unit, "clip",
                                  "frames", "nats/frame", "bits/dim", "|z|");
    for (const ClipScore& score : m_scores)
      if (!score.tooShort())
        out += fmt::format("{:<44} {:>7} {:>12.2f} {:>10.3f} {:>8.2f}\n", score.name,
                           score.loglikNats.size(), score.meanNatsPerFrame(),
                           score.bitsPerDimension, meanOf(score.latentNorm));
    const LikelihoodSummary s = summary();
    const double mean = s.nats;
    out += fmt::format("all: {:.2f} {}", mean, m_unit);
    if (std::isfinite(s.effectiveDimensions))
      out += fmt::format("; {:.2f} per effective dimension ({:.0f} of {}, the others on the floor)",
                         mean / s.effectiveDimensions, s.effectiveDimensions, m_info.poseDim);
    if (std::isfinite(s.linearGaussian))
      out += fmt::format("\nlinear-Gaussian autoregression, same training data and frames: {:.2f}",
                         s.linearGaussian);
    out += "\n" + floorText(m_info);
    if (!s.tooShort.empty()) out += "\n" + tooShortText(s);
    return out;
  }

  /// Throws InputError where not one clip could be scored.
  void requireSome() const {
    const LikelihoodSummary s = summary();
    if (s.clips > 0 || s.tooShort.empty()) return;
    throwInput({.path = s.tooShort.front().name},
               fmt::format("more than {} frames at {} per second (the model's context)",
                           m_info.context, m_info.features.fps),
               "{}{}", s.tooShort.front().frames,
               s.tooShort.size() > 1 ? ", and no longer clip among the others" : "");
  }

 private:
  LikelihoodSummary summary() const { return summarise(m_info, m_scores, m_info.context); }
  static double meanOf(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  }

  /// The least likely frame, and the joint that stands out in it.
  Json worstJson(const ClipScore& score) const {
    const auto worst = std::min_element(score.loglikNats.begin(), score.loglikNats.end());
    const auto index = static_cast<size_t>(worst - score.loglikNats.begin());
    Json out = {{"frame", score.firstFrame + static_cast<int>(index)}, {"nats", *worst}};
    if (!score.oddestJoint.empty())
      out["joint"] = m_info.skeleton->names[static_cast<size_t>(score.oddestJoint[index])];
    return out;
  }

  Json clipJson(const ClipScore& score) const {
    Json out = {{"name", score.name},
                {"first_frame", score.firstFrame},
                {"loglik_nats", score.loglikNats},
                {"mean_nats_per_frame", score.meanNatsPerFrame()},
                {"bits_per_dimension", score.bitsPerDimension},
                {"latent_norm", score.latentNorm},
                {"worst", worstJson(score)}};
    if (!score.linearGaussianNats.empty()) out["linear_gaussian_nats"] = score.linearGaussianNats;
    return out;
  }

  const ModelInfo& m_info;
  std::string m_unit;
  std::vector<ClipScore> m_scores;
};

/// Clips of another skeleton than the model's are left out: the others are worth scoring.
void leaveOthersOut(const ModelInfo& info, std::vector<Clip>& clips, io::InputReport& report) {
  std::erase_if(clips, [&](const Clip& clip) {
    std::string why = whyNotScored(info, clip);
    if (why.empty()) return false;
    report.leaveOut(clip, std::move(why));
    return true;
  });
}

/// The scores of files [first, last), packed file by file. Clips are read as they are scored.
std::vector<std::string> scoreShare(const Options& o, const MotionModel& model,
                                    std::span<const io::InputFile> files, Progress& progress) {
  std::vector<std::string> out;
  std::vector<Clip> waiting;
  std::vector<size_t> clipsOf;  // of every file that waits
  std::vector<io::InputReport> reports;
  double done = 0.0;
  for (size_t i = 0; i < files.size(); ++i) {
    progress.throwIfCancelled();
    std::vector<Clip> clips = reports.emplace_back().read(files[i], o.read);
    reports.back().throwIfFailed();
    leaveOthersOut(model.info(), clips, reports.back());
    io::readSignals(clips, model.info().features.control);
    for (const Clip& clip : clips) reports.back().resample(clip, model.info().features.fps);
    clipsOf.push_back(clips.size());
    std::move(clips.begin(), clips.end(), std::back_inserter(waiting));
    if (waiting.size() < kTogether && i + 1 < files.size()) continue;
    const double share = static_cast<double>(i + 1) / static_cast<double>(files.size());
    Progress part = progress.part(done, share);
    const auto scores = scoreClips(model, waiting, o.standardised, part);
    auto next = scores.begin();
    for (size_t file = 0; file < clipsOf.size(); ++file) {
      Packer packer;
      reports[file].pack(packer);
      for (size_t k = 0; k < clipsOf[file]; ++k) pack(*next++, packer);
      out.push_back(packer.take());
    }
    waiting.clear();
    clipsOf.clear();
    reports.clear();
    done = share;
    progress.report(done, "scoring");
  }
  return out;
}

Scores scoreFiles(const Options& o, const MotionModel& model, const Context& context,
                  io::InputReport& report) {
  Progress progress = context.progress("score");
  const io::Inputs inputs = io::findInputs(o.clips);
  report = io::InputReport(inputs);
  const std::vector<io::InputFile>& files = inputs.files;
  const auto packed = context.ranks->gather(
      files.size(),
      [&](size_t first, size_t last, Progress& share) {
        return scoreShare(o, model, std::span(files).subspan(first, last - first), share);
      },
      progress);
  Scores out(model.info(), o.standardised);
  size_t clips = 0;
  for (const std::string& file : packed) {
    Unpacker bytes(file);
    report.add(io::InputReport::unpacked(bytes));
    for (; !bytes.done(); ++clips) out.add(unpackScore(bytes));
  }
  if (context.ranks->first()) report.throwIfNone(clips);
  return out;
}

void run(const Options& o, const Context& context) {
  const auto model =
      loadModel(o.model, modelFamilies(), {.weights = weightPrecisionNamed(o.weights)});
  requireDensity(*model);
  io::InputReport report;
  const Scores scores = scoreFiles(o, *model, context, report);
  if (!context.ranks->first()) return;
  scores.requireSome();
  Json result = context.json ? scores.json() : Json::object();
  report.addTo(result);
  tell(context, report);
  context.print(result, context.json ? std::string() : scores.table());
}

}  // namespace

void addScoreCommand(CLI::App& app, Context& context) {
  auto o = std::make_shared<Options>();
  auto* command = addCommand(
      app, context, "score", "Log-likelihood per frame of clips under a model",
      "marey score runs/small/best.marey @clips/test.txt --json",
      [o, &context] { run(*o, context); }, Processes::Many);
  command->add_option("MODEL", o->model, "Model (.marey)")->required();
  command->add_option("CLIP", o->clips, "Files, folders or @LIST")->required();
  command->add_flag("--standardised", o->standardised,
                    "Leave the standardiser's log-determinant out");
  addWeightsOption(*command, o->weights);
  addReadOptions(*command, o->read);
}

}  // namespace marey::cli
