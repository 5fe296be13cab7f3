#include "render/base/recipe.h"

namespace marey::render {

Json toJson(const Recipe& recipe) {
  Json object = Json::object();
  for (const auto& [key, value] : recipe) object[key] = value;
  return object;
}

std::string recipeText(const Recipe& recipe) {
  return toJson(recipe).dump();
}

std::string escapeXml(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

}  // namespace marey::render
