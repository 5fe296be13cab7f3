// The single checks of the import doctor.
#pragma once

#include <optional>
#include <vector>

#include "io/doctor.h"
#include "motion/roles.h"

namespace marey::io {

/// 5 % quantile over frames of the lowest foot joint's height (toes included); none without feet.
std::optional<double> floorHeight(const Clip& clip, const SkeletonRoles& roles);

/// Share of foot-frames near the floor in which the ankle slides faster than 0.5 m/s (2.5 cm per
/// frame at 20 fps, the distance in the rule of Karunratanakul et al. 2023). Near the floor: ankle
/// and toe are at most 2.5 cm (paws: 1 cm) above their own 5 % quantile of height. None without
/// feet, or when no foot is ever near the floor in two successive frames.
std::optional<double> footSkateShare(const Clip& clip, const SkeletonRoles& roles);

BoneDrift boneDrift(const Clip& clip);

/// Whether the hip named left is on the left of where the body faces: forward is from ankles to
/// toes (biped), from hips to neck (quadruped), else where the body moves to.
Finding sidesByGeometry(const Clip& clip, const SkeletonRoles& roles);

/// Naming habit and body plan.
std::string skeletonKind(const Skeleton& skeleton, const SkeletonRoles& roles);

/// All joints jump between two frames.
void checkTeleports(const Clip& clip, std::vector<Fault>& out);
/// One joint leaves its path for one frame. Frames beside a teleport are left to that.
void checkSpikes(const Clip& clip, std::vector<Fault>& out);
/// Runs of equal frames.
void checkRepeats(const Clip& clip, std::vector<Fault>& out);
void checkFloor(const Clip& clip, double floorM, std::vector<Fault>& out);

}  // namespace marey::io
