// What the names of joints say, over the habits of the programs that write them: 'LeftUpLeg',
// 'mixamorig:LeftUpLeg', 'Bip01 L Thigh', 'DEF-thigh.L', 'thigh_l', 'lThigh', 'l_up_leg_JNT',
// 'm_avg_L_Hip', 'UpperLeg_L', 'lfemur'.
#pragma once

#include <string>
#include <vector>

namespace marey {

enum class Side { None, Left, Right };

struct JointName {
  Side side = Side::None;
  std::string part;  ///< lower-case words without the side and without what most names share, glued
                     ///< together: "upleg"
  int mirror = 0;    ///< index of the joint on the other side; its own on the midline
};

/// One for every name. A name has a side only where another one differs from it in the side alone
/// ('lowerback' is not the left of anything).
std::vector<JointName> readJointNames(const std::vector<std::string>& names);

}  // namespace marey
