#include "experiment/opened_files.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "base/error.h"
#include "base/json.h"

namespace marey {
namespace {

std::string endingOf(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

bool isPathFile(const std::string& file) {
  try {
    const Json content = readJson(file);
    return content.is_object() && content.contains("waypoints");
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

OpenedFiles sortOpened(const std::vector<std::string>& files) {
  OpenedFiles out;
  for (const std::string& file : files) {
    const std::string ending = endingOf(file);
    if (ending == ".json")
      (isPathFile(file) ? out.paths : out.documents).push_back(file);
    else
      (ending == ".marey" ? out.models : out.motions).push_back(file);
  }
  return out;
}

}  // namespace marey
