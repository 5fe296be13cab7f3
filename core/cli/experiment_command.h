// Shared by the commands that end in a report.
#pragma once

#include <string>

#include "cli/command.h"
#include "experiment/document.h"

namespace marey::cli {

/// Runs the experiment and writes its report into `out`; prints what was written.
void runReport(const Experiment& experiment, const std::string& out, bool pdf,
               const Context& context);

}  // namespace marey::cli
