// Private to the folder: soft shadows of many limbs on the floor, quick enough for every frame.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "motion/clip.h"
#include "render/scene/floor_area.h"

namespace marey::render {

/// A limb that casts a shadow; metres. Strength 1 is a solid figure.
struct ShadowLimb {
  Vec3 from, to;
  float radius = 0.03F;
  float strength = 1.0F;
};

/// What is left of the light, 255 being all; row 0 is the edge z0 of the area, column 0 the edge
/// x0. The border is unshaded.
struct ShadowMap {
  FloorArea area;
  int width = 1, height = 1;
  std::vector<uint8_t> light = {255};
};

/// Shadows under a distant light: a point at height h shades the floor at (x, z) + h * slant.
/// Sharp and dark where limbs touch the floor, wide and faint from higher up. Where there are many
/// limbs the map is coarser, so that it takes a few milliseconds at most.
void castSoftShadows(std::span<const ShadowLimb> limbs, const Eigen::Vector2f& slant,
                     ShadowMap& map);

}  // namespace marey::render
