#include "experiment/import_files.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "base/atomic_file.h"
#include "experiment/file_names.h"
#include "io/clip_io.h"
#include "io/inputs.h"

namespace marey {
namespace {
namespace fs = std::filesystem;

Json toJson(const io::ReadOptions& options) {
  Json out = Json::object();
  if (!options.unit.empty()) out["unit"] = options.unit;
  if (!options.up.empty()) out["up"] = options.up;
  if (options.fps) out["fps"] = *options.fps;
  if (!options.eulerOrder.empty()) out["euler_order"] = options.eulerOrder;
  if (options.swapSides) out["swap_sides"] = true;
  if (!options.asf.empty()) out["asf"] = options.asf.string();
  return out;
}

/// Names that differ from each other and from the files that are there.
fs::path freeName(const fs::path& folder, const std::string& wanted, std::set<std::string>& taken) {
  std::string name = wanted;
  for (int n = 2; fs::exists(folder / (name + ".npz")) || !taken.insert(name).second; ++n)
    name = fmt::format("{}_{}", wanted, n);
  return name + ".npz";
}

/// As the doctor tells of a file that cannot be read.
io::DoctorReport notReadReport(const io::NotRead& file) {
  io::DoctorReport out;
  out.path = file.path.string();
  out.faults.push_back({.kind = "unreadable",
                        .severity = io::Severity::Error,
                        .evidence = file.reason,
                        .frame = {}});
  return out;
}

}  // namespace

bool ImportFile::overridden() const {
  return !toJson(options).empty();
}

bool ImportFile::readable() const {
  return std::none_of(reports.begin(), reports.end(), [](const io::DoctorReport& report) {
    return std::any_of(report.faults.begin(), report.faults.end(),
                       [](const io::Fault& f) { return f.kind == "unreadable"; });
  });
}

ImportList importFiles(const std::vector<std::string>& given) {
  ImportList out;
  for (const std::string& source : given) {
    io::Inputs inputs = io::findInputs({source});
    for (const io::InputFile& file : inputs.files)
      out.files.push_back(
          {.path = file.path.string(), .source = source, .options = {}, .reports = {}});
    for (const io::NotRead& file : std::exchange(inputs.notRead, {}))
      out.files.push_back({.path = file.path.string(),
                           .source = source,
                           .options = {},
                           .reports = {notReadReport(file)},
                           .skipped = true});
    for (std::string& remark : inputs.remarks())
      out.remarks.push_back(fmt::format("{}: {}", source, remark));
  }
  return out;
}

std::vector<std::string> convertOverridden(const std::vector<ImportFile>& files,
                                           const fs::path& folder, Progress& progress) {
  std::vector<std::string> out;
  std::set<std::string> taken, broken;  // broken: sources that are not taken as a whole
  for (const ImportFile& file : files)
    if (!file.skipped && (!file.taken() || file.overridden())) broken.insert(file.source);
  std::optional<StagedFolder> staged;
  for (size_t i = 0; i < files.size(); ++i) {
    const ImportFile& file = files[i];
    progress.throwIfCancelled();
    progress.report(static_cast<double>(i) / static_cast<double>(files.size()), file.path);
    if (!file.taken()) continue;
    if (!file.overridden()) {
      const std::string& name = broken.contains(file.source) ? file.path : file.source;
      if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
      continue;
    }
    if (!staged) staged.emplace(folder);
    for (const Clip& clip : io::readClips(file.path, file.options)) {
      const fs::path name = freeName(folder, safeName(clip.name), taken);
      io::WriteOptions options;
      options.recipe = {
          {"marey", MAREY_VERSION}, {"input", file.path}, {"read_as", toJson(file.options)}};
      io::writeClip(clip, staged->path() / name, options);
      out.push_back((folder / name).string());
    }
  }
  if (staged) staged->commit();
  return out;
}

}  // namespace marey
