#include "cli/control_options.h"

#include <algorithm>
#include <charconv>
#include <sstream>

namespace marey::cli {
namespace {

constexpr const char* kSignalForm = "NAME[:fps=F][:past=S][:future=S]";

double secondsOrRate(const std::string& text, const std::string& option) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= 0.0))
    throw UsageError(fmt::format("--signal: expected {}, found '{}'", kSignalForm, option));
  return value;
}

ControlChannel signalFrom(const std::string& option) {
  ControlChannel out{.name = {}, .kind = ControlKind::Array};
  std::istringstream parts(option);
  for (std::string part; std::getline(parts, part, ':');) {
    if (out.name.empty()) {
      out.name = part;
      continue;
    }
    const size_t equals = part.find('=');
    const std::string key = part.substr(0, equals);
    const double value =
        secondsOrRate(equals == std::string::npos ? "" : part.substr(equals + 1), option);
    if (key == "fps")
      out.fps = value;
    else if (key == "past")
      out.pastS = value;
    else if (key == "future")
      out.futureS = value;
    else
      throw UsageError(fmt::format("--signal: expected {}, found '{}'", kSignalForm, option));
  }
  if (out.name.empty())
    throw UsageError(fmt::format("--signal: expected {}, found '{}'", kSignalForm, option));
  return out;
}

/// The only signal of a layout.
std::string onlySignal(const ControlLayout& layout) {
  std::string out;
  for (const ControlChannel& channel : layout) {
    if (channel.kind != ControlKind::Array) continue;
    if (!out.empty())
      throw UsageError("--control: expected CHANNEL=FILE, since the model has several signals: " +
                       summaryOf(layout));
    out = channel.name;
  }
  if (out.empty())
    throw UsageError("--control: expected a model whose control is a signal, found one of " +
                     summaryOf(layout));
  return out;
}

}  // namespace

void addControlAsked(CLI::App& command, ControlAsked& asked) {
  command.add_option("--type", asked.choice.type,
                     "Type of motion, of those that the model knows, for all of it (default: those "
                     "of the path's way-points or of the clip)");
  command.add_option("--control", asked.signals,
                     "FILE of the signal that controls the model (CSV with a column time, or NPY), "
                     "or CHANNEL=FILE; may be given again (default: the files beside the clip)");
  addLeftOut(command, asked);
  command.add_option("--body", asked.choice.body,
                     "Motion file whose body moves, for models whose control is a body (default: "
                     "the clip's or the model's own)");
}

void addLeftOut(CLI::App& command, ControlAsked& asked) {
  command.add_option("--without", asked.choice.leftOut,
                     "A control that is left out, of those that may be; may be given again");
}

ControlChoice choiceOf(const ControlAsked& asked, const ControlLayout& layout) {
  ControlChoice out = asked.choice;
  for (const std::string& signal : asked.signals) {
    const size_t equals = signal.find('=');
    if (equals == std::string::npos)
      out.signals[onlySignal(layout)] = signal;
    else
      out.signals[signal.substr(0, equals)] = signal.substr(equals + 1);
  }
  return out;
}

void addControlDeclared(CLI::App& command, ControlDeclared& declared) {
  command
      .add_option("--types", declared.types,
                  "Types of motion as control: walk,run,... of CLIP.labels.csv beside each clip "
                  "(from,to,label), else of its name; or auto: all that the label files name")
      ->delimiter(',');
  command
      .add_option("--future-path", declared.futurePath,
                  "Ground points ahead as control: how far, in seconds (0.2,0.4,0.6)")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  command.add_option("--signal", declared.signals,
                     fmt::format("A signal as control, of CLIP.NAME.csv or .npy beside each clip: "
                                 "{} (rate of files that state none; seconds that a frame sees); "
                                 "may be given again",
                                 kSignalForm));
  command.add_flag("--bodies", declared.bodies,
                   "The body's rest pose as control; clips of several bodies keep their own");
  command
      .add_option("--optional", declared.optional,
                  "Controls that may be left out: type, path, body or names of signals")
      ->delimiter(',');
}

ControlLayout layoutOf(const ControlDeclared& declared) {
  ControlLayout out{ControlChannel{}};
  if (!declared.futurePath.empty())
    out.push_back({.name = "path", .kind = ControlKind::FuturePath, .aheadS = declared.futurePath});
  if (!declared.types.empty()) {
    const bool any = declared.types == std::vector<std::string>{"auto"};
    out.push_back({.name = "type",
                   .kind = ControlKind::Label,
                   .values = any ? std::vector<std::string>{} : declared.types,
                   .fromNames = !any});
  }
  if (declared.bodies) out.push_back({.name = "body", .kind = ControlKind::Skeleton});
  for (const std::string& signal : declared.signals) out.push_back(signalFrom(signal));
  for (const std::string& name : declared.optional) {
    const auto found = std::find_if(out.begin() + 1, out.end(),
                                    [&](const ControlChannel& c) { return c.name == name; });
    if (found == out.end())
      throw UsageError(fmt::format(
          "--optional: expected a control besides the root's motion, found '{}'", name));
    found->optional = true;
  }
  return out;
}

}  // namespace marey::cli
