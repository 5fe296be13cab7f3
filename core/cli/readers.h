// Reading many clips for a command.
#pragma once

#include <vector>

#include "base/job.h"
#include "cli/command.h"
#include "io/clip_io.h"
#include "io/input_report.h"

namespace marey::cli {

/// --unit, --up, --source-fps, --euler and --whole-rows, which override what readers find or guess.
void addReadOptions(CLI::App& command, io::ReadOptions& options);
/// --euler alone, under another name.
void addEulerOption(CLI::App& command, const std::string& name, io::ReadOptions& options);
void addWholeRowsOption(CLI::App& command, io::ReadOptions& options);

/// Every clip of the files, in order; what becomes of them is added to `report`. Throws InputError
/// naming every named file that cannot be read, or where none is left; CancelledError.
std::vector<Clip> readAll(const io::Inputs& inputs, const io::ReadOptions& options,
                          io::InputReport& report, Progress& progress);
/// The remarks of a report on stderr, a line each; nothing with --quiet.
void tell(const Context& context, const io::InputReport& report);

}  // namespace marey::cli
