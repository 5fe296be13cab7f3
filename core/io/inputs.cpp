#include "io/inputs.h"

#include <algorithm>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/clip_io.h"
#include "io/text.h"

namespace marey::io {
namespace fs = std::filesystem;
namespace {

std::vector<fs::path> filesOfFolder(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code ec;
  for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec))
    if (isMotionFile(it->path())) out.push_back(it->path());
  if (ec) throw FileError(fmt::format("{}: cannot list: {}", folder.string(), ec.message()));
  if (out.empty())
    throw InputError({.path = folder.string()}, "a folder with motion files", "none in it");
  std::sort(out.begin(), out.end());
  return out;
}

void requireFile(const fs::path& path, const std::string& namedBy) {
  std::error_code ec;
  if (!fs::exists(path, ec))
    throw FileError(fmt::format("{}{}: no such file", namedBy, path.string()));
}

std::vector<fs::path> filesOfList(const fs::path& list) {
  const std::string text = readFile(list);
  LineReader lines(text, list.string());
  std::vector<fs::path> out;
  while (const auto line = lines.nextFilled()) {
    const std::string_view name = trim(*line);
    if (name.starts_with('#')) continue;
    out.push_back(list.parent_path() / fs::path(std::string(name)));
    requireFile(out.back(), lines.place().text() + ": ");
  }
  if (out.empty())
    throw InputError({.path = list.string()}, "a list with one file name per line", "none in it");
  return out;
}

std::vector<fs::path> filesOf(const std::string& input, const fs::path& folder) {
  if (input.starts_with('@')) return filesOfList(folder / input.substr(1));
  const fs::path path = folder / input;
  requireFile(path, "");
  std::error_code ec;
  if (fs::is_directory(path, ec)) return filesOfFolder(path);
  return {path};
}

}  // namespace

std::vector<fs::path> expandInputs(const std::vector<std::string>& inputs, const fs::path& folder) {
  std::vector<fs::path> out;
  for (const std::string& input : inputs) {
    const std::vector<fs::path> files = filesOf(input, folder);
    out.insert(out.end(), files.begin(), files.end());
  }
  if (out.empty()) throw InputError({.path = "inputs"}, "at least one motion file", "none");
  return out;
}

}  // namespace marey::io
