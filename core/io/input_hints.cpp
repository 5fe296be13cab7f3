#include "io/input_hints.h"

#include <algorithm>
#include <vector>

#include "io/text.h"

namespace marey::io {
namespace fs = std::filesystem;
namespace {

/// Entries that are looked at: a hint is not worth a long search.
constexpr int kMostEntries = 5000;

fs::path orHere(const fs::path& folder) {
  return folder.empty() ? fs::path(".") : folder;
}

/// The files of folders, one folder after the other, as far as the search goes.
class Search {
 public:
  /// In name order.
  std::vector<fs::path> entriesOf(const fs::path& folder, bool folders) {
    std::vector<fs::path> out;
    std::error_code ec;
    for (fs::directory_iterator it(folder, ec), end; !ec && it != end && m_left > 0;
         it.increment(ec), --m_left)
      if (std::error_code none; it->is_directory(none) == folders) out.push_back(it->path());
    std::sort(out.begin(), out.end());
    return out;
  }

 private:
  int m_left = kMostEntries;
};

bool isMeant(const fs::path& file, const fs::path& wanted) {
  const std::string name = wanted.filename().string();
  return sameIgnoringCase(file.filename().string(), name) ||
         sameIgnoringCase(file.stem().string(), name) ||
         (wanted.has_extension() && sameIgnoringCase(file.stem().string(), wanted.stem().string()));
}

}  // namespace

std::optional<fs::path> otherSpelling(const fs::path& folder, const std::string& name) {
  std::string plain = name;
  if (plain.size() > 2 && (plain.front() == '"' || plain.front() == '\'') &&
      plain.back() == plain.front())
    plain = plain.substr(1, plain.size() - 2);
  std::error_code ec;
  if (plain != name && fs::is_regular_file(folder / plain, ec)) return folder / plain;
  std::replace(plain.begin(), plain.end(), '\\', '/');
  if (plain != name && fs::is_regular_file(folder / plain, ec)) return folder / plain;
  return std::nullopt;
}

std::string nearestName(const fs::path& folder, const std::string& name) {
  const fs::path wanted = folder / name;
  const fs::path here = orHere(folder), above = here / "..";
  Search search;
  std::vector<fs::path> folders = {orHere(wanted.parent_path()), here};
  // Files below a list, or in a folder beside that of the list.
  for (const fs::path& below : search.entriesOf(here, true)) folders.push_back(below);
  folders.push_back(above);
  for (const fs::path& beside : search.entriesOf(above, true)) folders.push_back(beside);
  for (const fs::path& one : folders)
    for (const fs::path& file : search.entriesOf(one, false))
      if (isMeant(file, wanted)) {
        std::error_code ec;
        const fs::path relative = fs::proximate(file, here, ec);
        return fmt::format(" (did you mean {}?)", (ec ? file : relative).string());
      }
  return "";
}

}  // namespace marey::io
