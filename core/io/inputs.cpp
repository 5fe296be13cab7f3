#include "io/inputs.h"

#include <algorithm>
#include <cctype>
#include <set>

#include <fnmatch.h>
#include <sys/stat.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_kind.h"
#include "io/annotation_files.h"
#include "io/clip_io.h"
#include "io/input_hints.h"
#include "io/plain_text.h"
#include "io/text.h"

namespace marey::io {
namespace fs = std::filesystem;
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Lower case, without the dot.
std::string extensionOf(const fs::path& path) {
  const std::string dotted = lower(path.extension().string());
  return dotted.empty() ? dotted : dotted.substr(1);
}

bool isPattern(const std::string& name) {
  return name.find_first_of("*?") != std::string::npos;
}

/// What Marey, the file system or a companion of a clip puts beside clips.
bool isCompanion(const fs::path& path) {
  const std::string name = lower(path.filename().string());
  return name.ends_with(".recipe.json") || name.ends_with(".asf") || name == ".ds_store" ||
         name == "thumbs.db" || name == "desktop.ini";
}

class Finder {
 public:
  explicit Finder(fs::path folder) : m_folder(std::move(folder)) {}

  void add(const std::string& input) {
    if (input.starts_with('@'))
      addList(m_folder / input.substr(1));
    else
      addPath(m_folder, input, "");
  }

  Inputs take() { return std::move(m_out); }

 private:
  /// `namedBy`: place in a list, for errors.
  void addPath(const fs::path& folder, const std::string& name, const std::string& namedBy) {
    const fs::path path = folder / name;
    std::error_code ec;
    if (fs::is_directory(path, ec))
      addFolder(path, "*");
    else if (fs::exists(path, ec))
      addFile(path, true);
    else if (isPattern(path.filename().string()) && fs::is_directory(parentOf(path), ec))
      addFolder(parentOf(path), path.filename().string());
    else if (const auto other = otherSpelling(folder, name))
      addFile(*other, true);
    else
      throw FileError(
          fmt::format("{}{}: no such file{}", namedBy, path.string(), nearestName(folder, name)));
  }

  static fs::path parentOf(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
  }

  void addList(const fs::path& list) {
    std::error_code ec;
    if (!fs::exists(list, ec)) throw FileError(list.string() + ": no such file");
    const std::string bytes = readFile(list);
    const PlainText plain(bytes);
    LineReader lines(plain.text(), list.string());
    bool any = false;
    while (const auto line = lines.nextFilled()) {
      const std::string_view name = trim(*line);
      if (name.starts_with('#')) continue;
      any = true;
      addPath(list.parent_path(), std::string(name), lines.place().text() + ": ");
    }
    if (!any)
      throw InputError({.path = list.string()}, "a list with one file name per line", "none in it");
  }

  void addFile(const fs::path& path, bool named) {
    struct stat status {};
    if (::stat(path.c_str(), &status) == 0) {
      const auto [first, isNew] = m_seen.try_emplace({status.st_dev, status.st_ino}, path);
      if (!isNew) {
        m_out.notRead.push_back({path, first->second == path
                                           ? "given twice: read once"
                                           : "the same file as " + first->second.string()});
        return;
      }
    }
    m_out.files.push_back({path, named});
  }

