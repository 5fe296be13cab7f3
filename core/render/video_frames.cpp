#include <regex>

#include "base/atomic_file.h"
#include "base/error.h"
#include "render/frame_sink.h"

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
  PngSink(const fs::path& path, const Recipe& recipe)
      : m_path(path),
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
    requireNoLaterFrame(m_path, m_count);
    m_folder.commit();
  }

 private:
  fs::path m_path;
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

std::unique_ptr<FrameSink> openPngFrames(const fs::path& path, const Recipe& recipe) {
  return std::make_unique<PngSink>(path, recipe);
}

}  // namespace marey::render
