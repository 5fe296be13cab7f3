// marey train: a model from a configuration and a data set.
#include <cmath>
#include <memory>

#include "families.h"

#include "cli/command.h"
#include "model/gradient/build.h"
#include "model/likelihood.h"

namespace marey::cli {
namespace {

struct Options {
  std::string config, data;
  TrainRequest request;
  int64_t steps = 0;
  double minutes = 0.0;
};

Json json(const TrainResult& r) {
  Json out = {{"steps", r.steps},
              {"objective", r.objective.name},
              {"unit", shownUnit(r.objective)},
              {"train", finiteOrNull(r.train)},
              {"valid", finiteOrNull(r.valid)},
              {"best", r.best.string()},
              {"last", r.last.string()}};
  if (!r.objective.likelihood) return out;
  out["train_bits_per_frame"] = finiteOrNull(r.train);
  out["valid_bits_per_frame"] = finiteOrNull(r.valid);
  out["test_nats_per_frame"] = finiteOrNull(r.testNatsPerFrame);
  out["test_unit"] = r.testUnit;
  return out;
}

std::string text(const TrainResult& r) {
  std::string out = fmt::format("{} steps", r.steps);
  if (std::isfinite(r.train))
    out += fmt::format("; {:.4g} {} in training", r.train, shownUnit(r.objective));
  if (std::isfinite(r.valid)) out += fmt::format(", {:.4g} at best in validation", r.valid);
  if (std::isfinite(r.testNatsPerFrame))
    out += fmt::format("; held-out clips {:.1f} {}", r.testNatsPerFrame, r.testUnit);
  return out + "\n" + r.best.string();
}

void run(Options& o, const Context& context) {
  o.request.config = readJson(o.config);
  o.request.configOrigin = o.config;
  JsonReader names(o.request.config, o.config);
  names.required<std::string>("family");
  names.optional<std::string>("name", "");
  o.request.seed = context.seed;
  o.request.command = context.commandLine;
  if (o.steps > 0) o.request.steps = o.steps;
  if (o.minutes > 0.0) o.request.minutes = o.minutes;
  const DataSet data = readDataSet(o.data);
  o.request.process = processRank();
  const bool leads = o.request.process.rank == 0;
  Context own = context;
  own.quiet = context.quiet || !leads;
  Progress progress = own.progress("train");
  const TrainResult result = train(data, o.request, modelFamilies(), progress);
  progress.report(1.0, fmt::format("step {}", result.steps));
  if (!leads) return;
  context.print(json(result), text(result));
}

}  // namespace

void addTrainCommand(CLI::App& app, Context& context) {
  auto o = std::make_shared<Options>();
  auto* command = addCommand(
      app, context, "train", "Train or build a model of a data set",
      "marey train config.json --data walk.marey "
      "--out runs/small --minutes 60",
      [o, &context] { run(*o, context); }, Processes::Own);
  command->add_option("CONFIG", o->config, "Hyper-parameters (JSON)")->required();
  command->add_option("--data", o->data, "Data set made by `marey prepare`")->required();
  command->add_option("--out", o->request.run, "Folder of the run")->required();
  command->add_option("--steps", o->steps, "End at this step (0: as the configuration says)")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--minutes", o->minutes,
                   "End after this much training time, earlier runs included (0: no limit)")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--resume", o->request.resume,
                    "Go on with the run in --out, with the same batches as if unbroken");
  command->add_option("--init", o->request.init, "Start from the weights of this model");
  command->add_option("--device", o->request.device, "cpu or cuda")->capture_default_str();
}

}  // namespace marey::cli
