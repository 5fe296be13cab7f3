// Where feet rest: marks on the floor of a picture.
#pragma once

#include <vector>

#include "motion/clip.h"
#include "stats/footsteps.h"

namespace marey::render {

struct Rest {
  int joint = 0;
  double beginS = 0.0, endS = 0.0;
  Vec3 place = Vec3::Zero();  ///< mean position, world metres
};

/// The contacts of a gait diagram with their places; by joint, then by time.
std::vector<Rest> feetAtRest(const Clip& clip, const stats::ContactRule& rule);

}  // namespace marey::render
