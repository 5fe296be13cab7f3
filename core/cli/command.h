// What every command shares: --json, --quiet, --seed, --threads, an example in --help,
// progress on stderr, and one JSON object on stdout.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/job.h"
#include "base/json.h"
#include "base/ranks.h"
#include "model/model_family.h"

namespace marey::cli {

/// What a command does where mpirun or srun started several processes of it.
enum class Processes {
  One,   ///< refuses: they would write over each other
  Many,  ///< deals its work out over Context::ranks
  Own    ///< minds them itself
};

struct Context {
  bool json = false;
  bool quiet = false;
  uint64_t seed = 1;
  int threads = 0;            ///< 0: as many as there are cores
  std::function<void()> run;  ///< set by the command that was chosen
  /// Asked at the first process once a failed command has ended on all: what is left of it for the
  /// user, after the error; "" for nothing.
  std::function<std::string()> afterFailure;
  std::string commandLine;  ///< for recipes
  std::string command;      ///< name of the command that was chosen
  Processes processes = Processes::One;
  /// The processes of this run. On those that are not the first, `json` is false and `quiet` true.
  std::shared_ptr<Ranks> ranks = std::make_shared<Ranks>();

  /// One JSON object on stdout with --json, else `text` (nothing with --quiet).
  void print(const Json& result, const std::string& text) const;
  /// A Progress that draws a bar with rate and time left on a terminal, plain lines elsewhere,
  /// nothing with --quiet; Ctrl-C requests a stop.
  Progress progress(const std::string& what) const;
};

/// JSON knows no NaN.
Json finiteOrNull(double value);

/// Adds subcommand `name` with the shared options; `run` is called once parsing succeeded.
/// `example` is shown at the end of --help.
CLI::App* addCommand(CLI::App& app, Context& context, const std::string& name,
                     const std::string& summary, const std::string& example,
                     std::function<void()> run, Processes processes = Processes::One);

// One function per command, called by main in this order.
void addDemoCommand(CLI::App& app, Context& context);
void addDoctorCommand(CLI::App& app, Context& context);
void addConvertCommand(CLI::App& app, Context& context);
void addPrepareCommand(CLI::App& app, Context& context);
void addTrainCommand(CLI::App& app, Context& context);
void addSampleCommand(CLI::App& app, Context& context);
/// One for every task but that of `sample`.
void addTaskCommands(CLI::App& app, Context& context);
void addScoreCommand(CLI::App& app, Context& context);
void addAnalyzeCommand(CLI::App& app, Context& context);
void addReportCommand(CLI::App& app, Context& context);
void addRenderCommand(CLI::App& app, Context& context);
void addModelCommand(CLI::App& app, Context& context);
void addBenchCommand(CLI::App& app, Context& context);
/// `bench sample` and `bench score`.
void addModelBenchCommands(CLI::App& bench, Context& context);
void addTrainBenchCommand(CLI::App& bench, Context& context);

/// --option NAME=VALUE, any number of them; "temperature" goes to its own place.
void addModelOptions(CLI::App& command, double& temperature, OptionValues& options);
/// --weights: how the engine keeps a model's weights.
void addWeightsOption(CLI::App& command, std::string& weights);
WeightPrecision weightPrecisionNamed(const std::string& name);

}  // namespace marey::cli
