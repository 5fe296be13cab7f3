// marey prepare: motion files -> data set.
#include <algorithm>
#include <set>

#include "cli/command.h"
#include "cli/control_options.h"
#include "cli/readers.h"
#include "io/annotation_files.h"
#include "model/data_set.h"
#include "motion/representation/representation.h"

namespace marey::cli {
namespace {

struct Options {
  std::vector<std::string> sources, test;
  std::string out;
  PrepareOptions prepare;
  ControlDeclared control;
  io::ReadOptions read;
};

/// A plain text file of names is meant as a list, with or without its @.
std::string asList(const std::string& input) {
  const std::filesystem::path path(input);
  const bool text = path.extension() == ".txt" && std::filesystem::is_regular_file(path);
  return text && !io::isMotionFile(path) ? "@" + input : input;
}

/// Windows that a trainer with this window and hop cuts.
size_t windowCount(const std::vector<FeatureSequence>& sequences, const PrepareOptions& options) {
  const double fps = options.features.fps;
  return cutWindows(sequences, static_cast<int>(std::lround(options.windowS * fps)),
                    std::max(1, static_cast<int>(std::lround(options.hopS * fps))))
      .size();
}

double secondsOf(const std::vector<Clip>& clips) {
  double sum = 0.0;
  for (const Clip& clip : clips) sum += clip.seconds();
  return sum;
}

/// Clips whose rotations had to be fitted to their positions.
struct Fitted {
  int clips = 0;
  double mostM = 0.0;  ///< how far a joint was moved by that

  std::string text() const {
    return clips == 0 ? std::string()
                      : fmt::format(
                            "\nrotations of {} clips are fitted to their positions (joints "
                            "move by up to {:.1f} cm)",
                            clips, 100.0 * mostM);
  }
};

Fitted fittedOf(const DataSet& data) {
  Fitted out;
  for (const char* part : {"train", "test"})
    for (const Json& source : data.provenance[part])
      if (const double moved = source.value("rotations_fitted_within_m", 0.0); moved > 0.0) {
        ++out.clips;
        out.mostM = std::max(out.mostM, moved);
      }
  return out;
}

Json resultOf(const Options& o, const DataSet& data, const std::vector<Clip>& train,
              const std::vector<Clip>& test) {
  const Fitted fitted = fittedOf(data);
  return {{"train_windows", windowCount(data.train, o.prepare)},
          {"test_windows", windowCount(data.test, o.prepare)},
          {"pose_dim", data.poseDim()},
          {"control_dim", data.controlDim()},
          {"control", toJson(data.options.features.control)},
          {"layout", data.options.features.layout},
          {"rotations_fitted", fitted.clips},
          {"rotations_fitted_within_m", fitted.mostM},
          {"seconds", secondsOf(train) + secondsOf(test)},
          {"train_clips", train.size()},
          {"test_clips", test.size()},
          {"train_seconds", secondsOf(train)},
          {"test_seconds", secondsOf(test)},
          {"out", o.out}};
}

void run(Options& o, const Context& context) {
  io::Inputs train = io::findInputs(o.sources), test;
  if (!o.test.empty()) {
    std::vector<std::string> lists;
    for (const std::string& input : o.test) lists.push_back(asList(input));
    test = io::findInputs(lists);
  }
  // A held-out clip never trains, even where SRC is a folder that holds both.
  std::set<std::filesystem::path> held;
  for (const io::InputFile& file : test.files)
    held.insert(std::filesystem::weakly_canonical(file.path));
  std::erase_if(train.files, [&](const io::InputFile& file) {
    return held.contains(std::filesystem::weakly_canonical(file.path));
  });
  Progress progress = context.progress("prepare");
  Progress reading = progress.part(0.0, 0.5), preparing = progress.part(0.5, 0.9);
  Progress readTrain = reading.part(0.0, 0.9), readTest = reading.part(0.9, 1.0);
  io::InputReport report(train);
  report.add(io::InputReport(test));
  auto trainClips = readAll(train, o.read, report, readTrain);
  auto testClips = readAll(test, o.read, report, readTest);
  o.prepare.features.control = layoutOf(o.control);
  io::readSignals(trainClips, o.prepare.features.control);
  io::readSignals(testClips, o.prepare.features.control);
  for (const auto* clips : {&trainClips, &testClips})
    for (const Clip& clip : *clips) report.resample(clip, o.prepare.features.fps);
  DataSet data = prepareDataSet(trainClips, testClips, o.prepare, preparing);
  data.provenance["command"] = context.commandLine;
  report.addTo(data.provenance);
  writeDataSet(o.out, data);
  progress.report(1.0, "written");
  Json result = resultOf(o, data, trainClips, testClips);
  report.addTo(result);
  tell(context, report);
  context.print(
      result,
      fmt::format("{}: {} training clips ({:.1f} min, {} windows with augmentation), {} test clips "
                  "({:.1f} min, {} windows); {} pose and {} control values per frame at {} fps\n"
                  "control: {}",
                  o.out, trainClips.size(), secondsOf(trainClips) / 60,
                  windowCount(data.train, o.prepare), testClips.size(), secondsOf(testClips) / 60,
                  windowCount(data.test, o.prepare), data.poseDim(), data.controlDim(),
                  o.prepare.features.fps, summaryOf(data.options.features.control)) +
          fittedOf(data).text());
}

}  // namespace

void addPrepareCommand(CLI::App& app, Context& context) {
  auto o = std::make_shared<Options>();
  auto* command =
      addCommand(app, context, "prepare", "Make a data set from motion files",
                 "marey prepare @clips/train.txt --test @clips/test.txt --out walk.marey",
                 [o, &context] { run(*o, context); });
  command->add_option("SRC", o->sources, "Files, folders or @LIST to train on")->required();
  command->add_option("--out", o->out, "Data set to write")->required();
  command->add_option("--test", o->test,
                      "Held-out files, folders or @LIST (a plain list file is read as @LIST)");
  auto& p = o->prepare;
  command->add_option("--fps", p.features.fps, "Frame rate of the model")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--window", p.windowS, "Length of a training window, seconds")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--hop", p.hopS, "From one window to the next, seconds")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_flag("--mirror,!--no-mirror", p.mirror,
                    "Augment with left and right swapped (default on)");
  auto* reverse = command->add_flag("--reverse,!--no-reverse", p.reverse,
                                    "Augment with time reversed (default on, but off with --types "
                                    "and --signal: a walk backwards in time is no walk)");
  addControlDeclared(*command, o->control);
  command->parse_complete_callback([o, reverse] {
    if (o->control.hasTime() && reverse->count() == 0) o->prepare.reverse = false;
  });
  std::string layouts = "What a pose is made of";
  for (const Representation& r : representations())
    layouts += fmt::format("; {}: {}", r.name, r.description);
  command->add_option("--layout", p.features.layout, layouts)->capture_default_str();
  command
      ->add_option("--root-sigma", p.features.rootSigmaS,
                   "Gaussian filter of the root's position, seconds")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      ->add_option("--facing-sigma", p.features.facingSigmaS,
                   "Gaussian filter of the facing, seconds")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  addReadOptions(*command, o->read);
}

}  // namespace marey::cli
