// Pixels in memory, and PNG files that carry their recipe.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "render/base/colours.h"
#include "render/base/recipe.h"

namespace marey::render {

/// RGBA, 8 bits each, straight (not premultiplied) alpha, sRGB; rows from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<uint8_t> pixels;  ///< height x width x 4

  Image() = default;
  Image(int width, int height, const Colour& fill = {1, 1, 1, 1});
  uint8_t* at(int x, int y) { return pixels.data() + 4 * (static_cast<size_t>(y) * width + x); }
  const uint8_t* at(int x, int y) const {
    return pixels.data() + 4 * (static_cast<size_t>(y) * width + x);
  }
};

/// Lays a picture of the same size over an opaque one. Throws NumericError for another size.
void layOver(Image& below, const Image& above);

/// The bytes of a PNG file; the recipe is its text chunk "marey" (JSON).
/// Throws NumericError for an image without pixels.
std::string encodePng(const Image& image, const Recipe& recipe = {});
/// Written atomically. Throws FileError.
void writePng(const std::filesystem::path& path, const Image& image, const Recipe& recipe = {});

/// Throws FileError, or InputError when it is no PNG.
Image readPng(const std::filesystem::path& path);
Image decodePng(std::string_view bytes, const std::string& origin);
/// The text of chunk "marey" of a PNG, "" where there is none. Throws as readPng does.
std::string pngRecipe(std::string_view bytes, const std::string& origin);

/// RFC 4648 base64, for pictures inside HTML.
std::string base64(std::string_view bytes);

}  // namespace marey::render
