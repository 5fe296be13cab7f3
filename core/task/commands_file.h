// Commands of steering as files.
#pragma once

#include <filesystem>

#include "task/steering.h"

namespace marey {

/// Commands for every frame at `fps`. JSON: what a recipe or document keeps ("commands", "begin",
/// ...), at that rate. CSV: time (seconds), and of forward, sideways (m/s), turn_deg, facing_deg
/// (turn a second; angle) and type those that are known; a row holds up to the next one, the last
/// for as long as the one before it. Throws FileError or InputError naming the line.
Steering readCommands(const std::filesystem::path& path, double fps);

}  // namespace marey
