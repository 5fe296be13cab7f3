// Sets of clips that somebody put together: which of them have the same joints.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "motion/skeleton.h"

namespace marey {

/// Whether two skeletons have the same joints: names and parents. Lengths of bones may differ.
bool sameJoints(const Skeleton& a, const Skeleton& b);

/// Index of the first skeleton with the joints that most of them have; of equally many, those that
/// come first. -1 for none.
int mainBody(std::span<const Skeleton* const> skeletons);

/// How the joints of one skeleton differ from those of another, for people: "another skeleton (31
/// joints, 21 wanted)" or "another skeleton (joint 3 is 'Neck', 'Spine1' is wanted)".
std::string otherJoints(const Skeleton& skeleton, const Skeleton& wanted);

}  // namespace marey
