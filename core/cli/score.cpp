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
  std::string model;
  std::vector<std::string> clips;
  bool standardised = false;
  io::ReadOptions read;
};

void run(const Options& o, const Context& context) {
  const auto model = loadModel(o.model, modelFamilies());
  const auto files = expandInputs(o.clips);
  // A density per metre becomes one per centimetre, the unit of the tables.
  const double toCentimetres = model->info().poseDim * std::log(100.0);
  Progress progress = context.progress("score");
  Json clips = Json::array();
  std::string table = fmt::format("{:<44} {:>7} {:>12} {:>10} {:>8}\n", "clip", "frames",
                                  "nats/frame", "bits/dim", "|z|");
  double sum = 0.0, frames = 0.0;
  for (size_t i = 0; i < files.size(); ++i) {
    progress.throwIfCancelled();
    for (const Clip& clip : io::readClips(files[i], o.read)) {
      const ClipScore score = scoreClip(*model, clip, o.standardised);
      double norm = 0.0;
      for (const double v : score.latentNorm)
        norm += v / static_cast<double>(score.latentNorm.size());
      clips.push_back({{"name", score.name},
                       {"first_frame", score.firstFrame},
                       {"loglik_nats", score.loglikNats},
                       {"mean_nats_per_frame", score.meanNatsPerFrame()},
                       {"bits_per_dimension", score.bitsPerDimension},
                       {"latent_norm", score.latentNorm}});
      table += fmt::format("{:<44} {:>7} {:>12.2f} {:>10.3f} {:>8.2f}\n", score.name,
                           score.loglikNats.size(), score.meanNatsPerFrame(),
                           score.bitsPerDimension, norm);
      sum += score.meanNatsPerFrame() * static_cast<double>(score.loglikNats.size());
      frames += static_cast<double>(score.loglikNats.size());
    }
    progress.report(static_cast<double>(i + 1) / static_cast<double>(files.size()), "scoring");
  }
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
  addReadOptions(*command, o->read);
}

}  // namespace marey::cli
