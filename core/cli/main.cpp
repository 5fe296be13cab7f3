// marey: the command line. One file per command; this one parses, runs and turns errors into
// exit codes (0 done, 1 failed, 2 wrong usage).
#include <cstdio>
#include <exception>

#include <fmt/format.h>

#include "cli/command.h"
#include "nn/threads.h"

namespace {

using namespace marey::cli;

void addCommands(CLI::App& app, Context& context) {
#ifdef MAREY_TRAIN_ONLY
  addTrainCommand(app, context);
#else
  addDemoCommand(app, context);
  addDoctorCommand(app, context);
  addConvertCommand(app, context);
  addPrepareCommand(app, context);
  addTrainCommand(app, context);
  addSampleCommand(app, context);
  addScoreCommand(app, context);
  addAnalyzeCommand(app, context);
  addReportCommand(app, context);
  addRenderCommand(app, context);
  addModelCommand(app, context);
  addBenchCommand(app, context);
#endif
}

int fail(int status, const char* what) {
  fmt::print(stderr, "marey: {}\n", what);
  return status;
}

std::string joined(int argc, char** argv) {
  std::string out = "marey";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    out += word.find(' ') == std::string::npos ? " " + word : " '" + word + "'";
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  Context context;
  context.commandLine = joined(argc, argv);
  CLI::App app("Marey: a workbench for generative motion models", "marey");
  app.set_version_flag("--version", "marey " MAREY_VERSION);
  app.require_subcommand(1);
  addCommands(app, context);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  try {
    marey::nn::configureThreads(context.threads, context.quiet);
    context.run();
    return 0;
  } catch (const marey::UsageError& e) {
    return fail(2, e.what());
  } catch (const std::exception& e) {
    return fail(1, e.what());
  }
}
