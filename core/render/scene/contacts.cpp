#include "render/scene/contacts.h"

namespace marey::render {

std::vector<Rest> feetAtRest(const Clip& clip, const stats::ContactRule& rule) {
  std::vector<Rest> rests;
  for (const stats::ContactInterval& contact : stats::contactIntervals(clip, rule)) {
    Rest rest{contact.joint, contact.beginS(clip.fps), contact.endS(clip.fps), Vec3::Zero()};
    const int first = contact.firstFrame - 1;
    for (int t = first; t <= contact.lastFrame; ++t) rest.place += clip.at(t, contact.joint);
    rest.place /= static_cast<float>(contact.lastFrame - first + 1);
    rests.push_back(rest);
  }
  return rests;
}

}  // namespace marey::render
