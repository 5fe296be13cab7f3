#include "io/annotation_files.h"

#include <algorithm>
#include <cmath>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/npy.h"
#include "base/text_table.h"
#include "io/clip_io.h"

namespace marey::io {
namespace fs = std::filesystem;
namespace {

constexpr const char* kLabelForms =
    "a table with the columns from,to,label or time,label (seconds)";
constexpr const char* kSignalForms = "a table of numbers, a row per sample";

double secondsAt(const TextTable& table, const TextTable::Row& row, size_t column) {
  const auto value = table.number(row, column);
  if (!value) throw InputError(table.place(row), "a time in seconds", "an empty field");
  return *value;
}

/// Of rows at rising times; each ends where the next one begins unless it says so.
std::vector<LabelSpan> spansOf(const TextTable& table, size_t from, std::optional<size_t> to,
                               size_t label) {
  std::vector<LabelSpan> out;
  for (const TextTable::Row& row : table.rows()) {
    LabelSpan span{.fromS = secondsAt(table, row, from), .label = row.fields[label]};
    if (to) span.toS = secondsAt(table, row, *to);
    if (!out.empty() && span.fromS < (to ? out.back().toS : out.back().fromS) - 1e-9)
      throwInput(table.place(row), fmt::format("a time from {} s on", out.back().fromS), "{} s",
                 span.fromS);
    if (span.toS <= span.fromS)
      throwInput(table.place(row), fmt::format("an end after {} s", span.fromS), "{} s", span.toS);
    if (!to && !out.empty()) out.back().toS = span.fromS;
    out.push_back(std::move(span));
  }
  std::erase_if(out, [](const LabelSpan& s) { return s.label.empty() || s.toS <= s.fromS; });
  return out;
}

/// The rate of a column of times, which must rise evenly.
double rateOf(const TextTable& table, size_t column) {
  const auto& rows = table.rows();
  if (rows.size() < 2)
    throwInput({.path = table.origin()}, "at least two rows with times", "{}", rows.size());
  const double first = secondsAt(table, rows.front(), column);
  const double step =
      (secondsAt(table, rows.back(), column) - first) / static_cast<double>(rows.size() - 1);
  for (size_t i = 0; i < rows.size(); ++i) {
    const double wanted = first + static_cast<double>(i) * step;
    const double found = secondsAt(table, rows[i], column);
    if (!(step > 0.0) || std::abs(found - wanted) > 0.5 * step)
      throwInput(table.place(rows[i]), fmt::format("times in even steps (about {:g} s)", wanted),
                 "{:g} s", found);
  }
  return 1.0 / step;
}

Signal fromTable(const std::string& text, const fs::path& path) {
  const TextTable table(text, path.string(), kSignalForms);
  const auto time = table.find("time");
  Signal out;
  if (time) {
    out.fps = rateOf(table, *time);
    out.startS = secondsAt(table, table.rows().front(), *time);
  }
  for (size_t c = 0; c < table.width(); ++c)
    if (c != time)
      out.columns.push_back(table.titles().empty() ? std::to_string(c) : table.titles()[c]);
  for (const TextTable::Row& row : table.rows())
    for (size_t c = 0; c < table.width(); ++c) {
      if (c == time) continue;
      const auto value = table.number(row, c);
      if (!value) throw InputError(table.place(row), "a number in every column", "an empty field");
      out.values.push_back(static_cast<float>(*value));
    }
  return out;
}

Signal fromNpy(const std::string& bytes, const fs::path& path) {
  const Tensor array = parseNpy(bytes, path.string());
  if (array.shape.empty() || array.shape.size() > 2)
    throwInput({.path = path.string()}, "an array of one or two dimensions (rows, columns)", "{}",
               array.shape.size());
  Signal out;
  const int64_t columns = array.shape.size() == 2 ? array.shape[1] : 1;
  for (int64_t c = 0; c < columns; ++c) out.columns.push_back(std::to_string(c));
  out.values = array.toFloats();
  const auto bad =
      std::find_if(out.values.begin(), out.values.end(), [](float v) { return !std::isfinite(v); });
  if (bad != out.values.end())
    throw InputError({.path = path.string(), .frame = (bad - out.values.begin()) / columns + 1},
                     "finite numbers", "NaN or infinity");
  return out;
}

}  // namespace

std::vector<LabelSpan> readLabels(const fs::path& path) {
  const TextTable table(readFile(path), path.string(), kLabelForms);
  const auto label = table.find("label") ? table.find("label") : table.find("type");
  const auto from = table.find("from") ? table.find("from") : table.find("time");
  if (!label || !from)
    throw InputError({.path = path.string(), .line = table.firstLine()}, kLabelForms,
                     "another table");
  return spansOf(table, *from, table.find("to"), *label);
}

Signal readSignal(const fs::path& path, double fps, const Clip* clip) {
  const std::string bytes = readFile(path);
  Signal out = path.extension() == ".npy" ? fromNpy(bytes, path) : fromTable(bytes, path);
  if (out.rows() == 0) throw InputError({.path = path.string()}, kSignalForms, "no rows");
  if (out.fps == 0.0) out.fps = fps;
  if (out.fps > 0.0) return out;
  if (clip && std::abs(out.rows() - clip->frameCount()) <= 1) {
    out.fps = clip->fps;
    return out;
  }
  throw InputError(
      {.path = path.string()},
      "a column 'time', or a rate where the control is declared" +
          (clip ? fmt::format(", or a row for each of the clip's {} frames", clip->frameCount())
                : std::string()),
      fmt::format("{} rows without a rate", out.rows()));
}

fs::path labelsBeside(const fs::path& motion) {
  const fs::path labels = motion.parent_path() / (motion.stem().string() + ".labels.csv");
  std::error_code ec;
  return fs::is_regular_file(labels, ec) ? labels : fs::path();
}

bool isAnnotation(const fs::path& path) {
  if (path.extension() != ".csv" && path.extension() != ".npy") return false;
  const fs::path stem = path.stem();
  if (!stem.has_extension()) return false;
  for (const ClipFormat& format : clipFormats()) {
    if (format.read == nullptr) continue;
    for (const std::string& extension : format.extensions) {
      std::error_code ec;
      fs::path motion = path.parent_path() / stem.stem();
      motion += extension;
      if (fs::is_regular_file(motion, ec)) return true;
    }
  }
  return false;
}

void readSignals(Clip& clip, const ControlLayout& layout) {
  const fs::path motion(clip.source.path);
  // A file of several clips has no file beside it that would be one clip's.
  if (motion.empty() || clip.name != motion.stem().string()) return;
  for (const ControlChannel& channel : layout) {
    if (channel.kind != ControlKind::Array || clip.annotations.signals.contains(channel.name))
      continue;
    for (const char* extension : {".csv", ".npy"}) {
      const fs::path file = motion.parent_path() / (clip.name + "." + channel.name + extension);
      std::error_code ec;
      if (!fs::is_regular_file(file, ec)) continue;
      clip.annotations.signals[channel.name] = readSignal(file, channel.fps, &clip);
      break;
    }
  }
}

void readSignals(std::vector<Clip>& clips, const ControlLayout& layout) {
  for (Clip& clip : clips) readSignals(clip, layout);
}

}  // namespace marey::io
