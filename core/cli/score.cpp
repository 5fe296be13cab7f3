// marey score: log-likelihood of every frame of clips under a model.
#include <cmath>
#include <iterator>
#include <memory>
#include <span>

#include "families.h"

#include "cli/command.h"
#include "cli/readers.h"
#include "experiment/packed_motion.h"
#include "model/scorer.h"

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

/// The rows of the result.
struct Scores {
  explicit Scores(bool wantJson) : json(wantJson) {}
  bool json;  ///< else only the table is made: frame by frame is much
  Json clips = Json::array();
  std::string table = fmt::format("{:<44} {:>7} {:>12} {:>10} {:>8}\n", "clip", "frames",
                                  "nats/frame", "bits/dim", "|z|");
  double sum = 0.0, frames = 0.0;

  void add(const ClipScore& score) {
    const auto count = static_cast<double>(score.latentNorm.size());
    double norm = 0.0;
    for (const double v : score.latentNorm) norm += v / count;
    if (json)
      clips.push_back({{"name", score.name},
                       {"first_frame", score.firstFrame},
                       {"loglik_nats", score.loglikNats},
                       {"mean_nats_per_frame", score.meanNatsPerFrame()},
                       {"bits_per_dimension", score.bitsPerDimension},
                       {"latent_norm", score.latentNorm}});
    table += fmt::format("{:<44} {:>7} {:>12.2f} {:>10.3f} {:>8.2f}\n", score.name,
                         score.loglikNats.size(), score.meanNatsPerFrame(), score.bitsPerDimension,
                         norm);
    sum += score.meanNatsPerFrame() * count;
    frames += count;
  }
};

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
  Scores out(context.json);
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
  // A density per metre becomes one per centimetre, the unit of the tables.
  const double toCentimetres = model->info().poseDim * std::log(100.0);
  io::InputReport report;
  Scores scores = scoreFiles(o, *model, context, report);
  if (!context.ranks->first()) return;
  const double mean = scores.sum / scores.frames;
  std::string& table = scores.table;
  Json result = {{"clips", std::move(scores.clips)},
                 {"frames", scores.frames},
                 {"mean_nats_per_frame", mean},
                 {"density", o.standardised ? "standardised poses" : "poses in metres"}};
  table += fmt::format("all: {:.2f} nats per frame ({})", mean,
                       o.standardised ? "standardised poses" : "poses in metres");
  if (!o.standardised && !model->info().standardiser.empty()) {
    result["mean_nats_per_frame_cm"] = mean - toCentimetres;
    table += fmt::format(", {:.2f} with poses in centimetres", mean - toCentimetres);
  }
  const Json facts = model->info().provenance.value("facts", Json::object());
  if (facts.contains("linear_gaussian_nats_per_frame")) {
    const double floor = facts["linear_gaussian_nats_per_frame"].get<double>();
    result["linear_gaussian_nats_per_frame"] =
        floor + (o.standardised ? 0.0 : model->info().standardiser.logDetPerFrame());
    table += fmt::format("\nlinear-Gaussian model of the training data: {:.2f}",
                         result["linear_gaussian_nats_per_frame"].get<double>());
  }
  report.addTo(result);
  tell(context, report);
  context.print(result, table);
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
