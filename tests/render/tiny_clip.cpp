#include "render/tiny_clip.h"

namespace marey::render {

namespace {
// Hips, left and right leg down to the feet, head.
const std::vector<Vec3> places = {{0, 0.9F, 0},         {0, 0.85F, 0.1F},  {0.1F, 0.45F, 0.1F},
                                  {0, 0.05F, 0.1F},     {0, 0.85F, -0.1F}, {-0.1F, 0.5F, -0.1F},
                                  {-0.3F, 0.1F, -0.1F}, {0.05F, 1.5F, 0}};
}  // namespace

std::shared_ptr<const Skeleton> tinySkeleton() {
  Skeleton skeleton;
  skeleton.names = {"Hips",       "LeftUpLeg", "LeftLeg",   "LeftFoot",
                    "RightUpLeg", "RightLeg",  "RightFoot", "Head"};
  skeleton.parents = {-1, 0, 1, 2, 0, 4, 5, 0};
  for (size_t j = 0; j < places.size(); ++j) {
    const int parent = skeleton.parents[j];
    skeleton.offsets.emplace_back(
        parent < 0 ? places[j] : Vec3(places[j] - places[static_cast<size_t>(parent)]));
  }
  return std::make_shared<const Skeleton>(std::move(skeleton));
}

Clip tinyClip(int frames) {
  Clip clip;
  clip.name = "tiny";
  clip.skeleton = tinySkeleton();
  clip.fps = 10.0;
  for (int t = 0; t < frames; ++t) {
    for (const Vec3& place : places)
      clip.positions.emplace_back(place + Vec3(0.1F * static_cast<float>(t), 0, 0));
  }
  return clip;
}

Clip tinyClipWithRest(int frames, int first, int last) {
  Clip clip = tinyClip(frames);
  for (int t = first; t <= last; ++t) clip.frame(t)[3] = clip.at(first, 3);
  return clip;
}

}  // namespace marey::render
