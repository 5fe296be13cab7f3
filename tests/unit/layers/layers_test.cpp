// The house has floors: a folder may use those below it, never those above. This test reads the
// link list of every target and the includes of every source.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace marey {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

/// What a folder may use: other folders of the house, and libraries by the start of their name.
struct Floor {
  Names folders;
  Names libraries;
};

const std::map<std::string, Floor> kHouse{
    {"core/base", {{}, {"nlohmann_json", "marey_fmt", "Threads", "PkgConfig::libzip"}}},
    {"core/ranks", {{"base"}, {"Boost::", "MPI::"}}},
    {"core/motion", {{"base"}, {"Eigen3"}}},
    {"core/io", {{"base", "motion"}, {"TinyGLTF"}}},
    {"core/stats", {{"base", "motion"}, {"Boost"}}},
    {"core/pickle", {{"base"}, {}}},
    {"core/nn/engine", {{"base"}, {}}},
    {"core/nn/torch", {{"base", "nn/engine"}, {"torch"}}},
    {"core/nn/flow", {{"base", "nn/engine", "nn/torch"}, {"torch", "Eigen3"}}},
    {"core/nn/processes", {{"base", "nn/torch"}, {"torch"}}},
    {"core/model", {{"base", "motion"}, {}}},
    {"core/model/gradient",
     {{"base", "motion", "model", "nn/engine", "nn/torch", "nn/processes"}, {"torch"}}},
    {"core/task", {{"base", "motion", "model"}, {}}},
    {"core/experiment", {{"base", "motion", "model", "task", "stats", "io"}, {}}},
    {"core/render/base", {{"base", "motion"}, {"PkgConfig::CAIRO", "PkgConfig::PNG"}}},
    {"core/render/scene",
     {{"base", "motion", "stats", "render/base"}, {"VTK::", "PkgConfig::EGL"}}},
    {"core/render/chart", {{"base", "motion", "render/base"}, {"PkgConfig::CAIRO"}}},
    {"core/render/film", {{"base", "motion", "render/base", "render/scene"}, {"PkgConfig::LIBAV"}}},
    {"core/report",
     {{"base", "motion", "io", "stats", "model", "experiment", "render/base", "render/chart",
       "render/scene", "render/film"},
      {"ZLIB"}}},
    {"core/cli",
     {{"base", "ranks", "motion", "io", "stats", "nn/engine", "nn/torch", "model", "model/gradient",
       "task", "experiment", "render/base", "render/film", "render/scene", "report", "plugins"},
      {"CLI11", "dl"}}},
    {"plugins",
     {{"base", "pickle", "motion", "nn/engine", "nn/torch", "nn/flow", "model", "model/gradient",
       "plugins"},
      {"torch"}}},
    {"gui/common", {{"base", "motion", "render/base"}, {"marey_qt"}}},
    {"gui/workspace",
     {{"base", "motion", "stats", "model", "experiment", "plugins", "gui/common"}, {"marey_qt"}}},
    {"gui/plots",
     {{"base", "motion", "stats", "model", "experiment", "render/base", "render/chart", "report",
       "gui/common", "gui/workspace"},
      {"marey_qt"}}},
    {"gui/path",
     {{"base", "motion", "model", "experiment", "render/base", "render/chart", "gui/common",
       "gui/workspace", "gui/plots"},
      {"marey_qt"}}},
    {"gui/scene",
     {{"base", "motion", "stats", "experiment", "render/base", "render/chart", "render/scene",
       "gui/common", "gui/workspace", "gui/plots", "gui/path"},
      {"marey_qt", "VTK::"}}},
    {"gui/steer",
     {{"base", "task", "experiment", "render/base", "gui/common", "gui/workspace"}, {"marey_qt"}}},
    {"gui/training",
     {{"base", "model", "experiment", "render/base", "render/chart", "render/scene", "gui/common",
       "gui/workspace", "gui/plots"},
      {"marey_qt"}}},
    {"gui/time",
     {{"base", "stats", "experiment", "render/base", "render/chart", "gui/common", "gui/workspace",
       "gui/plots"},
      {"marey_qt"}}},
    {"gui/document",
     {{"base", "model", "experiment", "render/base", "gui/common", "gui/workspace"}, {"marey_qt"}}},
    {"gui/exchange",
     {{"base", "io", "experiment", "render/base", "render/scene", "report", "gui/common",
       "gui/workspace", "gui/scene"},
      {"marey_qt"}}},
    {"gui/shell",
     {{"base", "io", "model", "experiment", "report", "plugins", "gui/common", "gui/workspace",
       "gui/plots", "gui/path", "gui/scene", "gui/steer", "gui/training", "gui/time",
       "gui/document", "gui/exchange"},
      {"marey_qt", "ads::"}}},
    {"gui",
     {{"base", "nn/engine", "nn/torch", "gui/scene", "gui/shell"}, {"marey_qt", "Qt5::", "VTK::"}}},
};

