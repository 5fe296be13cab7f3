// marey score: log-likelihood of every frame of clips under a model.
#include <cmath>
#include <memory>

#include "families.h"

#include "cli/command.h"
#include "cli/readers.h"
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
  Json clips = Json::array();
  std::string table = fmt::format("{:<44} {:>7} {:>12} {:>10} {:>8}\n", "clip", "frames",
                                  "nats/frame", "bits/dim", "|z|");
  double sum = 0.0, frames = 0.0;

  void add(const ClipScore& score) {
    const auto count = static_cast<double>(score.latentNorm.size());
    double norm = 0.0;
    for (const double v : score.latentNorm) norm += v / count;
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

Scores scoreFiles(const Options& o, const MotionModel& model, Progress& progress) {
  const auto files = expandInputs(o.clips);
  Scores out;
  std::vector<Clip> waiting;
  double done = 0.0;
  for (size_t i = 0; i < files.size(); ++i) {
    progress.throwIfCancelled();
    for (Clip& clip : io::readClips(files[i], o.read)) waiting.push_back(std::move(clip));
    if (waiting.size() < kTogether && i + 1 < files.size()) continue;
    const double share = static_cast<double>(i + 1) / static_cast<double>(files.size());
    Progress part = progress.part(done, share);
    for (const ClipScore& score : scoreClips(model, waiting, o.standardised, part)) out.add(score);
    waiting.clear();
    done = share;
    progress.report(done, "scoring");
  }
  return out;
}

void run(const Options& o, const Context& context) {
  const auto model =
      loadModel(o.model, modelFamilies(), {.weights = weightPrecisionNamed(o.weights)});
  // A density per metre becomes one per centimetre, the unit of the tables.
  const double toCentimetres = model->info().poseDim * std::log(100.0);
  Progress progress = context.progress("score");
  auto [clips, table, sum, frames] = scoreFiles(o, *model, progress);
  const double mean = sum / frames;
  Json result = {{"clips", clips},
                 {"frames", frames},
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
  context.print(result, table);
}

}  // namespace

void addScoreCommand(CLI::App& app, Context& context) {
  auto o = std::make_shared<Options>();
  auto* command =
      addCommand(app, context, "score", "Log-likelihood per frame of clips under a model",
                 "marey score runs/small/best.marey @clips/test.txt --json",
                 [o, &context] { run(*o, context); });
  command->add_option("MODEL", o->model, "Model (.marey)")->required();
  command->add_option("CLIP", o->clips, "Files, folders or @LIST")->required();
  command->add_flag("--standardised", o->standardised,
                    "Leave the standardiser's log-determinant out");
  addWeightsOption(*command, o->weights);
  addReadOptions(*command, o->read);
}

}  // namespace marey::cli
