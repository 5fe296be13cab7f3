#include <cmath>
#include <memory>
#include <optional>
#include <set>

#include "base/atomic_file.h"
#include "base/error.h"
#include "cli/command.h"
#include "cli/fit_report.h"
#include "cli/readers.h"
#include "io/clip_io.h"
#include "io/text.h"
#include "motion/resample.h"

namespace marey::cli {
namespace fs = std::filesystem;
namespace {

struct ConvertOptions {
  std::vector<std::string> inputs;
  std::string out;
  double fps = 0.0;
  std::string frames;
  io::WriteOptions write;
  io::ReadOptions read;
};

/// "a:b": frames a to b - 1, from 0; either may be left out. Negative ones count from the end.
struct FrameRange {
  std::optional<int> first, last;
};

std::optional<int> frameNumber(const std::string& text, const std::string& all) {
  if (text.empty()) return std::nullopt;
  const std::optional<double> value = io::parseNumber(text);
  constexpr double kMost = 1e9;
  if (!value || std::abs(*value) > kMost || *value != std::floor(*value))
    throw UsageError(fmt::format("--frames: expected a:b with whole numbers, found '{}'", all));
  return static_cast<int>(*value);
}

FrameRange parseFrames(const std::string& text) {
  if (text.empty()) return {};
  const size_t colon = text.find(':');
  if (colon == std::string::npos)
    throw UsageError(fmt::format("--frames: expected a:b, found '{}'", text));
  return {frameNumber(text.substr(0, colon), text), frameNumber(text.substr(colon + 1), text)};
}

Clip sliced(const Clip& clip, const FrameRange& range) {
  if (!range.first && !range.last) return clip;
  const auto fromEnd = [&clip](int frame) { return frame < 0 ? frame + clip.frameCount() : frame; };
  return sliceFrames(clip, fromEnd(range.first.value_or(0)),
                     fromEnd(range.last.value_or(clip.frameCount())));
}

/// The extension of files that are named here and not by the user.
std::string extensionFor(const std::string& format) {
  const io::ClipFormat& found = io::formatByName(format.empty() ? "bvh" : format);
  return found.extensions.empty() ? ".csv" : found.extensions.front();
}

/// OUT is a folder when it is one, ends with a separator, or has no extension.
bool isFolder(const fs::path& out) {
  return fs::is_directory(out) || !out.has_filename() || out.extension().empty();
}

class Converter {
 public:
  Converter(const Context& context, const ConvertOptions& options)
      : m_context(context), m_options(options), m_range(parseFrames(options.frames)) {}

  Json convert(const io::Inputs& inputs) {
    const std::vector<io::InputFile>& files = inputs.files;
    m_report = io::InputReport(inputs);
    Progress progress = m_context.progress("converting");
    const fs::path out(m_options.out);
    const bool folder = isFolder(out);
    // All files of a folder or none: a later input may turn out to be unreadable.
    if (folder) m_staged.emplace(out);
    for (size_t i = 0; i < files.size(); ++i) {
      progress.throwIfCancelled();
      const std::vector<Clip> clips = m_report.read(files[i], m_options.read);
      if (!folder && (files.size() > 1 || clips.size() > 1))
        throw UsageError(
            fmt::format("--out: expected a folder for several clips, found '{}'", m_options.out));
      for (const Clip& clip : clips)
        write(clip, files[i].path, folder ? inFolder(m_staged->path(), clip) : out);
      progress.report(static_cast<double>(i + 1) / static_cast<double>(files.size()));
    }
    m_report.throwIfNone(m_written.size());
    if (folder) m_staged->commit();
    Json result = {{"written", m_written}};
    m_report.addTo(result);
    tell(m_context, m_report);
    m_fits.addTo(result);
    m_fits.tell(m_context);
    return result;
  }

 private:
  fs::path inFolder(const fs::path& folder, const Clip& clip) {
    const std::string extension = extensionFor(m_options.write.format);
    std::string name = clip.name;
    for (int n = 2; !m_names.insert(name).second; ++n) name = fmt::format("{}_{}", clip.name, n);
    return folder / (name + extension);
  }

  void write(const Clip& clip, const fs::path& from, const fs::path& to) {
    Clip out = sliced(clip, m_range);
    if (m_options.fps > 0.0) {
      m_report.resample(out, m_options.fps);
      out = resampled(out, m_options.fps);
    }
    io::WriteOptions write = m_options.write;
    if (write.format.empty() && isFolder(m_options.out)) write.format = "bvh";
    write.recipe = {
        {"marey", MAREY_VERSION}, {"command", m_context.commandLine}, {"input", from.string()}};
    if (!m_options.frames.empty()) write.recipe["frames"] = m_options.frames;
    if (m_options.fps > 0.0) write.recipe["resampled_to_fps"] = m_options.fps;
    for (const io::Doubt& doubt : m_report.doubts())
      if (doubt.path == clip.source.path && doubt.clip == clip.name)
        write.recipe["warnings"].push_back(doubt.text);
    const io::WrittenClip written = io::writeClip(out, to, write);
    m_fits.add(written.fit);
    for (const fs::path& path : written.files)
      m_written.push_back((m_staged ? fs::path(m_options.out) / path.filename() : path).string());
  }

  const Context& m_context;
  const ConvertOptions& m_options;
  FrameRange m_range;
  std::optional<StagedFolder> m_staged;
  std::set<std::string> m_names;
  std::vector<std::string> m_written;
  FitReport m_fits;
  io::InputReport m_report;
};

void runConvert(const Context& context, const ConvertOptions& options) {
  const Json result = Converter(context, options).convert(io::findInputs(options.inputs));
  std::string text;
  for (const Json& path : result["written"]) text += path.get<std::string>() + "\n";
  context.print(result, text);
}

}  // namespace

void addConvertCommand(CLI::App& app, Context& context) {
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* command = addCommand(app, context, "convert", "Motion files between formats",
                                 "marey convert walk.amc --fps 30 --out walk.bvh",
                                 [&context, options] { runConvert(context, *options); });
  command->add_option("inputs", options->inputs, "motion files, folders or @LIST")->required();
  command->add_option("--out", options->out, "file, or folder for several clips")->required();
  command->add_option(
      "--format", options->write.format,
      "bvh, gltf, glb, npz, csv or csv-wide; default: by the file's extension, bvh in a "
      "folder");
  command->add_option("--fps", options->fps, "resample to this rate")->check(CLI::PositiveNumber);
  command->add_option("--frames", options->frames, "a:b, frames a to b-1 of the input, from 0");
  command->add_option("--unit", options->write.unit,
                      "unit to write: m, cm, mm, inch, foot, cmu (default: cm in BVH, else m)");
  command->add_option("--up", options->write.up, "up axis to write: y (default) or z");
  command->add_option("--euler-order", options->write.eulerOrder,
                      "order of BVH rotation channels (default: ZXY)");
  command->add_option("--source-unit", options->read.unit, "unit of the input (default: guessed)");
  command->add_option("--source-up", options->read.up, "up axis of the input (default: guessed)");
  command->add_option("--source-fps", options->read.fps, "frame rate of the input")
      ->check(CLI::PositiveNumber);
  addEulerOption(*command, "--source-euler,--euler", options->read);
  addWholeRowsOption(*command, options->read);
  command->add_option("--asf", options->read.asf, "skeleton of AMC files");
}

}  // namespace marey::cli
