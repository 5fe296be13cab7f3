// Options that say what the control of a data set is, and what a motion is asked to do.
#pragma once

#include <string>
#include <vector>

#include "cli/command.h"
#include "experiment/control_choice.h"
#include "motion/control/control_layout.h"

namespace marey::cli {

/// --type, --control, --without and --body.
struct ControlAsked {
  ControlChoice choice;
  std::vector<std::string> signals;  ///< FILE or CHANNEL=FILE
};
void addControlAsked(CLI::App& command, ControlAsked& asked);
/// --without alone.
void addLeftOut(CLI::App& command, ControlAsked& asked);
/// The choice for a model of that layout: a FILE without a channel is that of its only signal.
/// Throws UsageError.
ControlChoice choiceOf(const ControlAsked& asked, const ControlLayout& layout);

/// --types, --future-path, --bodies, --signal and --optional.
struct ControlDeclared {
  std::vector<std::string> types;    ///< "auto" alone: those of the label files
  std::vector<double> futurePath;    ///< seconds
  std::vector<std::string> signals;  ///< NAME[:fps=F][:past=S][:future=S]
  std::vector<std::string> optional;
  bool bodies = false;

  bool hasTime() const { return !types.empty() || !signals.empty(); }
};
void addControlDeclared(CLI::App& command, ControlDeclared& declared);
/// Channels "root", "path", "type", "body" and the signals. Throws UsageError.
ControlLayout layoutOf(const ControlDeclared& declared);

}  // namespace marey::cli
