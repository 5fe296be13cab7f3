// marey bench sample|score: the engine and the plain path, measured in turn in one process.
#include <memory>

#include "families.h"

#include "base/error.h"
#include "cli/command.h"
#include "model/gradient/model_bench.h"

namespace marey::cli {
namespace {

struct Options {
  ModelBenchSpec spec;
  std::string config, weights = "float32";
  bool noReference = false;
};

using Measure = ModelBenchResult (*)(const ModelBenchSpec&, const ModelFamily&, Progress&);

void run(Options& o, const Context& context, const std::string& what, Measure measure) {
  o.spec.config = readJson(o.config);
  o.spec.origin = o.config;
  o.spec.seed = context.seed;
  o.spec.reference = !o.noReference;
  o.spec.weights = weightPrecisionNamed(o.weights);
  const ModelFamily& family = familyOf(o.spec.config, modelFamilies(), o.config);
  Progress progress = context.progress("bench " + what);
  const ModelBenchResult r = measure(o.spec, family, progress);
  const double frames = o.spec.batch * 1000.0 / r.msPerFrame;
  Json result = {{"ms_per_frame", r.msPerFrame},
                 {"best_ms_per_frame", r.bestMsPerFrame},
                 {"frames_per_s", frames},
                 {"batch", o.spec.batch},
                 {"frames", o.spec.frames},
                 {"parameters", r.parameters},
                 {"weights", o.weights},
                 {"gflops", r.gflops},
                 {"sgemm_gflops", r.sgemmGflops},
                 {"share_of_sgemm", r.gflops / r.sgemmGflops},
                 {"weight_gb_s", r.weightGbPerS},
                 {"read_gb_s", r.readGbPerS},
                 {"share_of_read", r.weightGbPerS / r.readGbPerS}};
  std::string text = fmt::format(
      "{} of {} motions, {:.2f} M parameters in {}: {:.3f} ms a frame (best {:.3f}), {:.0f} "
      "frames/s\n{:.1f} GFLOP/s of {:.1f} that a large matrix product reaches ({:.0f} %); weights "
      "read at {:.1f} GB/s of {:.1f} ({:.0f} %)",
      what, o.spec.batch, static_cast<double>(r.parameters) / 1e6, o.weights, r.msPerFrame,
      r.bestMsPerFrame, frames, r.gflops, r.sgemmGflops, 100.0 * r.gflops / r.sgemmGflops,
      r.weightGbPerS, r.readGbPerS, 100.0 * r.weightGbPerS / r.readGbPerS);
  if (what == "sample") {
    result["first_ms_per_frame"] = r.firstMsPerFrame;
    result["last_ms_per_frame"] = r.lastMsPerFrame;
    text += fmt::format("\nfirst third of the frames {:.3f} ms each, last third {:.3f} ms",
                        r.firstMsPerFrame, r.lastMsPerFrame);
  }
  if (o.spec.reference) {
    const double ratio = r.referenceMsPerFrame / r.msPerFrame;
    result["reference_ms_per_frame"] = r.referenceMsPerFrame;
    result["ratio"] = ratio;
    result["max_abs_difference"] = r.maxDifference;
    text += fmt::format(
        "\nplain libtorch path: {:.3f} ms a frame, {:.2f} times as long; largest "
        "difference {:.1e}",
        r.referenceMsPerFrame, ratio, r.maxDifference);
  }
  context.print(result, text);
}

void addOne(CLI::App& bench, Context& context, const std::string& name, const std::string& summary,
            const std::string& batch, Measure measure) {
  auto o = std::make_shared<Options>();
  auto* command =
      addCommand(bench, context, name, summary,
                 "marey bench " + name + " --config resources/models/mg-a.json --batch 20",
                 [o, &context, name, measure] { run(*o, context, name, measure); });
  command->add_option("--config", o->config, "Hyper-parameters (JSON); weights are random")
      ->required();
  command->add_option("--batch", o->spec.batch, batch)
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--frames", o->spec.frames, "Frames of each")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  addWeightsOption(*command, o->weights);
  command->add_flag("--no-reference", o->noReference, "Leave the plain path out");
}

}  // namespace

void addModelBenchCommands(CLI::App& bench, Context& context) {
  addOne(bench, context, "sample", "How fast motions are sampled", "Motions that advance together",
         benchSample);
  addOne(bench, context, "score", "How fast clips are scored", "Clips scored together", benchScore);
}

}  // namespace marey::cli
