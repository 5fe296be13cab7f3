// Hand-made clips for tests of statistics.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "motion/clip.h"

namespace marey::stats {

/// A chain of joints ("a", "b", ...) one metre apart upwards.
inline std::shared_ptr<const Skeleton> chainSkeleton(int joints) {
  Skeleton s;
  for (int j = 0; j < joints; ++j) {
    s.names.push_back(std::string(1, static_cast<char>('a' + j)));
    s.parents.push_back(j - 1);
    s.offsets.push_back(j == 0 ? Vec3(0, 0, 0) : Vec3(0, 1, 0));
  }
  return std::make_shared<const Skeleton>(std::move(s));
}

/// One joint moved by the given positions.
inline Clip pointClip(std::vector<Vec3> positions, double fps) {
  Clip clip;
  clip.name = "point";
  clip.skeleton = chainSkeleton(1);
  clip.fps = fps;
  clip.positions = std::move(positions);
  return clip;
}

/// One joint that covers these distances (metres) along x from frame to frame.
inline Clip stepClip(const std::vector<float>& distances, double fps) {
  std::vector<Vec3> positions = {Vec3(0, 0, 0)};
  for (float d : distances) positions.push_back(positions.back() + Vec3(d, 0, 0));
  return pointClip(std::move(positions), fps);
}

}  // namespace marey::stats
