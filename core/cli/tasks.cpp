// A command for every task that has one: marey steer, predict, complete, denoise.
#include <algorithm>
#include <cctype>
#include <memory>

#include "families.h"
#include "task/commands_file.h"
#include "task/pose_error.h"
#include "task/task.h"

#include "base/atomic_file.h"
#include "cli/command.h"
#include "cli/control_options.h"
#include "cli/fit_report.h"
#include "cli/readers.h"
#include "experiment/path_choice.h"
#include "experiment/recipe.h"
#include "io/annotation_files.h"
#include "io/clip_io.h"

namespace marey::cli {
namespace fs = std::filesystem;
namespace {

struct Options {
  std::string model, out, format = "bvh", weights = "float32", path;
  std::vector<std::string> inputs;  ///< clips, or a file of commands
  io::ReadOptions read;
  TaskRequest task;
  ControlAsked control;
  std::vector<std::pair<const TaskOption*, std::string>> tables;  ///< files to be read
};

Json errorJson(const PoseError& error, double fps) {
  Json at = Json::object();
  for (const auto& [ms, cm] : errorsAtHorizons(error, fps)) at[std::to_string(ms)] = cm;
  return {{"mean_cm", error.meanCm}, {"best_sample_cm", error.bestCm}, {"at_ms_cm", at}};
}

class Runner {
 public:
  Runner(const Task& task, const Options& options, const Context& context)
      : m_options(options),
        m_context(context),
        m_model(loadModel(options.model, modelFamilies(),
                          {.weights = weightPrecisionNamed(options.weights)})),
        m_task(task),
        m_request(options.task),
        m_staged(options.out) {
    if (const std::string why = task.whyNot(*m_model); !why.empty())
      throw InputError({.path = options.model}, "a model that can " + task.name, why);
    m_request.seed = context.seed;
    for (const auto& [option, file] : options.tables) option->table(m_request, tableOf(file));
    askControl();
  }

  void run() {
    Progress progress = m_context.progress(m_task.name);
    if (m_task.from == Task::From::Commands) {
      const fs::path file(m_options.inputs.front());
      m_request.steering = readCommands(file, m_model->info().features.fps);
      m_request.steering->options.leftOut = m_options.control.choice.leftOut;
      apply(file.string(), file.stem().string(), progress);
    } else {
      applyToClips(progress);
    }
    m_staged.commit();
    print();
  }

 private:
  static Matrix tableOf(const std::string& file) {
    const Signal numbers = io::readSignal(file, 1.0);
    return Eigen::Map<const Matrix>(numbers.values.data(), numbers.rows(), numbers.width());
  }

  void applyToClips(Progress& progress) {
    const io::Inputs inputs = io::findInputs(m_options.inputs);
    m_report.add(io::InputReport(inputs));
    Progress reading = progress.part(0.0, 0.1);
    auto clips = readAll(inputs, m_options.read, m_report, reading);
    io::readSignals(clips, layout());
    for (size_t i = 0; i < clips.size(); ++i) {
      Progress part = progress.part(0.1 + 0.9 * static_cast<double>(i) / clips.size(),
                                    0.1 + 0.9 * (i + 1.0) / clips.size());
      const std::string& path = clips[i].source.path;
      m_request.clip = clips[i];
      apply(path.empty() ? clips[i].name : path, clips[i].name, part);
    }
  }

  /// Of the path, where there is one; else the clip's own, but for what is left out.
  void askControl() {
    const ControlChoice choice = choiceOf(m_options.control, layout());
    if (m_options.path.empty()) {
      if (!choice.type.empty() || !choice.signals.empty() || !choice.body.empty())
        throw UsageError(
            "--type, --control and --body: need a --path (without, the clip's own control counts)");
      m_request.control.leftOut = {choice.leftOut.begin(), choice.leftOut.end()};
      return;
    }
    SampleRequest along = requestFor(
        *m_model, {.path = m_options.path, .seconds = m_options.task.seconds, .control = choice},
        m_report);
    m_request.path = std::move(along.path);
    m_request.control = std::move(along.control);
  }

  const ControlLayout& layout() const { return m_model->info().features.control; }

  void apply(const std::string& input, const std::string& name, Progress& progress) {
    const TaskOutcome outcome = runTask(m_task, *m_model, m_request, progress);
    Json entry = {{"input", input}};
    for (size_t s = 0; s < outcome.motions.size(); ++s) {
      m_files.push_back(write(outcome.motions[s], name, static_cast<int>(s)));
      entry["files"].push_back(m_files.back());
    }
    if (outcome.reference) judge(outcome, entry);
    m_results.push_back(std::move(entry));
  }

  void judge(const TaskOutcome& outcome, Json& entry) {
    const double fps = m_model->info().features.fps;
    const PoseError error = poseError(outcome.motions, *outcome.reference);
    entry["error"] = errorJson(error, fps);
    m_sumCm += error.meanCm;
    ++m_judged;
    if (!outcome.without) return;
    const PoseError without = poseError({&*outcome.without, 1}, *outcome.reference);
    entry["error_without_model"] = errorJson(without, fps);
    m_withoutCm += without.meanCm;
  }

