// The walker's body: its skeleton, the motion of pelvis, trunk, arms and head, and legs by IK.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "motion/clip.h"
#include "motion/walker_foot.h"
#include "motion/walker_noise.h"
#include "motion/walker_plan.h"

namespace marey::walker {

/// Joints of walkerSkeleton() by index: the topology of the human of Henter et al. 2020.
enum Joint {
  Hips,
  LeftUpLeg,
  LeftLeg,
  LeftFoot,
  LeftToeBase,
  RightUpLeg,
  RightLeg,
  RightFoot,
  RightToeBase,
  Spine,
  Spine1,
  Neck,
  Head,
  LeftArm,
  LeftForeArm,
  LeftHand,
  LeftHandIndex,
  RightArm,
  RightForeArm,
  RightHand,
  RightHandIndex,
  JointCount
};

/// What moves the body at one frame.
struct FrameDrive {
  RootFrame root;
  std::array<FootPose, 2> feet;
  double timeS = 0.0;
  double stride = 0.0;  ///< left foot ahead of the right one along the heading, metres, smoothed
  double weight = 0.0;  ///< load on the left (+1) or right (-1) foot, smoothed
  double speed = 0.0;   ///< forward, m/s
  double turn = 0.0;    ///< rad/s
  double spread = 0.0;  ///< horizontal distance of the feet, metres
};

/// All frames of one clip, from drives that have been worked out before.
/// Throws InputError when a leg cannot reach its foot (the path is too fast to be walked).
class Body {
 public:
  Body(const Gait& gait, uint64_t seed, double noise, double beginS, double endS);

  /// Height of the hips at every frame: carried as the gait wants, lowered where a leg would
  /// over-stretch, and smooth.
  std::vector<double> hipHeights(const std::vector<FrameDrive>& drives, double fps) const;
  /// World positions and local transforms of one frame.
  void pose(const FrameDrive& drive, double hipHeight, std::vector<Vec3>& positions,
            JointTransforms& transforms) const;

 private:
  struct Pelvis {
    Eigen::Vector3d floor;  ///< hip position without its height
    Eigen::Quaterniond rotation;
  };
  Pelvis pelvis(const FrameDrive& drive) const;
  double noiseAt(int channel, double timeS) const;
  void poseTrunk(const FrameDrive& drive, std::vector<Eigen::Quaterniond>& local) const;
  void poseArms(const FrameDrive& drive, std::vector<Eigen::Quaterniond>& local) const;

  Gait m_gait;
  double m_noise;
  std::vector<SmoothNoise> m_channels;
};

/// Gaussian smoothing over time, ends held; sigma in frames.
std::vector<double> smoothed(const std::vector<double>& values, double sigmaFrames);

}  // namespace marey::walker
