// How an export came about, carried inside every picture, video, table and report.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/json.h"

namespace marey::render {

/// (key, value) in the order of writing: version, command, seed, model hash, ...
using Recipe = std::vector<std::pair<std::string, std::string>>;

/// One object; a key that comes twice keeps its last value.
Json toJson(const Recipe& recipe);
/// One line of JSON: what PNG text chunks, SVG metadata and MP4 comments hold.
std::string recipeText(const Recipe& recipe);
/// & < > " as entities, for HTML and SVG text.
std::string escapeXml(const std::string& text);

}  // namespace marey::render