  /// Its files whose names fit a pattern.
  void addFolder(const fs::path& folder, const std::string& pattern) {
    std::vector<fs::path> entries;
    std::error_code ec;
    for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec))
      if (::fnmatch(pattern.c_str(), it->path().filename().c_str(), 0) == 0)
        entries.push_back(it->path());
    if (ec) throw FileError(fmt::format("{}: cannot list: {}", folder.string(), ec.message()));
    std::sort(entries.begin(), entries.end());
    // Links come last, so that the file itself is read and its other names are named.
    std::stable_partition(entries.begin(), entries.end(),
                          [](const fs::path& p) { return !isLink(p); });
    const size_t before = m_out.files.size() + m_out.notRead.size();
    for (const fs::path& entry : entries) addEntry(entry);
    std::sort(m_out.files.begin() + static_cast<long>(m_first), m_out.files.end(),
              [](const InputFile& a, const InputFile& b) { return a.path < b.path; });
    m_first = m_out.files.size();
    if (m_out.files.size() + m_out.notRead.size() == before)
      throw InputError({.path = (folder / (pattern == "*" ? "" : pattern)).string()},
                       "a folder with motion files", "none in it");
  }

  static bool isLink(const fs::path& path) {
    std::error_code ec;
    return fs::is_symlink(path, ec);
  }

  void addEntry(const fs::path& path) {
    std::error_code ec;
    if (!fs::exists(path, ec)) return addNotRead(path, "a link to nothing");
    if (fs::is_directory(path, ec)) return addSubfolder(path);
    if (!fs::is_regular_file(path, ec) || isCompanion(path) || isAnnotation(path)) return;
    if (!hasReadableExtension(path)) return count(path);
    std::string head;
    try {
      head = readHead(path);
    } catch (const FileError& e) {
      return addNotRead(path, e.what());
    }
    if (formatOfContent(head) != nullptr) return addFile(path, false);
    // A text is a motion by its content alone.
    if (extensionOf(path) == "txt" && looksLikeText(head)) return count(path);
    addNotRead(path, "no motion: " + describeContent(head));
  }

  void addNotRead(const fs::path& path, const std::string& reason) {
    m_out.notRead.push_back({path, reason});
  }

  void addSubfolder(const fs::path& path) {
    int motions = 0;
    std::error_code ec;
    for (fs::recursive_directory_iterator it(path, ec), end; !ec && it != end; it.increment(ec))
      if (std::error_code none; fs::is_regular_file(it->path(), none) && isMotionFile(it->path()))
        ++motions;
    if (motions > 0)
      addNotRead(path, fmt::format("a folder in the folder, with {} motion file{}: give it as well",
                                   motions, motions == 1 ? "" : "s"));
  }

  void count(const fs::path& path) {
    const std::string extension = extensionOf(path);
    ++(isUnreadMotion(extension) ? m_out.otherMotion : m_out.others)[extension];
  }

  fs::path m_folder;
  Inputs m_out;
  size_t m_first = 0;  ///< of the files of the folder that is being read
  std::map<std::pair<dev_t, ino_t>, fs::path> m_seen;
};

std::string counted(const std::map<std::string, int>& files, const std::string& what) {
  int all = 0;
  std::string names;
  for (const auto& [extension, count] : files) {
    all += count;
    names += (names.empty() ? "" : ", ") + (extension.empty() ? "no extension" : extension);
  }
  return fmt::format("{} {}: {}", all, fmt::format(fmt::runtime(what), all == 1 ? "" : "s"), names);
}

}  // namespace

std::vector<fs::path> Inputs::paths() const {
  std::vector<fs::path> out;
  for (const InputFile& file : files) out.push_back(file.path);
  return out;
}

std::vector<std::string> Inputs::remarks() const {
  std::vector<std::string> out;
  for (const NotRead& one : notRead)
    out.push_back(fmt::format("{} is not read: {}", one.path.string(), one.reason));
  if (!otherMotion.empty()) out.push_back(counted(otherMotion, "file{} of other formats"));
  if (!others.empty()) out.push_back(counted(others, "other file{}"));
  return out;
}

void Inputs::addTo(Json& result) const {
  for (const NotRead& one : notRead)
    result["not_read"].push_back({{"path", one.path.string()}, {"reason", one.reason}});
  for (const auto* counts : {&otherMotion, &others})
    for (const auto& [extension, count] : *counts) result["other_files"][extension] = count;
}

Inputs findInputs(const std::vector<std::string>& inputs, const fs::path& folder) {
  Finder finder(folder);
  for (const std::string& input : inputs) finder.add(input);
  Inputs out = finder.take();
  if (!out.files.empty()) return out;
  if (!out.notRead.empty())
    throw InputError({.path = out.notRead.front().path.string()}, "a motion file",
                     out.notRead.front().reason);
  throw InputError({.path = "inputs"}, "at least one motion file", "none");
}

}  // namespace marey::io
