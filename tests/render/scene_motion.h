// What the tests of scenes share.
#pragma once

#include <memory>
#include <utility>

#include "render/scene/scene.h"

namespace marey::render {

inline constexpr Colour red{0.9, 0.1, 0.1, 1.0}, blue{0.1, 0.2, 0.9, 1.0};

inline SceneMotion motionOf(Clip clip, const Colour& colour, double opacity = 1.0) {
  SceneMotion motion;
  motion.clip = std::make_shared<const Clip>(std::move(clip));
  motion.colour = colour;
  motion.opacity = opacity;
  return motion;
}

}  // namespace marey::render
