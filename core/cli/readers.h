// Reading many clips for a command.
#pragma once

#include <filesystem>
#include <vector>

#include "base/job.h"
#include "cli/command.h"
#include "io/clip_io.h"
#include "io/inputs.h"

namespace marey::cli {

using io::expandInputs;

/// --unit, --up, --source-fps and --euler, which override what readers find or guess.
void addReadOptions(CLI::App& command, io::ReadOptions& options);
/// The last of them alone, under another name.
void addEulerOption(CLI::App& command, const std::string& name, io::ReadOptions& options);

/// Every clip of the files, in order. Throws InputError, CancelledError.
std::vector<Clip> readAll(const std::vector<std::filesystem::path>& files,
                          const io::ReadOptions& options, Progress& progress);

}  // namespace marey::cli
