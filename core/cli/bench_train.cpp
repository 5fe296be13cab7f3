// marey bench train: whole steps of training on the fast path and on the plain one, in turn.
#include <memory>

#include "families.h"

#include "cli/command.h"
#include "model/gradient/train_bench.h"

namespace marey::cli {
namespace {

struct Options {
  TrainBenchSpec spec;
  std::string config;
  bool noReference = false;
};

void run(Options& o, const Context& context) {
  o.spec.config = readJson(o.config);
  o.spec.origin = o.config;
  o.spec.seed = context.seed;
  o.spec.reference = !o.noReference;
  const ModelFamily& family = familyOf(o.spec.config, modelFamilies(), o.config);
  Progress progress = context.progress("bench train");
  const TrainBenchResult r = benchTrain(o.spec, family, progress);
  const double frames = o.spec.batch * o.spec.frames * 1000.0 / r.msPerStep;
  Json result = {{"ms_per_step", r.msPerStep},
                 {"best_ms_per_step", r.bestMsPerStep},
                 {"ms_per_frame", r.msPerStep / o.spec.frames},
                 {"frames_per_s", frames},
                 {"batch", o.spec.batch},
                 {"frames", o.spec.frames},
                 {"parameters", r.parameters},
                 {"loss_nats_per_frame", r.lossNats},
                 {"gflops", r.gflops},
                 {"sgemm_gflops", r.sgemmGflops},
                 {"share_of_sgemm", r.gflops / r.sgemmGflops}};
  std::string text = fmt::format(
      "train on {} windows of {} frames, {:.2f} M parameters: {:.1f} ms a step (best {:.1f}), "
      "{:.0f} frames/s\n{:.1f} GFLOP/s, all gradients counted, of {:.1f} that a large matrix "
      "product reaches ({:.0f} %)",
      o.spec.batch, o.spec.frames, static_cast<double>(r.parameters) / 1e6, r.msPerStep,
      r.bestMsPerStep, frames, r.gflops, r.sgemmGflops, 100.0 * r.gflops / r.sgemmGflops);
  if (o.spec.reference) {
    const double ratio = r.referenceMsPerStep / r.msPerStep;
    result["reference_ms_per_step"] = r.referenceMsPerStep;
    result["best_reference_ms_per_step"] = r.bestReferenceMsPerStep;
    result["reference_ms_per_frame"] = r.referenceMsPerStep / o.spec.frames;
    result["ratio"] = ratio;
    result["max_abs_difference"] = r.maxDifference;
    text += fmt::format(
        "\nplain libtorch path: {:.1f} ms a step (best {:.1f}), {:.2f} times as long; the losses "
        "of the first step differ by {:.1e} nats per frame",
        r.referenceMsPerStep, r.bestReferenceMsPerStep, ratio, r.maxDifference);
  }
  context.print(result, text);
}

}  // namespace

void addTrainBenchCommand(CLI::App& bench, Context& context) {
  auto o = std::make_shared<Options>();
  auto* command =
      addCommand(bench, context, "train", "How fast a step of training is",
                 "marey bench train --config resources/models/mg-a.json --batch 100 --frames 70",
                 [o, &context] { run(*o, context); });
  const auto number = [&](const char* name, int& value, const char* help) {
    command->add_option(name, value, help)->check(CLI::Range(1, 100000))->capture_default_str();
  };
  command->add_option("--config", o->config, "Hyper-parameters (JSON); weights are random")
      ->required();
  number("--batch", o->spec.batch, "Windows of a step");
  number("--frames", o->spec.frames, "Frames scored in each");
  number("--steps", o->spec.steps, "Steps measured on each path");
  command->add_flag("--no-reference", o->noReference, "Leave the plain path out");
}

}  // namespace marey::cli
