#include "io/input_hints.h"

#include <algorithm>
#include <vector>

#include "io/text.h"

namespace marey::io {
namespace fs = std::filesystem;
namespace {

/// Entries of a folder that are looked at: a hint is not worth a long search.
constexpr int kMostEntries = 2000;

fs::path orHere(const fs::path& folder) {
  return folder.empty() ? fs::path(".") : folder;
}

std::vector<fs::path> entriesOf(const fs::path& folder, bool folders) {
  std::vector<fs::path> out;
  std::error_code ec;
  int looked = 0;
  for (fs::directory_iterator it(folder, ec), end; !ec && it != end && looked < kMostEntries;
       it.increment(ec), ++looked)
    if (std::error_code none; it->is_directory(none) == folders) out.push_back(it->path());
  std::sort(out.begin(), out.end());
  return out;
}

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
  const fs::path here = orHere(wanted.parent_path());
  std::vector<fs::path> folders = {here};
  // A list beside the folder of its files.
  const fs::path above = orHere(folder) / "..";
  folders.push_back(above);
  for (const fs::path& beside : entriesOf(above, true)) folders.push_back(beside);
  for (const fs::path& one : folders)
    for (const fs::path& file : entriesOf(one, false))
      if (isMeant(file, wanted)) {
        std::error_code ec;
        const fs::path relative = fs::proximate(file, orHere(folder), ec);
        return fmt::format(" (did you mean {}?)", (ec ? file : relative).string());
      }
  return "";
}

}  // namespace marey::io
