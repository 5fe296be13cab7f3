#include "base/unfinished_folder.h"

#include <system_error>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"

namespace marey {
namespace fs = std::filesystem;
namespace {

/// Inside the folder: what belongs to the run and not to its result.
constexpr const char* kRunFolder = ".run";

fs::path runPath(const fs::path& place) {
  return place / kRunFolder / "run.json";
}

bool isThere(const fs::path& path) {
  std::error_code ec;
  return fs::exists(path, ec);
}

fs::path withoutSlash(const fs::path& path) {
  return path.filename().empty() ? path.parent_path() : path;
}

fs::path besideTarget(const fs::path& target) {
  fs::path out = target;
  out += ".partial";
  return out;
}

void removeAll(const fs::path& path) {
  std::error_code ec;
  fs::remove_all(path, ec);
  if (ec) throw FileError(fmt::format("{}: cannot remove: {}", path.string(), ec.message()));
}

void moveFile(const fs::path& from, const fs::path& to) {
  std::error_code ec;
  fs::rename(from, to, ec);
  if (ec) throw FileError(fmt::format("{}: cannot write: {}", to.string(), ec.message()));
}

/// What a process that was killed in the midst of a file left of it.
void removeHalfFiles(const fs::path& folder) {
  std::error_code ec;
  std::vector<fs::path> halves;
  for (fs::recursive_directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec))
    if (it->path().filename().string().find(".partial-") != std::string::npos)
      halves.push_back(it->path());
  if (ec) throw FileError(fmt::format("{}: cannot list: {}", folder.string(), ec.message()));
  for (const fs::path& half : halves) removeAll(half);
}

}  // namespace

std::string rangesText(const std::vector<size_t>& numbers) {
  std::string out;
  for (size_t i = 0; i < numbers.size();) {
    size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    out += fmt::format("{}{}", out.empty() ? "" : ", ", numbers[i]);
    if (last > i) out += fmt::format("..{}", numbers[last]);
    i = last + 1;
  }
  return out;
}

UnfinishedFolder::UnfinishedFolder(fs::path target, fs::path place, Run run)
    : m_target(std::move(target)), m_place(std::move(place)), m_run(std::move(run)) {}

UnfinishedFolder UnfinishedFolder::open(const fs::path& target, const Run& run, bool resume) {
  const fs::path folder = withoutSlash(target);
  std::error_code ec;
  const bool there = fs::exists(folder, ec);
  if (there && !fs::is_directory(folder, ec))
    throw FileError(fmt::format("{}: expected a folder, found a file", folder.string()));
  fs::path place = there ? folder / ".partial" : besideTarget(folder);
  // The target may have come or gone since the run was broken.
  for (const fs::path& other : {folder / ".partial", besideTarget(folder)})
    if (isThere(runPath(other))) place = other;
  UnfinishedFolder out(folder, place, {});
  if (isThere(runPath(place))) {
    out.adopt(run);
    const size_t left = out.missing().size();
    if (resume) {
      for (const auto& [key, value] : run.identity.items())
        if (const Json found = out.m_run.identity.value(key, Json()); found != value)
          throw InputError({.path = runPath(place).string(), .item = "key '" + key + "'"},
                           jsonText(value) + " as this run has", jsonText(found));
      removeHalfFiles(place);
      return out;
    }
    if (left < out.m_run.parts)
      throw InputError({.path = place.string()}, "no unfinished run",
                       fmt::format("one that lacks parts {} of {}: go on with it by --resume, or "
                                   "remove it",
                                   rangesText(out.missing()), out.m_run.parts));
  } else if (resume) {
    throw InputError({.path = place.string()}, "an unfinished run", "nothing to resume");
  }
  out.begin(run);
  return out;
}

UnfinishedFolder UnfinishedFolder::join(const fs::path& target, const fs::path& place, Run run) {
  return {withoutSlash(target), place, std::move(run)};
}

void UnfinishedFolder::adopt(const Run& wanted) {
  const fs::path path = runPath(m_place);
  const Json stored = readJson(path);
  JsonReader reader(stored, path.string());
  m_run.identity = reader.raw("identity");
  m_run.notes = reader.raw("notes");
  m_run.parts = reader.required<size_t>("parts");
  reader.finish();
  if (!m_run.identity.is_object() || !m_run.notes.is_object())
    throw InputError({.path = path.string()}, "objects 'identity' and 'notes'", "other values");
  // Damaged numbers would be a long loop.
  if (m_run.identity == wanted.identity && m_run.parts != wanted.parts)
    throwInput({.path = path.string(), .item = "key 'parts'"}, fmt::format("{}", wanted.parts),
               "{}", m_run.parts);
}

void UnfinishedFolder::begin(const Run& run) {
  removeAll(m_place);
  m_run = run;
  writeJson(runPath(m_place),
            {{"identity", run.identity}, {"notes", run.notes}, {"parts", run.parts}});
}

fs::path UnfinishedFolder::recordPath(size_t part) const {
  return m_place / kRunFolder / fmt::format("part_{:06}.json", part);
}

std::vector<size_t> UnfinishedFolder::missing() const {
  std::vector<size_t> out;
  for (size_t part = 0; part < m_run.parts; ++part)
    if (!isThere(recordPath(part))) out.push_back(part);
  return out;
}

void UnfinishedFolder::record(size_t part, const Json& facts) const {
  writeFileAtomically(recordPath(part), jsonText(facts));
}

Json UnfinishedFolder::recordOf(size_t part) const {
  return readJson(recordPath(part));
}

void UnfinishedFolder::commit(const std::vector<std::string>& files) const {
  if (!isThere(m_target)) {
    moveFile(m_place, m_target);
    return removeAll(m_target / kRunFolder);
  }
  for (const std::string& file : files) {
    std::error_code ec;
    const fs::path to = m_target / file;
    if (fs::is_directory(to, ec))
      throw FileError(
          fmt::format("{}: cannot write: expected a file, found a folder", to.string()));
  }
  for (const std::string& file : files) {
    // One that is gone was moved before a commit was broken.
    const fs::path from = m_place / file, to = m_target / file;
    if (isThere(from) || !isThere(to)) moveFile(from, to);
  }
  removeAll(m_place);
}

size_t UnfinishedFolder::abandon() const {
  const size_t finished = m_run.parts - missing().size();
  if (finished == 0) removeAll(m_place);
  return finished;
}

}  // namespace marey
