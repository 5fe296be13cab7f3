#include "shell/motions.h"

#include <algorithm>
#include <cmath>

namespace marey::gui {

FrameSpan framesIn(const Clip& clip, const std::optional<TimeRange>& range) {
  if (!range) return {0, clip.frameCount()};
  // A frame whose time is the range's own end is inside, whatever the rounding.
  constexpr double slack = 1e-9;
  return {std::max(0, static_cast<int>(std::ceil(range->beginS * clip.fps - slack))),
          std::min(clip.frameCount(),
                   static_cast<int>(std::floor(range->endS * clip.fps + slack)) + 1)};
}

}  // namespace marey::gui
