#include "cli/readers.h"

#include <cstdio>

#include <fmt/format.h>

namespace marey::cli {

void addReadOptions(CLI::App& command, io::ReadOptions& options) {
  command.add_option(
      "--unit", options.unit,
      "Unit of the files, where it is not stated or guessed wrongly: m, cm, mm, inch, foot, cmu");
  command.add_option("--up", options.up, "Up axis of the files: y or z")
      ->check(CLI::IsMember({"y", "z"}));
  command
      .add_option("--source-fps", options.fps, "Frame rate of the files, in place of what they say")
      ->check(CLI::PositiveNumber);
  addEulerOption(command, "--euler", options);
  addWholeRowsOption(command, options);
}

void addEulerOption(CLI::App& command, const std::string& name, io::ReadOptions& options) {
  command
      .add_option(name, options.eulerOrder,
                  "Order of the turns in BVH and AMC files, in place of the one they list: ZXY, "
                  "...; values keep their axes")
      ->check(CLI::IsMember({"XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"}, CLI::ignore_case));
}

void addWholeRowsOption(CLI::App& command, io::ReadOptions& options) {
  command.add_flag("--whole-rows", options.wholeRows,
                   "Read the whole frames of BVH files that say they have more or fewer");
}

std::vector<Clip> readAll(const io::Inputs& inputs, const io::ReadOptions& options,
                          io::InputReport& report, Progress& progress) {
  std::vector<Clip> out;
  const size_t count = inputs.files.size();
  for (size_t i = 0; i < count; ++i) {
    progress.throwIfCancelled();
    for (Clip& clip : report.read(inputs.files[i], options)) out.push_back(std::move(clip));
    progress.report(static_cast<double>(i + 1) / static_cast<double>(count), "reading");
  }
  if (count > 0) report.throwIfNone(out.size());
  return out;
}

void tell(const Context& context, const io::InputReport& report) {
  if (context.quiet) return;
  for (const std::string& remark : report.remarks()) fmt::print(stderr, "marey: {}\n", remark);
  if (const std::string missing = report.missingText(); !missing.empty())
    fmt::print(stderr, "marey: {}\n", missing);
}

}  // namespace marey::cli
