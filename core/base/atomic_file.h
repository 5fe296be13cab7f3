// Output files appear whole or not at all: they are written beside their place and renamed.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>

namespace marey {

/// Writes `path` through `write`; creates missing parent folders. On any failure (an
/// exception of `write`, a full disk) the old file, or none, remains.
/// Throws FileError; exceptions of `write` pass through.
void writeFileAtomically(const std::filesystem::path& path,
                         const std::function<void(std::ostream&)>& write);
void writeFileAtomically(const std::filesystem::path& path, std::string_view content);

/// The whole file. Throws FileError when it cannot be read or is larger than maxBytes.
std::string readFile(const std::filesystem::path& path, size_t maxBytes = size_t{8} << 30);

/// A folder that appears whole or not at all: files go to `path()`, `commit()` moves them
/// into place (replacing files of the same name, leaving others), the destructor of an
/// uncommitted one removes everything.
class StagedFolder {
 public:
  explicit StagedFolder(std::filesystem::path target);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  const std::filesystem::path& path() const { return m_staging; }
  /// Throws FileError.
  void commit();

 private:
  std::filesystem::path m_target;
  std::filesystem::path m_staging;
};

}  // namespace marey
