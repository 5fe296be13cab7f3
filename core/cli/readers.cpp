#include "cli/readers.h"

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
}

void addEulerOption(CLI::App& command, const std::string& name, io::ReadOptions& options) {
  command
      .add_option(name, options.eulerOrder,
                  "Order of the turns in BVH and AMC files, in place of the one they list: ZXY, "
                  "...; values keep their axes")
      ->check(CLI::IsMember({"XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"}, CLI::ignore_case));
}

std::vector<Clip> readAll(const std::vector<std::filesystem::path>& files,
                          const io::ReadOptions& options, Progress& progress) {
  std::vector<Clip> out;
  for (size_t i = 0; i < files.size(); ++i) {
    progress.throwIfCancelled();
    for (Clip& clip : io::readClips(files[i], options)) out.push_back(std::move(clip));
    progress.report(static_cast<double>(i + 1) / static_cast<double>(files.size()), "reading");
  }
  return out;
}

}  // namespace marey::cli
