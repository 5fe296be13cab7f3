// marey: the command line. One file per command; this one parses, runs and turns errors into
// exit codes (0 done, 1 failed, 2 wrong usage).
#include <cstdio>
#include <exception>
#include <optional>

#include "ranks/launch.h"
#include <fmt/format.h>

#include "base/process_rank.h"
#include "cli/command.h"
#include "cli/near_miss.h"
#include "nn/engine/kernels/kernels.h"
#include "nn/torch/threads.h"

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
  addTaskCommands(app, context);
  addScoreCommand(app, context);
  addAnalyzeCommand(app, context);
  addReportCommand(app, context);
  addRenderCommand(app, context);
  addModelCommand(app, context);
  addBenchCommand(app, context);
#endif
}

/// Whether this is one of several processes, and not the one that speaks for all.
bool isSilent(const Context& context) {
  if (context.processes == Processes::Own) return false;
  try {
    return marey::processRank().rank > 0;
  } catch (const marey::InputError&) {  // the environment tells nonsense: that is to be said
    return false;
  }
}

int fail(const Context& context, int status, const char* what) {
  // The launcher takes the status of the process that speaks, and would end it before it has
  // spoken if another one said first that it failed.
  if (isSilent(context)) return 0;
  fmt::print(stderr, "marey: {}{}\n", what, context.afterFailure ? context.afterFailure() : "");
  return status;
}

void startProcesses(Context& context) {
  if (context.processes == Processes::Own) return;
  if (context.processes == Processes::One && marey::launchedProcesses() > 1)
    throw marey::UsageError(
        fmt::format("{}: runs in one process, found {} that were started together", context.command,
                    marey::launchedProcesses()));
  context.ranks = marey::startRanks();
  if (context.ranks->first()) return;
  context.json = false;
  context.quiet = true;
}

int runCommand(Context& context) {
  try {
    startProcesses(context);
    const bool many = context.ranks->size() > 1 && context.threads == 0;
    marey::nn::configureThreads(many ? marey::coresOfThisProcess() : context.threads,
                                context.quiet);
    context.ranks->together(context.run);
    return 0;
  } catch (const marey::UsageError& e) {
    return fail(context, 2, e.what());
  } catch (const std::exception& e) {
    return fail(context, 1, e.what());
  }
}

std::string joined(int argc, char** argv) {
  std::string out = "marey";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    out += word.find(' ') == std::string::npos ? " " + word : " '" + word + "'";
  }
  return out;
}

/// What the command line says, into `context`; the exit status where that is all there is to do.
std::optional<int> parse(CLI::App& app, const Context& context, int argc, char** argv) {
  try {
    // Before help is given: help for a command that does not exist would be help for another.
    requireKnownCommand(app, {argv + 1, argv + argc});
    app.parse(argc, argv);
    return std::nullopt;
  } catch (const marey::UsageError& e) {
    return fail(context, 2, e.what());
  } catch (const CLI::ParseError& e) {
    if (isSilent(context)) return 0;
    const int status = app.exit(e) == 0 ? 0 : 2;
    if (const std::string near = nearestOptions(app); status != 0 && !near.empty())
      fmt::print(stderr, "{}\n", near);
    return status;
  }
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
    marey::nn::kernels();  // MAREY_ISA is wrong from the start or not at all
  } catch (const marey::UsageError& e) {
    return fail(context, 2, e.what());
  }
  if (const auto done = parse(app, context, argc, argv)) return *done;
  const int status = runCommand(context);
  context.ranks.reset();  // after all that there was to say: the other processes end with this
  return status;
}
