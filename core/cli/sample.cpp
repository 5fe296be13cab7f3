// marey sample: many motions of one model along a path.
#include <chrono>
#include <cstdio>
#include <memory>

#include "families.h"
#include "ranks/launch.h"

#include "base/memory.h"
#include "cli/command.h"
#include "cli/control_options.h"
#include "cli/fit_report.h"
#include "cli/readers.h"
#include "experiment/path_choice.h"
#include "experiment/recipe.h"
#include "experiment/sample_files.h"
#include "model/training_pace.h"

namespace marey::cli {
namespace {

struct Options {
  std::string model, out, format = "bvh", start = "mean", weights = "float32";
  PathChoice path;
  ControlAsked control;
  int samples = 1;
  bool resume = false;
  double temperature = 1.0, warmUp = 1.0;
  OptionValues options;
};

Json recipe(const Options& o, const MotionModel& model, const Context& context) {
  Json out =
      motionRecipe({}, SampleOrigin{model.info().hash, context.seed, o.temperature, o.options});
  out["command"] = context.commandLine;
  out["model"] = model.info().variant;
  out["path"] = o.path.path;
  addTo(out, o.path.control);
  out["start"] = o.start;
  out["warm_up_s"] = o.warmUp;
  out["weights"] = o.weights;
  return out;
}

/// What a failed run leaves behind, unless it had finished nothing.
void tellOnFailure(const UnfinishedFolder& folder, Context& context) {
  context.ranks->whenStopped([place = folder.place().string()] {
    fmt::print(stderr, "marey: stopping; motions that are finished stay in {} for --resume\n",
               place);
  });
  context.afterFailure = [folder]() -> std::string {
    const size_t finished = folder.abandon();
    if (finished == 0) return "";
    return fmt::format(
        " ({} of {} parts of {} motions are finished in {}: --resume goes on with it)", finished,
        folder.run().parts, kMotionsOfPart, folder.place().string());
  };
}

void run(Options& o, Context& context) {
  o.path.startFromClip = o.start == "clip";
  const auto model =
      loadModel(o.model, modelFamilies(), {.weights = weightPrecisionNamed(o.weights)});
  o.path.control = choiceOf(o.control, model->info().features.control);
  io::InputReport report;
  SampleRequest request = requestFor(*model, o.path, report);
  request.samples = o.samples;
  request.seed = context.seed;
  request.temperature = o.temperature;
  request.options = o.options;
  request.warmUpS = o.warmUp;
  SampleFilesRequest files{.sampling = request,
                           .out = o.out,
                           .format = o.format,
                           .recipe = recipe(o, *model, context),
                           .writers = context.threads > 0 ? context.threads : coresOfThisProcess(),
                           .resume = o.resume};
  const double fps = model->info().features.fps;
  const std::string warning = standingWarning(
      o.model, trainingPaceOf(model->info().provenance, o.model), request.path, fps);
  if (!warning.empty()) report.add({o.path.path, "", "standing", warning});
  tell(context, report);
  Progress progress = context.progress("sample");
  const auto begin = std::chrono::steady_clock::now();
  const SampleFiles written = writeSampleFiles(
      *model, files, *context.ranks, progress,
      [&context](const UnfinishedFolder& folder) { tellOnFailure(folder, context); });
  if (!context.ranks->first()) return;
  context.afterFailure = {};
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  FitReport fits;
  fits.add(written.fit);
  const double frames =
      static_cast<double>(written.sampled) * static_cast<double>(request.path.size());
  Json result = {{"clips", written.clips},
                 {"frames_per_s", frames / seconds},
                 {"peak_memory_mb", peakMemoryMb()},
                 {"seconds_each", static_cast<double>(request.path.size()) / fps}};
  fits.addTo(result);
  report.addTo(result);
  fits.tell(context);
  context.print(
      result, fmt::format("{} motions of {:.1f} s in {} ({:.0f} frames/s)", o.samples,
                          static_cast<double>(request.path.size()) / fps, o.out, frames / seconds));
}

}  // namespace

void addSampleCommand(CLI::App& app, Context& context) {
  auto o = std::make_shared<Options>();
  auto* command = addCommand(
      app, context, "sample", "Sample motions from a model along a path",
      "marey sample runs/small/best.marey --path preset:turn-left -n 20 --out samples",
      [o, &context] { run(*o, context); }, Processes::Many);
  command->add_option("MODEL", o->model, "Model (.marey)")->required();
  command
      ->add_option("--path", o->path.path,
                   "preset:NAME (still, sideways, slow, fast, backward, turn-left, turn-right, "
                   "circle, figure-eight), "
                   "clip:FILE (that clip's own path) or a path file (JSON, or CSV with time,x,z)")
      ->required();
  addControlAsked(*command, o->control);
  command->add_option("-n,--samples", o->samples, "Number of motions")
      ->check(CLI::Range(1, 10000000))
      ->capture_default_str();
  command->add_option("--out", o->out, "Folder to write to")->required();
  command
      ->add_option("--seconds", o->path.seconds,
                   "Length (default: 10 s of a preset, all of a clip or path)")
      ->check(CLI::PositiveNumber);
  command->add_option("--temperature", o->temperature, "Factor on the latents")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  addModelOptions(*command, o->temperature, o->options);
  command
      ->add_option("--start", o->start,
                   "mean (the mean pose and a warm-up) or clip (the clip's first frames)")
      ->check(CLI::IsMember({"mean", "clip"}))
      ->capture_default_str();
  command
      ->add_option("--warm-up", o->warmUp,
                   "Seconds generated and dropped after a start from the mean pose")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_flag("--resume", o->resume,
                    "Go on with a broken run of the same command (OUT.partial)");
  addWeightsOption(*command, o->weights);
  command->add_option("--format", o->format, "bvh, gltf, glb, npz or csv")
      ->check(CLI::IsMember({"bvh", "gltf", "glb", "npz", "csv"}))
      ->capture_default_str();
}

}  // namespace marey::cli
