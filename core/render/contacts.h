// Where feet rest: marks on the floor of a picture (not the footstep statistics, which sweep the
// tolerance).
#pragma once

#include <vector>

#include "motion/clip.h"

namespace marey::render {

struct Rest {
  int joint = 0;
  double beginS = 0.0, endS = 0.0;
  Vec3 place = Vec3::Zero();  ///< mean position, world metres
};

/// Times at which a contact joint (rolesOf) moves slower than `toleranceMS` over the floor for
/// `shortestS` or longer; by joint, then by time.
std::vector<Rest> feetAtRest(const Clip& clip, double toleranceMS = 0.25, double shortestS = 0.12);

}  // namespace marey::render
