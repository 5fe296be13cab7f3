#include <regex>

#include "base/atomic_file.h"
#include "base/error.h"
#include "render/film/frame_sink.h"

namespace marey::render {
namespace fs = std::filesystem;
namespace {

struct FrameTemplate {
  std::string before, after;
  int digits = 1;

  std::string name(int k) const { return fmt::format("{}{:0{}}{}", before, k, digits, after); }
};

FrameTemplate frameTemplate(const fs::path& path) {
  static const std::regex field(R"(([^{}]*)\{frame(?::0?([1-9]))?\}([^{}]*))");
  const std::string name = path.filename().string();
  const std::string folder = path.parent_path().string();
  std::smatch found;
  if (!std::regex_match(name, found, field) || folder.find('{') != std::string::npos)
    throw UsageError(fmt::format(
        "{}: expected one {{frame}} or {{frame:04}} (1 to 9 digits) in the file's name, found '{}'",
        path.string(), folder.find('{') != std::string::npos ? folder : name));
  return {found[1], found[3], found[2].matched ? std::stoi(found[2]) : 1};
}

class PngSink : public FrameSink {
 public:
  PngSink(const fs::path& path, const VideoFormat& format, const Recipe& recipe)
      : m_path(path),
        m_replaceLonger(format.replaceLonger),
        m_template(frameTemplate(path)),
        m_recipe(recipe),
        m_folder(path.has_parent_path() ? path.parent_path() : fs::path(".")) {}

  void add(const Image& frame) override {
    Recipe recipe = m_recipe;
    recipe.emplace_back("frame", std::to_string(m_count));
    writePng(m_folder.path() / m_template.name(m_count), frame, recipe);
    ++m_count;
  }

  void finish() override {
    if (!m_replaceLonger) requireNoLaterFrame(m_path, m_count);
    m_folder.commit();
    if (!m_replaceLonger) return;
    for (const auto& [number, file] : framesThere(m_path)) {
      std::error_code ec;
      if (number >= m_count && !fs::remove(file, ec) && ec)
        throw FileError(fmt::format("{}: cannot remove: {}", file.string(), ec.message()));
    }
  }

 private:
  fs::path m_path;
  bool m_replaceLonger;
  FrameTemplate m_template;
  Recipe m_recipe;
  StagedFolder m_folder;
  int m_count = 0;
};

}  // namespace

void checkFrameTemplate(const fs::path& path) {
  frameTemplate(path);
}

void requireNoLaterFrame(const fs::path& path, int count) {
  const fs::path next = path.parent_path() / frameTemplate(path).name(count);
  std::error_code ec;
  if (fs::exists(next, ec))
    throwInput({.path = path.string()}, fmt::format("no picture after the {} of this video", count),
               "{}, the rest of a longer one: remove it or choose another name", next.string());
}

std::map<int, fs::path> framesThere(const fs::path& path) {
  std::map<int, fs::path> out;
  if (videoKind(path) != VideoKind::PngFrames) return out;
  const FrameTemplate names = frameTemplate(path);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const size_t fixed = names.before.size() + names.after.size();
  constexpr size_t kMostDigits = 9;
  std::error_code ec;
  for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec)) {
    const std::string name = it->path().filename().string();
    if (name.size() <= fixed || name.size() > fixed + kMostDigits) continue;
    const std::string digits = name.substr(names.before.size(), name.size() - fixed);
    if (digits.find_first_not_of("0123456789") != std::string::npos) continue;
    const int number = std::stoi(digits);
    if (names.name(number) == name) out.emplace(number, it->path());
  }
  return out;
}

std::unique_ptr<FrameSink> openPngFrames(const fs::path& path, const VideoFormat& format,
                                         const Recipe& recipe) {
  return std::make_unique<PngSink>(path, format, recipe);
}

}  // namespace marey::render
