#include "io/known_skeletons.h"

namespace marey::io {
namespace {

Skeleton unmeasured(std::vector<std::string> names, std::vector<int> parents) {
  Skeleton out;
  out.offsets.assign(names.size(), Eigen::Vector3f::Zero());
  out.names = std::move(names);
  out.parents = std::move(parents);
  return out;
}

}  // namespace

Skeleton moglowSkeleton() {
  return unmeasured(
      {"Hips",         "LeftUpLeg", "LeftLeg",        "LeftFoot", "LeftToeBase",    "RightUpLeg",
       "RightLeg",     "RightFoot", "RightToeBase",   "Spine",    "Spine1",         "Neck1",
       "Head",         "LeftArm",   "LeftForeArm",    "LeftHand", "LeftHandIndex1", "RightArm",
       "RightForeArm", "RightHand", "RightHandIndex1"},
      {-1, 0, 1, 2, 3, 0, 5, 6, 7, 0, 9, 10, 11, 11, 13, 14, 15, 11, 17, 18, 19});
}

Skeleton dogSkeleton() {
  return unmeasured({"Hips",          "Spine",         "Spine1",    "Neck",          "Head",
                     "HeadSite",      "LeftShoulder",  "LeftArm",   "LeftForeArm",   "LeftHand",
                     "LeftHandSite",  "RightShoulder", "RightArm",  "RightForeArm",  "RightHand",
                     "RightHandSite", "LeftUpLeg",     "LeftLeg",   "LeftFoot",      "LeftFootSite",
                     "RightUpLeg",    "RightLeg",      "RightFoot", "RightFootSite", "Tail",
                     "Tail1",         "Tail1Site"},
                    {-1, 0,  1, 2,  3,  4,  2, 6,  7,  8,  9, 2,  11, 12,
                     13, 14, 0, 16, 17, 18, 0, 20, 21, 22, 0, 24, 25});
}

}  // namespace marey::io
