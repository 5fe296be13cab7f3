// marey demo: the main job on the procedural walker and the model that comes with the program.
#include <memory>

#include "base/atomic_file.h"
#include "cli/command.h"
#include "cli/experiment_command.h"
#include "experiment/demo_resources.h"
#include "io/clip_io.h"
#include "motion/walker.h"

namespace marey::cli {
namespace {

struct Options {
  std::string out, data;
  int clips = 200;
  double seconds = 10.0;
  bool pdf = true;
};

/// The walker's clips with their ground truth, to train on or to test with.
void writeWalkerData(const Options& o, const Context& context) {
  StagedFolder folder(o.data);
  Progress progress = context.progress("walker");
  Json truth = Json::array();
  const auto walked = walkerDataSet(o.clips, o.seconds, context.seed);
  for (size_t i = 0; i < walked.size(); ++i) {
    progress.throwIfCancelled();
    const Clip& clip = walked[i].clip;
    Json contacts = Json::array();
    for (const Contact& c : walked[i].truth.contacts)
      contacts.push_back({{"joint", clip.skeleton->names[static_cast<size_t>(c.joint)]},
                          {"begin_s", c.beginS},
                          {"end_s", c.endS}});
    const std::string file = fmt::format("walker_{:04}.bvh", i);
    io::WriteOptions write{.format = "bvh"};
    write.recipe = {{"marey", MAREY_VERSION},
                    {"command", context.commandLine},
                    {"seed", context.seed},
                    {"clip", i}};
    io::writeClip(clip, folder.path() / file, write);
    truth.push_back({{"file", file},
                     {"contacts", contacts},
                     {"step_times_s", walked[i].truth.stepTimesS},
                     {"bone_lengths_m", walked[i].truth.boneLengthsM}});
    progress.report(static_cast<double>(i + 1) / static_cast<double>(walked.size()), "writing");
  }
  writeJson(folder.path() / "truth.json", truth);
  folder.commit();
  context.print({{"clips", walked.size()}, {"folder", o.data}},
                fmt::format("{} clips of {:g} s in {}", walked.size(), o.seconds, o.data));
}

void run(const Options& o, const Context& context) {
  if (o.out.empty() == o.data.empty())
    throw UsageError("demo: give --out DIR (the demonstration) or --write-data DIR, not both");
  if (!o.data.empty()) return writeWalkerData(o, context);
  const std::filesystem::path out(o.out);
  // The document and the model stay beside the report, so that `marey report` repeats it.
  writeFileAtomically(out / "demo.marey", demoModel());
  writeFileAtomically(out / "experiment.json", demoExperiment());
  runReport(readExperiment(out / "experiment.json"), o.out, o.pdf, context);
}

}  // namespace

void addDemoCommand(CLI::App& app, Context& context) {
  auto o = std::make_shared<Options>();
  auto* command = addCommand(app, context, "demo",
                             "Sample from the model that comes with Marey and write a report",
                             "marey demo --out demo", [o, &context] { run(*o, context); });
  command->add_option("--out", o->out, "Folder of the report");
  command->add_flag("--pdf,!--no-pdf", o->pdf,
                    "Also write report.pdf (default on; needs the program weasyprint)");
  command->add_option("--write-data", o->data,
                      "Instead, write clips of the procedural walker to this folder");
  command->add_option("--clips", o->clips, "With --write-data: number of clips")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--clip-seconds", o->seconds, "With --write-data: length of each clip")
      ->check(CLI::Range(0.5, 3600.0))
      ->capture_default_str();
}

}  // namespace marey::cli