/// "core/io", "plugins/moglow" -> the floor's name in the table; empty when there is none.
std::string floorOf(const std::string& path) {
  std::string longest;
  for (const auto& [folder, floor] : kHouse)
    if ((path == folder || path.starts_with(folder + "/")) && folder.size() > longest.size())
      longest = folder;
  return longest;
}

/// As the table's lists name a floor: "io" for "core/io", "gui/path" as it is.
std::string shortName(const std::string& floor) {
  return floor.starts_with("core/") ? floor.substr(5) : floor;
}

/// The floor whose header stands between quotes; empty where no folder has such headers. Those of
/// the core and of families begin with their folder, those of the window with "gui/".
std::string floorOfHeader(const std::string& header) {
  const std::string folder = fs::path(header).parent_path();
  if (folder.empty()) return header == "families.h" ? "plugins" : "";
  if (folder.starts_with("gui/")) return floorOf(folder);
  const std::string core = floorOf("core/" + folder);
  if (!core.empty()) return core;
  return fs::is_directory(fs::path(MAREY_SOURCE_DIR) / "plugins" / folder) ? "plugins" : "";
}

struct Target {
  std::string name;
  std::string folder;
  std::vector<std::string> links;
};

/// One line per target: name, folder, linked libraries.
std::vector<Target> parseTargets(std::istream& in) {
  std::vector<Target> out;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    Target target;
    words >> target.name >> target.folder;
    for (std::string word; words >> word;)
      // Lists that cross folders carry marks such as ::@(0x55...).
      if (!word.starts_with("::@") && word != "libraries-NOTFOUND") target.links.push_back(word);
    if (!target.name.empty()) out.push_back(target);
  }
  return out;
}

std::vector<std::string> brokenLinks(const std::vector<Target>& targets) {
  std::map<std::string, std::string> folderOf;
  for (const auto& target : targets) folderOf[target.name] = floorOf(target.folder);
  std::vector<std::string> out;
  for (const auto& target : targets) {
    const std::string here = floorOf(target.folder);
    if (here.empty()) {
      out.push_back(target.name + " lies in " + target.folder + ", which is not in the table");
      continue;
    }
    const Floor& floor = kHouse.at(here);
    for (const auto& link : target.links) {
      if (link == "marey_settings") continue;
      const auto other = folderOf.find(link);
      const std::string folder = other == folderOf.end() ? "" : other->second;
      const bool house =
          !folder.empty() && (folder == here || floor.folders.contains(shortName(folder)));
      const bool library =
          std::any_of(floor.libraries.begin(), floor.libraries.end(),
                      [&](const std::string& start) { return link.starts_with(start); });
      if (!house && !library) out.push_back(target.name + " (" + here + ") links " + link);
    }
  }
  return out;
}

bool isLibTorch(const std::string& header) {
  return header.starts_with("torch/") || header.starts_with("ATen/") || header.starts_with("c10/");
}

/// Whether a folder may include <header>.
bool mayUse(const std::string& here, const std::string& header) {
  static const std::regex qt("(Qt[A-Za-z0-9]*/.*)|(Q[A-Z][A-Za-z0-9]*)|(q[a-z]+\\.h)");
  const Names& libraries = kHouse.at(here).libraries;
  if (std::regex_match(header, qt)) return libraries.contains("marey_qt");
  if (isLibTorch(header)) return libraries.contains("torch");
  if (header.starts_with("vtk") || header.starts_with("QVTK")) return libraries.contains("VTK::");
  return floorOfHeader(header).empty();  // the house's own stand between quotes
}

/// Whether a folder may include "header".
bool mayInclude(const std::string& here, const std::string& header) {
  const Floor& floor = kHouse.at(here);
  if (header == "nn/torch/torch.h") return floor.libraries.contains("torch");
  const std::string there = floorOfHeader(header);
  return !there.empty() && (there == here || floor.folders.contains(shortName(there)));
}

