// Private to the folder: the colours behind the figures.
#pragma once

#include "render/base/colours.h"
#include "render/scene/scene.h"

namespace marey::render {

struct Backdrop {
  Colour background, floor, line, ink;
  double shadow = 1.0;  ///< how much of a shadow is seen
};
const Backdrop& backdropOf(Tone tone);

}  // namespace marey::render
