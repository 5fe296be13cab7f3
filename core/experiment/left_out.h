// What a result does not count, and why: one odd file must not stop the others, nor go unseen.
#pragma once

#include <string>
#include <vector>

#include "motion/clip.h"

namespace marey {

struct LeftOut {
  std::string what;  ///< a clip or a system, by name
  std::string why;
};

/// Takes out the clips whose joints are not those that most of the clips have.
std::vector<LeftOut> keepMainBody(std::vector<Clip>& clips);
/// Takes out the clips of these names.
std::vector<LeftOut> dropNamed(std::vector<Clip>& clips, const std::vector<std::string>& names);

}  // namespace marey