  std::string write(Clip motion, const std::string& of, int sample) {
    motion.name = fmt::format("{}_{:03}", of, sample);
    io::WriteOptions options{.format = m_options.format};
    options.recipe = motionRecipe({}, SampleOrigin{m_model->info().hash, m_request.seed,
                                                   m_request.temperature, m_request.options});
    options.recipe["command"] = m_context.commandLine;
    options.recipe["task"] = m_task.name;
    options.recipe["sample"] = sample;
    options.recipe["of"] = of;
    const std::string file = motion.name + "." + m_options.format;
    const io::WrittenClip written = io::writeClip(motion, m_staged.path() / file, options);
    m_fits.add(written.fit);
    return (fs::path(m_options.out) / file).string();
  }

  void print() {
    Json result = {{"clips", m_files}, {"results", m_results}};
    std::string text = fmt::format("{} {} in {}", m_results.size(), m_task.done, m_options.out);
    if (m_judged > 0) {
      result["error"] = {{"mean_cm", m_sumCm / m_judged},
                         {"without_model_cm", m_withoutCm / m_judged},
                         {"clips", m_judged}};
      text += fmt::format(
          "; {:.1f} cm from what really came (mean over joints and frames), where {} is {:.1f} cm "
          "off",
          m_sumCm / m_judged, m_task.without, m_withoutCm / m_judged);
    }
    m_report.addTo(result);
    tell(m_context, m_report);
    m_fits.addTo(result);
    m_fits.tell(m_context);
    m_context.print(result, text);
  }

  const Options& m_options;
  const Context& m_context;
  std::unique_ptr<MotionModel> m_model;
  const Task& m_task;
  TaskRequest m_request;
  io::InputReport m_report;
  StagedFolder m_staged;  ///< all motions or none
  FitReport m_fits;
  std::vector<std::string> m_files;
  Json m_results = Json::array();
  double m_sumCm = 0.0, m_withoutCm = 0.0;
  int m_judged = 0;
};

/// "seed_frames" -> "--seed-frames".
std::string optionName(const TaskOption& option) {
  std::string out = option.name;
  std::replace(out.begin(), out.end(), '_', '-');
  return "--" + out;
}

void addTaskOption(CLI::App& command, const TaskOption& option, Options& o) {
  if (option.table) {
    command.add_option_function<std::string>(
        optionName(option),
        [&o, &option](const std::string& file) { o.tables.emplace_back(&option, file); },
        option.help);
    return;
  }
  const auto set = [&o, &option](double value) { option.number(o.task, value); };
  auto* added = command.add_option_function<double>(optionName(option), set, option.help);
  added->check(CLI::Range(option.least, 1e9));
  if (option.whole) added->check(CLI::TypeValidator<int>("INT"));
}

void addTaskCommand(CLI::App& app, Context& context, const Task& task) {
  auto o = std::make_shared<Options>();
  std::string summary = task.title;
  summary[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(summary[0])));
  auto* command = addCommand(app, context, task.name, summary,
                             fmt::format("marey {} model.marey {}", task.name, task.example),
                             [o, &task, &context] { Runner(task, *o, context).run(); });
  command->add_option("MODEL", o->model, "Model (.marey)")->required();
  const bool commands = task.from == Task::From::Commands;
  auto* input = command->add_option(
      commands ? "COMMANDS" : "CLIP", o->inputs,
      commands ? "File of commands: CSV with time, forward, sideways (m/s), turn_deg, facing_deg, "
                 "type, or JSON of a recipe's steering"
               : "Files, folders or @LIST");
  input->required();
  if (commands) input->expected(1);
  command->add_option("--out", o->out, "Folder to write to")->required();
  for (const TaskOption& option : task.options) addTaskOption(*command, option, *o);
  if (task.takesPath) {
    command->add_option("--path", o->path,
                        "Where to go: preset:NAME, clip:FILE or a path file (default: the clip's "
                        "own control, and then the error against it)");
    addControlAsked(*command, o->control);
  } else {
    addLeftOut(*command, o->control);
  }
  command->add_option("-n,--samples", o->task.samples, "Motions for each input")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--temperature", o->task.temperature, "Factor on the latents")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  addModelOptions(*command, o->task.temperature, o->task.options);
  command->add_option("--format", o->format, "bvh, gltf, glb, npz or csv")
      ->check(CLI::IsMember({"bvh", "gltf", "glb", "npz", "csv"}))
      ->capture_default_str();
  addWeightsOption(*command, o->weights);
  if (!commands) addReadOptions(*command, o->read);
}

}  // namespace

void addTaskCommands(CLI::App& app, Context& context) {
  for (const Task& task : tasks())
    if (task.from != Task::From::Path) addTaskCommand(app, context, task);
}

}  // namespace marey::cli
