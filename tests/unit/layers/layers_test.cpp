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
    {"core/nn", {{"base"}, {"torch"}}},
    {"core/model", {{"base", "motion", "nn"}, {"torch"}}},
    {"core/task", {{"base", "motion", "model"}, {}}},
    {"core/experiment", {{"base", "motion", "model", "stats", "io"}, {}}},
    {"core/render",
     {{"base", "motion", "stats"},
      {"VTK::", "PkgConfig::CAIRO", "PkgConfig::PNG", "PkgConfig::EGL", "PkgConfig::LIBAV"}}},
    {"core/report", {{"base", "motion", "io", "stats", "model", "experiment", "render"}, {"ZLIB"}}},
    {"core/cli",
     {{"base", "ranks", "motion", "io", "stats", "nn", "model", "task", "experiment", "render",
       "report", "plugins"},
      {"CLI11", "dl"}}},
    {"plugins", {{"base", "motion", "nn", "model", "plugins"}, {"torch"}}},
    {"gui/shell",
     {{"base", "motion", "io", "stats", "model", "experiment", "render", "report", "plugins"},
      {"marey_qt", "ads::"}}},
    {"gui/plots",
     {{"base", "motion", "io", "stats", "model", "experiment", "render", "report", "shell"},
      {"marey_qt"}}},
    {"gui/panels",
     {{"base", "motion", "io", "stats", "model", "experiment", "render", "report", "shell",
       "plots"},
      {"marey_qt", "VTK::"}}},
    {"gui", {{"base", "nn", "shell", "panels"}, {"marey_qt", "Qt5::", "VTK::"}}},
};

/// "core/io", "plugins/moglow" -> the floor's name in the table; empty when there is none.
std::string floorOf(const std::string& path) {
  std::string longest;
  for (const auto& [folder, floor] : kHouse)
    if ((path == folder || path.starts_with(folder + "/")) && folder.size() > longest.size())
      longest = folder;
  return longest;
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
      const bool house = !folder.empty() &&
                         (folder == here || floor.folders.contains(fs::path(folder).filename()));
      const bool library =
          std::any_of(floor.libraries.begin(), floor.libraries.end(),
                      [&](const std::string& start) { return link.starts_with(start); });
      if (!house && !library) out.push_back(target.name + " (" + here + ") links " + link);
    }
  }
  return out;
}

/// Whether a folder may include a header; `header` as written between quotes or brackets.
bool mayInclude(const std::string& here, const std::string& header) {
  static const std::regex qt("(Qt[A-Za-z0-9]*/.*)|(Q[A-Z][A-Za-z0-9]*)|(q[a-z]+\\.h)");
  const Floor& floor = kHouse.at(here);
  if (std::regex_match(header, qt)) return floor.libraries.contains("marey_qt");
  const bool torch = header.starts_with("torch/") || header.starts_with("ATen/") ||
                     header.starts_with("c10/") || header == "nn/torch.h";
  if (torch) return floor.libraries.contains("torch");
  if (header.starts_with("vtk")) return floor.libraries.contains("VTK::");
  const std::string folder = header.substr(0, header.find('/'));
  if (!kHouse.contains("core/" + folder) && !kHouse.contains("gui/" + folder))
    return true;  // the standard library and others
  return "core/" + folder == here || "gui/" + folder == here || floor.folders.contains(folder);
}

std::vector<std::string> brokenIncludes(const fs::path& file, const std::string& here) {
  static const std::regex include(R"(^\s*#\s*include\s*["<]([^">]+)[">].*)");
  std::vector<std::string> out;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::smatch match;
    if (std::regex_match(line, match, include) && !mayInclude(here, match[1]))
      out.push_back(file.string() + " includes " + match[1].str());
  }
  return out;
}

TEST(LinkLists, GoDownTheHouseOnly) {
  std::ifstream in(MAREY_LINKS_FILE);
  ASSERT_TRUE(in) << MAREY_LINKS_FILE;
  const auto targets = parseTargets(in);
  Names folders;
  for (const auto& target : targets) folders.insert(floorOf(target.folder));
  for (const char* folder : {"core/base", "core/motion", "core/io", "core/stats", "core/nn"})
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

TEST(TheRules, FindIncludesOfQtTorchVtkAndUpperFolders) {
  EXPECT_FALSE(mayInclude("core/cli", "QString"));
  EXPECT_FALSE(mayInclude("core/render", "QtCore/QObject"));
  EXPECT_FALSE(mayInclude("plugins", "qobject.h"));
  EXPECT_FALSE(mayInclude("core/stats", "torch/torch.h"));
  EXPECT_FALSE(mayInclude("core/render", "ATen/ATen.h"));
  EXPECT_FALSE(mayInclude("core/experiment", "nn/torch.h"));
  EXPECT_FALSE(mayInclude("core/report", "vtkRenderer.h"));
  EXPECT_FALSE(mayInclude("core/motion", "io/clip_io.h"));
  EXPECT_FALSE(mayInclude("core/model", "experiment/document.h"));
  EXPECT_TRUE(mayInclude("core/nn", "torch/torch.h"));
  EXPECT_TRUE(mayInclude("core/render", "vtkRenderer.h"));
  EXPECT_TRUE(mayInclude("core/io", "motion/clip.h"));
  EXPECT_FALSE(mayInclude("core/report", "shell/workspace.h"));
  EXPECT_FALSE(mayInclude("gui/shell", "panels/panels.h"));
  EXPECT_FALSE(mayInclude("gui/plots", "vtkRenderer.h"));
  EXPECT_TRUE(mayInclude("gui/shell", "QWidget"));
  EXPECT_TRUE(mayInclude("gui/panels", "shell/workspace.h"));
  EXPECT_TRUE(mayInclude("core/io", "queue"));
  EXPECT_TRUE(mayInclude("core/io", "sys/stat.h"));
}

}  // namespace
}  // namespace marey
