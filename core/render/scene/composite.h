// Private to the folder: see-through figures put together by depth, and edges smoothed.
#pragma once

#include <vector>

#include "render/base/image.h"
#include "render/scene/offscreen.h"

namespace marey::render {

/// Pictures are drawn at this multiple in both directions and averaged: exact anti-aliasing of
/// edges, also where see-through figures cross.
constexpr int oversampling = 2;
/// More see-through layers than these are merged.
constexpr size_t mostLayers = 8;

/// Figures drawn together without the floor.
struct LayerPicture {
  Rendered picture;
  double opacity = 1.0;
};

/// Lays figures over the floor, pixel by pixel from far to near. All pictures of one size, at most
/// mostLayers + 1 of them. See-through figures in front of solid ones (opacity 1) are laid on
/// thinner, so that what all are compared with stays visible in a crowd.
void composite(Rendered& floor, const std::vector<LayerPicture>& layers);
/// The average of each oversampled pixel, rows turned to run from the top; opaque.
Image shrunk(const Rendered& large);

}  // namespace marey::render
