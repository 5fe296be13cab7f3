// marey sample: many motions of one model along a path.
#include <chrono>
#include <memory>

#include "families.h"

#include "base/atomic_file.h"
#include "base/memory.h"
#include "cli/command.h"
#include "cli/fit_report.h"
#include "experiment/path_choice.h"
#include "experiment/recipe.h"
#include "io/clip_io.h"

namespace marey::cli {
namespace {

/// Motions generated at once: bounds the memory, changes no result.
constexpr int kBatch = 128;

struct Options {
  std::string model, out, format = "bvh", start = "mean", weights = "float32";
  PathChoice path;
  int samples = 1;
  double temperature = 1.0, warmUp = 1.0;
};

Json recipe(const Options& o, const MotionModel& model, const Context& context) {
  Json out = motionRecipe({}, SampleOrigin{model.info().hash, context.seed, o.temperature});
  out["command"] = context.commandLine;
  out["model"] = model.info().variant;
  out["path"] = o.path.path;
  out["start"] = o.start;
  out["warm_up_s"] = o.warmUp;
  out["weights"] = o.weights;
  return out;
}

void run(Options& o, const Context& context) {
  o.path.startFromClip = o.start == "clip";
  const auto model =
      loadModel(o.model, modelFamilies(), {.weights = weightPrecisionNamed(o.weights)});
  SampleRequest request = requestFor(*model, o.path);
  request.seed = context.seed;
  request.temperature = o.temperature;
  request.warmUpS = o.warmUp;
  StagedFolder folder(o.out);
  Progress progress = context.progress("sample");
  Json names = Json::array();
  FitReport fits;
  const auto begin = std::chrono::steady_clock::now();
  for (int first = 0; first < o.samples; first += kBatch) {
    request.firstSample = first;
    request.samples = std::min(kBatch, o.samples - first);
    Progress part = progress.part(static_cast<double>(first) / o.samples,
                                  static_cast<double>(first + request.samples) / o.samples);
    for (const Clip& clip : sampleClips(*model, request, part)) {
      Json note = recipe(o, *model, context);
      note["sample"] = clip.name;
      const auto file = clip.name + "." + o.format;
      io::WriteOptions write{.format = o.format};
      write.recipe = note;
      fits.add(io::writeClip(clip, folder.path() / file, write).fit);
      names.push_back((std::filesystem::path(o.out) / file).string());
    }
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  folder.commit();
  const double frames = static_cast<double>(o.samples) * static_cast<double>(request.path.size());
  Json result = {
      {"clips", names},
      {"frames_per_s", frames / seconds},
      {"peak_memory_mb", peakMemoryMb()},
      {"seconds_each", static_cast<double>(request.path.size()) / model->info().features.fps}};
  fits.addTo(result);
  fits.tell(context);
  context.print(result,
                fmt::format("{} motions of {:.1f} s in {} ({:.0f} frames/s)", o.samples,
                            static_cast<double>(request.path.size()) / model->info().features.fps,
                            o.out, frames / seconds));
}

}  // namespace

void addSampleCommand(CLI::App& app, Context& context) {
  auto o = std::make_shared<Options>();
  auto* command =
      addCommand(app, context, "sample", "Sample motions from a model along a path",
                 "marey sample runs/small/best.marey --path preset:turn-left -n 20 --out samples",
                 [o, &context] { run(*o, context); });
  command->add_option("MODEL", o->model, "Model (.marey)")->required();
  command
      ->add_option("--path", o->path.path,
                   "preset:NAME (still, sideways, slow, fast, backward, turn-left, turn-right, "
                   "circle, figure-eight), "
                   "clip:FILE (that clip's own path) or a path file (JSON)")
      ->required();
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
  addWeightsOption(*command, o->weights);
  command->add_option("--format", o->format, "bvh, gltf, glb, npz or csv")
      ->check(CLI::IsMember({"bvh", "gltf", "glb", "npz", "csv"}))
      ->capture_default_str();
}

}  // namespace marey::cli
