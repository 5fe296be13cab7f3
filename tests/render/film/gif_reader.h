// A reader of GIF files after the specification (GIF89a, CompuServe 1990), independent of the
// library that writes them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "render/base/image.h"

namespace marey::render {

struct Gif {
  int width = 0, height = 0;
  bool endless = false;
  std::vector<Image> frames;    ///< as a player shows them, one laid over the other
  std::vector<int> hundredths;  ///< how long each is shown
};

/// Throws std::runtime_error for what the specification does not allow.
Gif readGif(const std::string& bytes);

}  // namespace marey::render
