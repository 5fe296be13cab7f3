#include "io/csv_writer.h"

#include <iterator>
#include <ostream>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/json.h"
#include "io/export_record.h"
#include "io/normalise.h"
#include "io/utf8_names.h"

namespace marey::io {
namespace {

/// Nanometres: far below what capture resolves, and short files.
constexpr int kDigits = 9;

/// The clip in the unit and axes of the file.
Clip inFileUnits(const Clip& clip, const LengthUnit& unit, const std::string& up) {
  Clip out = clip;
  if (up == "z") turnToZUp(out);
  scaleLengths(out, 1.0 / unit.metres);
  return out;
}

LengthUnit csvUnit(const WriteOptions& options) {
  return unitByName(options.unit.empty() ? "m" : options.unit);
}

std::string longText(const Clip& clip, const std::string& unit) {
  std::string out = fmt::format("frame,time_s,joint,x_{0},y_{0},z_{0}\n", unit);
  const std::vector<std::string> names = utf8Names(clip.skeleton->names);
  for (int t = 0; t < clip.frameCount(); ++t)
    for (int j = 0; j < clip.jointCount(); ++j) {
      const Vec3& p = clip.at(t, j);
      fmt::format_to(std::back_inserter(out), "{},{:.9g},{},{:.{}g},{:.{}g},{:.{}g}\n", t,
                     t / clip.fps, csvField(names[static_cast<size_t>(j)]), p.x(), kDigits, p.y(),
                     kDigits, p.z(), kDigits);
    }
  return out;
}

std::string wideText(const Clip& clip) {
  std::string out = "time";
  for (const std::string& name : utf8Names(clip.skeleton->names))
    for (const char axis : {'X', 'Y', 'Z'})
      out += "," + csvField(name + "_" + std::string{axis} + "position");
  for (int t = 0; t < clip.frameCount(); ++t) {
    fmt::format_to(std::back_inserter(out), "\n{:.9g}", t / clip.fps);
    for (const Vec3& p : clip.frame(t))
      fmt::format_to(std::back_inserter(out), ",{:.{}g},{:.{}g},{:.{}g}", p.x(), kDigits, p.y(),
                     kDigits, p.z(), kDigits);
  }
  return out + "\n";
}

std::vector<std::filesystem::path> writeWithRecord(const Clip& clip,
                                                   const std::filesystem::path& path,
                                                   const WriteOptions& options,
                                                   const std::string& text, Json details) {
  details["unit"] = csvUnit(options).name;
  details["up"] = options.up;
  writeFileAtomically(path, text);
  writeJson(recipePath(path), exportRecord(clip, options, details));
  return {path, recipePath(path)};
}

}  // namespace

std::vector<std::filesystem::path> writeCsvLong(const Clip& clip, const std::filesystem::path& path,
                                                const WriteOptions& options) {
  const LengthUnit unit = csvUnit(options);
  const std::string text = longText(inFileUnits(clip, unit, checkedUp(options.up)), unit.name);
  return writeWithRecord(
      clip, path, options, text,
      {{"format", "csv"}, {"columns", "frame (from 0), time_s (seconds), joint, position"}});
}

std::vector<std::filesystem::path> writeCsvWide(const Clip& clip, const std::filesystem::path& path,
                                                const WriteOptions& options) {
  const std::string text = wideText(inFileUnits(clip, csvUnit(options), checkedUp(options.up)));
  return writeWithRecord(
      clip, path, options, text,
      {{"format", "csv-wide"}, {"columns", "time (seconds), then the position of every joint"}});
}

}  // namespace marey::io
