// Private to the folder: where on the floor the shadows of a map lie.
#pragma once

#include <vector>

#include "render/scene/soft_shadow.h"

namespace marey::render {

/// Rectangles, side by side and never overlapping, that hold every place that the map shades when
/// it is read with linear interpolation. Most of a floor is unshaded, and need not be drawn.
std::vector<FloorArea> shadedAreas(const ShadowMap& map);

}  // namespace marey::render
