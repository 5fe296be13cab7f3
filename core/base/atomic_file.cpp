#include "base/atomic_file.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>
#include <vector>

#include <unistd.h>

#include "base/error.h"

namespace marey {
namespace fs = std::filesystem;
namespace {

/// A name beside `path` that no other process or thread uses.
fs::path besideName(const fs::path& path) {
  static std::atomic<unsigned> counter{0};
  fs::path out = path;
  out += fmt::format(".partial-{}-{}", ::getpid(), counter++);
  return out;
}

void createFolder(const fs::path& folder) {
  if (folder.empty()) return;
  std::error_code ec;
  fs::create_directories(folder, ec);
  if (ec)
    throw FileError(fmt::format("{}: cannot create folder: {}", folder.string(), ec.message()));
}

void renameOver(const fs::path& from, const fs::path& to) {
  std::error_code ec;
  fs::rename(from, to, ec);
  if (ec) throw FileError(fmt::format("{}: cannot write: {}", to.string(), ec.message()));
}

/// Throws FileError where a folder lies in the place of a file, or a file in that of a folder.
void requireFree(const fs::path& place, bool folder) {
  std::error_code ec;
  const fs::file_status there = fs::status(place, ec);
  if (!fs::exists(there) || fs::is_directory(there) == folder) return;
  throw FileError(fmt::format("{}: cannot write: expected a {}, found a {}", place.string(),
                              folder ? "folder" : "file", folder ? "file" : "folder"));
}

}  // namespace

void writeFileAtomically(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  createFolder(path.parent_path());
  const fs::path partial = besideName(path);
  try {
    errno = 0;
    std::ofstream out(partial, std::ios::binary | std::ios::trunc);
    if (!out)
      throw FileError(fmt::format("{}: cannot write: {}", path.string(), std::strerror(errno)));
    write(out);
    out.flush();
    const bool written = static_cast<bool>(out);
    out.close();
    if (!written || !out)
      throw FileError(fmt::format("{}: cannot write: {}", path.string(),
                                  errno != 0 ? std::strerror(errno) : "stream failed"));
    renameOver(partial, path);
  } catch (...) {
    std::error_code ignored;
    fs::remove(partial, ignored);
    throw;
  }
}

void writeFileAtomically(const fs::path& path, std::string_view content) {
  writeFileAtomically(path, [content](std::ostream& out) {
    out.write(content.data(), static_cast<std::streamsize>(content.size()));
  });
}

std::string readFile(const fs::path& path, size_t maxBytes) {
  std::error_code ec;
  if (fs::is_directory(path, ec))
    throw FileError(fmt::format("{}: expected a file, found a folder", path.string()));
  std::ifstream in(path, std::ios::binary);
  if (!in) throw FileError(fmt::format("{}: cannot read: {}", path.string(), std::strerror(errno)));
  const uintmax_t size = fs::file_size(path, ec);
  if (!ec && size > maxBytes)
    throw FileError(
        fmt::format("{}: expected at most {} bytes, found {}", path.string(), maxBytes, size));
  // Grows with what is there: pipes have no size.
  std::string content;
  size_t next = ec || size == 0 ? size_t{1} << 16 : static_cast<size_t>(size) + 1;
  while (in && content.size() <= maxBytes) {
    const size_t done = content.size();
    content.resize(done + std::min(next, maxBytes - done + 1));
    in.read(content.data() + done, static_cast<std::streamsize>(content.size() - done));
    content.resize(done + static_cast<size_t>(in.gcount()));
    next = std::max(next, size_t{1} << 16);
  }
  if (in.bad()) throw FileError(fmt::format("{}: cannot read to its end", path.string()));
  if (content.size() > maxBytes)
    throw FileError(
        fmt::format("{}: expected at most {} bytes, found more", path.string(), maxBytes));
  return content;
}

StagedFolder::StagedFolder(fs::path target) : m_target(std::move(target)) {
  if (m_target.filename().empty()) m_target = m_target.parent_path();
  std::error_code ec;
  if (fs::exists(m_target, ec) && !fs::is_directory(m_target, ec))
    throw FileError(fmt::format("{}: expected a folder, found a file", m_target.string()));
  // Inside a target that is there: its parent may be closed to the user (a home folder) or lie on
  // another file system (a mount point).
  const bool there = fs::exists(m_target, ec);
  if (!there) createFolder(m_target.parent_path());
  m_staging = besideName(there ? m_target / "" : m_target);
  createFolder(m_staging);
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  fs::remove_all(m_staging, ignored);
}

void StagedFolder::commit() {
  std::error_code ec;
  if (!fs::exists(m_target, ec)) {
    renameOver(m_staging, m_target);
    return;
  }
  createFolder(m_target);
  // Listed first: what a folder lists while files leave it is unspecified.
  std::vector<fs::directory_entry> entries;
  for (fs::recursive_directory_iterator it(m_staging, ec), end; !ec && it != end; it.increment(ec))
    entries.push_back(*it);
  if (ec) throw FileError(fmt::format("{}: cannot list: {}", m_staging.string(), ec.message()));
  const auto placeOf = [this](const fs::directory_entry& entry) {
    return m_target / entry.path().lexically_relative(m_staging);
  };
  // Asked before the first file is moved: what is in the way of one keeps all of them out.
  for (const auto& entry : entries) requireFree(placeOf(entry), entry.is_directory(ec));
  for (const auto& entry : entries) {
    const fs::path to = placeOf(entry);
    if (entry.is_directory(ec))
      createFolder(to);
    else
      renameOver(entry.path(), to);
  }
}

}  // namespace marey
