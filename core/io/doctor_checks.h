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

/// The first frame is far from the second, or is the rest pose and no motion: a pose to calibrate
/// by.
std::optional<Fault> calibrationPose(const Clip& clip);
/// People walk and run with steps that are the shorter the quicker: the stride's length (m) times
/// its duration (s) is about 1.4 at every pace (walk ratio of Sekiya and Nagasaki 1998, 0.0058 m
/// per step and minute). A file of another frame rate than its own is off by the quotient of the
/// rates; what is three times off is told, where a person makes three strides at least.
std::optional<Fault> doubtfulRate(const Clip& clip, const SkeletonRoles& roles);
/// What readers noted that is a fault of the file or a doubt of theirs.
void addReaderFaults(const Clip& clip, std::vector<Fault>& out);

/// All joints jump between two frames.
void checkTeleports(const Clip& clip, std::vector<Fault>& out);
/// One joint leaves its path for one frame. Frames beside a teleport are left to that.
void checkSpikes(const Clip& clip, std::vector<Fault>& out);
/// Runs of equal frames.
void checkRepeats(const Clip& clip, std::vector<Fault>& out);
void checkFloor(const Clip& clip, double floorM, std::vector<Fault>& out);

}  // namespace marey::io
