#include "render/contacts.h"

#include <cmath>

#include "motion/roles.h"

namespace marey::render {

namespace {
double floorSpeed(const Clip& clip, int frame, int joint) {
  const Vec3 step = clip.at(frame, joint) - clip.at(frame - 1, joint);
  return std::hypot(step.x(), step.z()) * clip.fps;
}

Rest restOver(const Clip& clip, int joint, int first, int last) {
  Rest rest{joint, first / clip.fps, last / clip.fps, Vec3::Zero()};
  for (int t = first; t <= last; ++t) rest.place += clip.at(t, joint);
  rest.place /= static_cast<float>(last - first + 1);
  return rest;
}
}  // namespace

std::vector<Rest> feetAtRest(const Clip& clip, double toleranceMS, double shortestS) {
  std::vector<Rest> rests;
  for (const int joint : rolesOf(*clip.skeleton).feet) {
    int first = -1;
    for (int t = 1; t <= clip.frameCount(); ++t) {
      const bool slow = t < clip.frameCount() && floorSpeed(clip, t, joint) < toleranceMS;
      if (slow && first < 0) first = t - 1;
      if (slow || first < 0) continue;
      if ((t - 1 - first) / clip.fps >= shortestS)
        rests.push_back(restOver(clip, joint, first, t - 1));
      first = -1;
    }
  }
  return rests;
}

}  // namespace marey::render
