// What every command shares: --json, --quiet, --seed, --threads, an example in --help,
// progress on stderr, and one JSON object on stdout.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/job.h"
#include "base/json.h"
#include "model/motion_model.h"

namespace marey::cli {

struct Context {
  bool json = false;
  bool quiet = false;
  uint64_t seed = 1;
  int threads = 0;            ///< 0: as many as there are cores
  std::function<void()> run;  ///< set by the command that was chosen
  std::string commandLine;    ///< for recipes

  /// One JSON object on stdout with --json, else `text` (nothing with --quiet).
  void print(const Json& result, const std::string& text) const;
  /// A Progress that draws a bar with rate and time left on a terminal, plain lines elsewhere,
  /// nothing with --quiet; Ctrl-C requests a stop.
  Progress progress(const std::string& what) const;
};

/// Adds subcommand `name` with the shared options; `run` is called once parsing succeeded.
/// `example` is shown at the end of --help.
CLI::App* addCommand(CLI::App& app, Context& context, const std::string& name,
                     const std::string& summary, const std::string& example,
                     std::function<void()> run);

// One function per command, called by main in this order.
void addDemoCommand(CLI::App& app, Context& context);
void addDoctorCommand(CLI::App& app, Context& context);
void addConvertCommand(CLI::App& app, Context& context);
void addPrepareCommand(CLI::App& app, Context& context);
void addTrainCommand(CLI::App& app, Context& context);
void addSampleCommand(CLI::App& app, Context& context);
void addScoreCommand(CLI::App& app, Context& context);
void addAnalyzeCommand(CLI::App& app, Context& context);
void addReportCommand(CLI::App& app, Context& context);
void addRenderCommand(CLI::App& app, Context& context);
void addModelCommand(CLI::App& app, Context& context);
void addBenchCommand(CLI::App& app, Context& context);
/// `bench sample` and `bench score`.
void addModelBenchCommands(CLI::App& bench, Context& context);
void addTrainBenchCommand(CLI::App& bench, Context& context);

/// --weights: how the engine keeps a model's weights.
void addWeightsOption(CLI::App& command, std::string& weights);
WeightPrecision weightPrecisionNamed(const std::string& name);

}  // namespace marey::cli
