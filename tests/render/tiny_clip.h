// A hand-made figure of eight joints that slides along +X at 1 m/s without moving its limbs, or
// plants its left foot.
#pragma once

#include <memory>

#include "motion/clip.h"

namespace marey::render {

std::shared_ptr<const Skeleton> tinySkeleton();
/// `frames` at 10 fps; at time t every joint is t metres along +X of its place at the start.
Clip tinyClip(int frames);
/// The same, but the left foot rests at its place in frames [first, last].
Clip tinyClipWithRest(int frames, int first, int last);

}  // namespace marey::render
