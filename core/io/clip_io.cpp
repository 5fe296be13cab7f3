#include "io/clip_io.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_kind.h"
#include "io/annotation_files.h"
#include "io/asf_amc.h"
#include "io/bvh.h"
#include "io/csv_writer.h"
#include "io/dog_text.h"
#include "io/export_record.h"
#include "io/gltf_writer.h"
#include "io/joint_arrays.h"
#include "io/npz_clips.h"
#include "io/text.h"

namespace marey::io {
namespace {

constexpr size_t kHeadBytes = 16384;

std::string lowerExtension(const std::filesystem::path& path) {
  std::string out = path.extension().string();
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

bool hasExtension(const ClipFormat& format, const std::string& extension) {
  return std::find(format.extensions.begin(), format.extensions.end(), extension) !=
         format.extensions.end();
}

std::string formatNames(bool writable) {
  std::string out;
  for (const ClipFormat& format : clipFormats())
    if (writable ? format.write != nullptr : format.read != nullptr)
      out += (out.empty() ? "" : ", ") + format.name;
  return out;
}

const ClipFormat& formatForWriting(const std::filesystem::path& path, const WriteOptions& options) {
  if (!options.format.empty()) {
    const ClipFormat& format = formatByName(options.format);
    if (format.write == nullptr)
      throw UsageError(fmt::format("format: expected one that can be written ({}), found '{}'",
                                   formatNames(true), options.format));
    return format;
  }
  for (const ClipFormat& format : clipFormats())
    if (format.write != nullptr && hasExtension(format, lowerExtension(path))) return format;
  throw UsageError(
      fmt::format("{}: expected the extension of a format that can be written ({}), found '{}'",
                  path.string(), formatNames(true), path.extension().string()));
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

/// What a file is that no reader takes; formats of motion are said not to be read.
std::string foundInstead(std::string_view bytes, const std::filesystem::path& path) {
  const std::optional<FileKind> kind = fileKind(bytes.substr(0, kFileHeadBytes));
  if (kind)
    return kind->text() + (isUnreadMotion(kind->id) ? ": " + upper(kind->id) + " is not read" : "");
  const std::string extension = lowerExtension(path);
  std::string out = describeContent(bytes.substr(0, kFileHeadBytes));
  if (!extension.empty() && isUnreadMotion(extension.substr(1)))
    out += ": " + upper(extension.substr(1)) + " is not read";
  return out;
}

}  // namespace

const std::vector<ClipFormat>& clipFormats() {
  static const std::vector<ClipFormat> formats = {
      {"bvh", "Biovision hierarchy", {".bvh"}, canReadBvh, readBvh, writeBvh, true},
      {"amc", "Acclaim motion with its ASF skeleton", {".amc"}, canReadAmc, readAmc, nullptr},
      {"npz", "NumPy archive of clips", {".npz"}, canReadNpz, readNpzClips, writeNpzClip},
      {"npy", "NumPy array of joint positions", {".npy"}, canReadNpy, readNpyClips, nullptr},
      {"dog-text",
       "27 joints as comma-separated text",
       {".txt"},
       canReadDogText,
       readDogText,
       nullptr},
      {"gltf", "glTF 2.0 as text", {".gltf"}, nullptr, nullptr, writeGltf, true},
      {"glb", "glTF 2.0 in one binary file", {".glb"}, nullptr, nullptr, writeGlb, true},
      {"csv", "positions, one row per frame and joint", {".csv"}, nullptr, nullptr, writeCsvLong},
      {"csv-wide", "positions, one row per frame", {}, nullptr, nullptr, writeCsvWide},
  };
  return formats;
}

const ClipFormat* formatOfContent(std::string_view head) {
  const ClipFormat* best = nullptr;
  int bestScore = 0;
  for (const ClipFormat& format : clipFormats()) {
    const int score = format.canRead != nullptr ? format.canRead(head) : 0;
    if (score <= bestScore) continue;
    best = &format;
    bestScore = score;
  }
  return best;
}

const ClipFormat& formatByName(const std::string& name) {
  for (const ClipFormat& format : clipFormats())
    if (format.name == name) return format;
  std::string known;
  for (const ClipFormat& format : clipFormats()) known += (known.empty() ? "" : ", ") + format.name;
  throw UsageError(fmt::format("format: expected one of {}, found '{}'", known, name));
}

std::string readHead(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw FileError(fmt::format("{}: cannot read", path.string()));
  std::string head(kHeadBytes, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<size_t>(in.gcount()));
  return head;
}

bool hasReadableExtension(const std::filesystem::path& path) {
  const std::string extension = lowerExtension(path);
  const auto& formats = clipFormats();
  return std::any_of(formats.begin(), formats.end(), [&](const ClipFormat& f) {
    return f.read != nullptr && hasExtension(f, extension);
  });
}

bool isUnreadMotion(std::string_view format) {
  static constexpr std::string_view known[] = {
      "c3d",   "fbx", "trc", "tsv", "vmd",  "usd",  "usda", "usdc",    "usdz",
      "blend", "abc", "dae", "glb", "gltf", "htr",  "mvnx", "mot",     "sto",
      "vsk",   "v",   "asf", "bip", "tak",  "vrma", "anim", "opensim", "x3d"};
  return std::find(std::begin(known), std::end(known), format) != std::end(known);
}

bool isMotionFile(const std::filesystem::path& path) {
  std::error_code ec;
  return hasReadableExtension(path) && std::filesystem::is_regular_file(path, ec) &&
         formatOfContent(readHead(path)) != nullptr;
}

std::vector<Clip> readClips(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string bytes = readFile(path);
  const ClipFormat* format = formatOfContent(std::string_view(bytes).substr(0, kHeadBytes));
  if (format == nullptr)
    throw InputError({.path = path.string()}, "a motion file (" + formatNames(false) + ")",
                     foundInstead(bytes, path));
  std::vector<Clip> out = format->read(bytes, path, options);
  // A file of several clips has no file beside it that would be one clip's.
  if (const auto labels = labelsBeside(path); !labels.empty() && out.size() == 1)
    out.front().annotations.labels = readLabels(labels);
  return out;
}

Clip readClip(const std::filesystem::path& path, const ReadOptions& options) {
  std::vector<Clip> clips = readClips(path, options);
  if (clips.size() != 1) throwInput({.path = path.string()}, "one clip", "{} clips", clips.size());
  return std::move(clips.front());
}

WrittenClip writeClip(const Clip& clip, const std::filesystem::path& path,
                      const WriteOptions& options) {
  validate(clip);
  const ClipFormat& format = formatForWriting(path, options);
  if (!format.holdsRotations || clip.transforms)
    return {.files = format.write(clip, path, options)};
  const SkeletonFit fit = fitSkeleton(clip);
  WriteOptions recorded = options;
  if (!recorded.recipe.is_object()) recorded.recipe = Json::object();
  recorded.recipe["fit"] = fitJson(fit.residual);
  return {.files = format.write(withFit(clip, fit), path, recorded), .fit = fit.residual};
}

}  // namespace marey::io
