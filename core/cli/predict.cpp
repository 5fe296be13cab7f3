// marey predict: goes on with clips from their first frames.
#include <array>
#include <memory>

#include "families.h"
#include "task/pose_error.h"
#include "task/task.h"

#include "base/atomic_file.h"
#include "cli/command.h"
#include "cli/fit_report.h"
#include "cli/readers.h"
#include "experiment/path_choice.h"
#include "experiment/recipe.h"
#include "io/clip_io.h"

namespace marey::cli {
namespace fs = std::filesystem;
namespace {

struct Options {
  std::string model, out, format = "bvh", weights = "float32", path;
  std::vector<std::string> clips;
  io::ReadOptions read;
  TaskRequest task;
};

/// Horizons at which prediction is usually judged, milliseconds.
constexpr std::array kHorizonsMs{80, 160, 320, 400, 560, 1000};

Json errorJson(const PoseError& error, double fps) {
  Json at = Json::object();
  for (const int ms : kHorizonsMs) {
    // Frame 0 of a prediction is one frame after the last that was given.
    const auto frame = static_cast<size_t>(std::max(0L, std::lround(ms * 1e-3 * fps) - 1));
    if (frame < error.byFrameCm.size()) at[std::to_string(ms)] = error.byFrameCm[frame];
  }
  return {{"mean_cm", error.meanCm}, {"best_sample_cm", error.bestCm}, {"at_ms_cm", at}};
}

class Predictor {
 public:
  Predictor(const Options& options, const Context& context)
      : m_options(options),
        m_context(context),
        m_model(loadModel(options.model, modelFamilies(),
                          {.weights = weightPrecisionNamed(options.weights)})),
        m_task(taskNamed("predict")),
        m_request(options.task),
        m_staged(options.out) {
    m_request.seed = context.seed;
    if (!options.path.empty())
      m_request.path =
          requestFor(*m_model, {.path = options.path, .seconds = options.task.seconds}, m_report)
              .path;
  }

  void run() {
    Progress progress = m_context.progress("predict");
    const io::Inputs inputs = io::findInputs(m_options.clips);
    m_report.add(io::InputReport(inputs));
    Progress reading = progress.part(0.0, 0.1);
    const auto clips = readAll(inputs, m_options.read, m_report, reading);
    for (size_t i = 0; i < clips.size(); ++i) {
      Progress part = progress.part(0.1 + 0.9 * static_cast<double>(i) / clips.size(),
                                    0.1 + 0.9 * (i + 1.0) / clips.size());
      predict(clips[i], part);
    }
    m_staged.commit();
    print();
  }

 private:
  void predict(const Clip& clip, Progress& progress) {
    m_request.clip = clip;
    const TaskOutcome outcome = runTask(m_task, *m_model, m_request, progress);
    Json entry = {{"clip", clip.source.path.empty() ? clip.name : clip.source.path}};
    for (size_t s = 0; s < outcome.motions.size(); ++s) {
      m_files.push_back(write(outcome.motions[s], clip.name, static_cast<int>(s)));
      entry["files"].push_back(m_files.back());
    }
    if (outcome.reference) {
      const PoseError error = poseError(outcome.motions, *outcome.reference);
      entry["error"] = errorJson(error, m_model->info().features.fps);
      m_sumCm += error.meanCm;
      ++m_judged;
    }
    m_predictions.push_back(std::move(entry));
  }

  std::string write(Clip motion, const std::string& of, int sample) {
    motion.name = fmt::format("{}_{:03}", of, sample);
    io::WriteOptions options{.format = m_options.format};
    options.recipe =
        motionRecipe({}, SampleOrigin{m_model->info().hash, m_request.seed, m_request.temperature});
    options.recipe["command"] = m_context.commandLine;
    options.recipe["sample"] = sample;
    options.recipe["continues"] = of;
    const std::string file = motion.name + "." + m_options.format;
    const io::WrittenClip written = io::writeClip(motion, m_staged.path() / file, options);
    m_fits.add(written.fit);
    return (fs::path(m_options.out) / file).string();
  }

  void print() {
    Json result = {{"clips", m_files}, {"predictions", m_predictions}};
    if (m_judged > 0) result["error"] = {{"mean_cm", m_sumCm / m_judged}, {"clips", m_judged}};
    m_report.addTo(result);
    tell(m_context, m_report);
    m_fits.addTo(result);
    m_fits.tell(m_context);
    std::string text = fmt::format("{} clips continued in {}", m_predictions.size(), m_options.out);
    if (m_judged > 0)
      text += fmt::format("; {:.1f} cm from what really came (mean over joints and frames)",
                          m_sumCm / m_judged);
    m_context.print(result, text);
  }

  const Options& m_options;
  const Context& m_context;
  std::unique_ptr<MotionModel> m_model;
  const Task& m_task;
  TaskRequest m_request;
  io::InputReport m_report;
  StagedFolder m_staged;  ///< all clips or none
  FitReport m_fits;
  std::vector<std::string> m_files;
  Json m_predictions = Json::array();
  double m_sumCm = 0.0;
  int m_judged = 0;
};

}  // namespace

void addPredictCommand(CLI::App& app, Context& context) {
  auto o = std::make_shared<Options>();
  auto* command =
      addCommand(app, context, "predict", "Go on with clips from their first frames",
                 "marey predict model.marey walk.bvh --seed-frames 20 -n 5 --out predicted",
                 [o, &context] { Predictor(*o, context).run(); });
  command->add_option("MODEL", o->model, "Model (.marey)")->required();
  command->add_option("CLIP", o->clips, "Files, folders or @LIST")->required();
  command->add_option("--out", o->out, "Folder to write to")->required();
  command
      ->add_option("--seed-frames", o->task.seedFrames,
                   "Frames of the clip that are given, at the model's rate (0: what it sees)")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--path", o->path,
                      "Where to go: preset:NAME, clip:FILE or a path file (default: the clip's own "
                      "control, and then the error against it)");
  command
      ->add_option("--seconds", o->task.seconds, "Length (default: the rest of the clip or path)")
      ->check(CLI::PositiveNumber);
  command->add_option("-n,--samples", o->task.samples, "Motions for each clip")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--temperature", o->task.temperature, "Factor on the latents")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--format", o->format, "bvh, gltf, glb, npz or csv")
      ->check(CLI::IsMember({"bvh", "gltf", "glb", "npz", "csv"}))
      ->capture_default_str();
  addWeightsOption(*command, o->weights);
  addReadOptions(*command, o->read);
}

}  // namespace marey::cli