std::vector<std::string> brokenIncludes(const fs::path& file, const std::string& here) {
  static const std::regex include(R"(^\s*#\s*include\s*(["<])([^">]+)[">].*)");
  std::vector<std::string> out;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::smatch match;
    if (!std::regex_match(line, match, include)) continue;
    const bool may = match[1] == "<" ? mayUse(here, match[2]) : mayInclude(here, match[2]);
    if (!may) out.push_back(file.string() + " includes " + match[2].str());
  }
  return out;
}

TEST(LinkLists, GoDownTheHouseOnly) {
  std::ifstream in(MAREY_LINKS_FILE);
  ASSERT_TRUE(in) << MAREY_LINKS_FILE;
  const auto targets = parseTargets(in);
  Names folders;
  for (const auto& target : targets) folders.insert(floorOf(target.folder));
  for (const char* folder :
       {"core/base", "core/motion", "core/io", "core/stats", "core/nn/engine", "core/nn/flow"})
    EXPECT_TRUE(folders.contains(folder)) << folder << " has no target in the list";
  for (const auto& fault : brokenLinks(targets)) ADD_FAILURE() << fault;
}

TEST(Includes, GoDownTheHouseOnly) {
  size_t count = 0;
  for (const char* top : {"core", "plugins", "gui"}) {
    const fs::path root = fs::path(MAREY_SOURCE_DIR);
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const std::string extension = entry.path().extension();
      if (extension != ".cpp" && extension != ".h") continue;
      const std::string folder = entry.path().parent_path().lexically_relative(root);
      const std::string here = floorOf(folder);
      ASSERT_FALSE(here.empty()) << entry.path() << " lies outside the table";
      for (const auto& fault : brokenIncludes(entry.path(), here)) ADD_FAILURE() << fault;
      ++count;
    }
  }
  EXPECT_GT(count, 100u) << "the sources were not found";
}

/// Families of models: the folders of plugins/.
Names familyNames() {
  Names out;
  for (const auto& entry : fs::directory_iterator(fs::path(MAREY_SOURCE_DIR) / "plugins"))
    if (entry.is_directory()) out.insert(entry.path().filename());
  return out;
}

/// The first family that a line names, be it in another case or as part of an identifier; of words
/// that merely hold its letters ("internName") it is no part.
std::string familyIn(const std::string& line, const Names& families) {
  std::string lower = line;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  const auto letter = [&](size_t at) {
    return at < lower.size() && std::isalpha(static_cast<unsigned char>(lower[at])) != 0;
  };
  for (const std::string& family : families)
    for (size_t at = lower.find(family); at != std::string::npos; at = lower.find(family, at + 1)) {
      const size_t end = at + family.size();
      const bool begins = at == 0 || !letter(at - 1),
                 ends = !letter(end) || std::isupper(static_cast<unsigned char>(line[end])) != 0;
      if (begins && ends) return family;
    }
  return {};
}

TEST(Families, AreNamedInTheirOwnFoldersOnly) {
  const Names families = familyNames();
  ASSERT_GE(families.size(), 2U);
  for (const char* top : {"core", "gui"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(MAREY_SOURCE_DIR) / top)) {
      if (!entry.is_regular_file()) continue;
      std::ifstream in(entry.path());
      int number = 0;
      for (std::string line; std::getline(in, line);) {
        ++number;
        const std::string family = familyIn(line, families);
        if (!family.empty())
          ADD_FAILURE() << entry.path().string() << ":" << number << " names " << family;
      }
    }
}

// The rules themselves, on cases that break them.
TEST(TheRules, FindAFamilysName) {
  const Names families{"moglow", "rnn"};
  EXPECT_EQ(familyIn("  using moglow::family;", families), "moglow");
  EXPECT_EQ(familyIn("Skeleton moglowSkeleton();", families), "moglow");
  EXPECT_EQ(familyIn("// as in MoGlow 2020", families), "moglow");
  EXPECT_EQ(familyIn("if (name == \"rnn\")", families), "rnn");
  EXPECT_EQ(familyIn("internName(x)", families), "");
  EXPECT_EQ(familyIn("turns", families), "");
}

