// Names of arrays by number, for inputs of the NPZ fuzz target.
#pragma once

#include <array>

namespace marey {

inline constexpr std::array kFuzzNames = {
    "clips",  "positions", "fps",          "joint_names",  "parents",          "offsets",
    "name",   "rotations", "translations", "euler_orders", "end_site_parents", "end_site_offsets",
    "source", "recipe",    "format",       "joints"};

}  // namespace marey
