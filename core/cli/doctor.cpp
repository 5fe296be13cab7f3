#include "io/doctor.h"

#include <algorithm>
#include <memory>

#include "base/error.h"
#include "cli/command.h"
#include "cli/readers.h"

namespace marey::cli {
namespace {

struct DoctorOptions {
  std::vector<std::string> inputs;
  io::ReadOptions read;
};

bool unreadable(const io::DoctorReport& report) {
  return std::any_of(report.faults.begin(), report.faults.end(),
                     [](const io::Fault& f) { return f.kind == "unreadable"; });
}

void runDoctor(const Context& context, const DoctorOptions& options) {
  const io::Inputs inputs = io::findInputs(options.inputs);
  const io::InputReport others(inputs);
  const std::vector<std::filesystem::path> files = inputs.paths();
  Progress progress = context.progress("examining");
  Json result = {{"files", Json::array()}};
  std::string text, firstFailure;
  int failures = 0;
  for (size_t i = 0; i < files.size(); ++i) {
    progress.throwIfCancelled();
    for (const io::DoctorReport& report : io::examine(files[i], options.read)) {
      result["files"].push_back(io::toJson(report));
      text += io::toText(report);
      if (unreadable(report) && failures++ == 0) firstFailure = report.faults.front().evidence;
    }
    progress.report(static_cast<double>(i + 1) / static_cast<double>(files.size()));
  }
  others.addTo(result);
  tell(context, others);
  context.print(result, text);
  if (failures == 1) throw InputError(firstFailure);
  if (failures > 1)
    throw InputError(fmt::format("{} of {} files cannot be read; the first: {}", failures,
                                 files.size(), firstFailure));
}

}  // namespace

void addDoctorCommand(CLI::App& app, Context& context) {
  auto options = std::make_shared<DoctorOptions>();
  CLI::App* command = addCommand(
      app, context, "doctor", "What a motion file is and what is wrong with it",
      "marey doctor walk.bvh --json", [&context, options] { runDoctor(context, *options); });
  command->add_option("inputs", options->inputs, "motion files, folders or @LIST")->required();
  addReadOptions(*command, options->read);
  command->add_option("--asf", options->read.asf, "skeleton of AMC files");
}

}  // namespace marey::cli
