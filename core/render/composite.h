// Private to the folder: see-through figures put together by depth, and edges smoothed.
#pragma once

#include <vector>

#include "render/image.h"
#include "render/offscreen.h"

namespace marey::render {

/// Pictures are drawn at this multiple in both directions and averaged: exact anti-aliasing of
/// edges, also where see-through figures cross.
constexpr int oversampling = 2;
/// More see-through layers than these are merged.
constexpr size_t mostLayers = 8;

/// Lays see-through layers over the solid one, pixel by pixel from far to near. All of one size;
/// one opacity per layer, at most `mostLayers`.
void composite(Rendered& base, const std::vector<Rendered>& layers,
               const std::vector<double>& opacity);
/// The average of each oversampled pixel, rows turned to run from the top; opaque.
Image shrunk(const Rendered& large);

}  // namespace marey::render
