// Commands and options that are not there, and what may have been meant.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace marey::cli {

/// Throws UsageError where a word stands in the place of a command and is none: "unknown command
/// 'stdy'; did you mean 'study'?".
void requireKnownCommand(const CLI::App& app, const std::vector<std::string>& words);

/// After parsing has failed: for each option that the chosen command lacks, the nearest one that it
/// has. Empty where all were known.
std::string nearestOptions(const CLI::App& app);

}  // namespace marey::cli