TEST(TheRules, FindALinkUpwardsQtAndUnknownFolders) {
  std::istringstream lines(
      "marey_base core/base marey_fmt marey_motion\n"
      "marey_motion core/motion marey_base Eigen3::Eigen torch marey_settings\n"
      "marey_io core/io marey_motion Qt5::Core\n"
      "marey_new core/new marey_base\n");
  EXPECT_EQ(brokenLinks(parseTargets(lines)),
            (std::vector<std::string>{"marey_base (core/base) links marey_motion",
                                      "marey_motion (core/motion) links torch",
                                      "marey_io (core/io) links Qt5::Core",
                                      "marey_new lies in core/new, which is not in the table"}));
}

TEST(TheRules, FindIncludesOfQtTorchAndVtk) {
  EXPECT_FALSE(mayUse("core/cli", "QString"));
  EXPECT_FALSE(mayUse("core/render/scene", "QtCore/QObject"));
  EXPECT_FALSE(mayUse("plugins", "qobject.h"));
  EXPECT_FALSE(mayUse("core/stats", "torch/torch.h"));
  EXPECT_FALSE(mayUse("core/render/scene", "ATen/ATen.h"));
  EXPECT_FALSE(mayUse("core/report", "vtkRenderer.h"));
  EXPECT_FALSE(mayUse("gui/plots", "vtkRenderer.h"));
  EXPECT_FALSE(mayUse("gui/path", "QVTKOpenGLNativeWidget.h"));
  EXPECT_FALSE(mayUse("core/io", "motion/clip.h")) << "the house's own stand between quotes";
  EXPECT_FALSE(mayUse("core/nn/engine", "torch/torch.h"));
  EXPECT_TRUE(mayUse("core/nn/flow", "torch/torch.h"));
  EXPECT_TRUE(mayUse("core/render/scene", "vtkRenderer.h"));
  EXPECT_FALSE(mayUse("core/render/chart", "vtkRenderer.h"));
  EXPECT_TRUE(mayUse("gui/shell", "QWidget"));
  EXPECT_TRUE(mayUse("core/io", "queue"));
  EXPECT_TRUE(mayUse("core/io", "sys/stat.h"));
}

TEST(TheRules, FindIncludesOfUpperFoldersFamiliesAndUnknownOnes) {
  EXPECT_FALSE(mayInclude("core/experiment", "nn/torch/torch.h"));
  EXPECT_FALSE(mayInclude("core/nn/engine", "nn/torch/torch.h"));
  EXPECT_FALSE(mayInclude("core/nn/engine", "nn/flow/flow_spec.h"));
  EXPECT_FALSE(mayInclude("core/motion", "nn/engine/team.h"));
  EXPECT_TRUE(mayInclude("core/nn/engine", "nn/engine/kernels/kernels.h"));
  EXPECT_FALSE(mayInclude("core/motion", "io/clip_io.h"));
  EXPECT_FALSE(mayInclude("core/model", "experiment/document.h"));
  EXPECT_FALSE(mayInclude("core/report", "gui/workspace/workspace.h"));
  EXPECT_FALSE(mayInclude("core/experiment", "moglow/engine_model.h"));
  EXPECT_FALSE(mayInclude("core/experiment", "families.h"));
  EXPECT_FALSE(mayInclude("gui/path", "moglow/engine_model.h"));
  EXPECT_FALSE(mayInclude("gui/workspace", "gui/shell/panels.h"));
  EXPECT_FALSE(mayInclude("gui/path", "gui/scene/scene_view.h"));
  EXPECT_FALSE(mayInclude("gui/path", "path/path_view.h")) << "no folder of the core";
  EXPECT_FALSE(mayInclude("gui/path", "gui/path_view.h"));
  EXPECT_TRUE(mayInclude("core/io", "motion/clip.h"));
  EXPECT_FALSE(mayInclude("core/render/base", "render/scene/bodies.h"));
  EXPECT_FALSE(mayInclude("core/render/chart", "render/scene/bodies.h"));
  EXPECT_TRUE(mayInclude("core/render/chart", "render/base/image.h"));
  EXPECT_TRUE(mayInclude("core/cli", "families.h"));
  EXPECT_TRUE(mayInclude("plugins", "moglow/engine_model.h"));
  EXPECT_TRUE(mayInclude("gui/scene", "gui/workspace/workspace.h"));
  EXPECT_TRUE(mayInclude("gui/path", "motion/path.h"));
}

}  // namespace
}  // namespace marey
