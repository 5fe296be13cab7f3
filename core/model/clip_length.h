// The one rule on clips that are too short: what a model sees before a frame (its context) is
// given, and at least one frame is left.
#pragma once

#include "base/error.h"
#include "model/motion_model.h"

namespace marey {

/// Of a clip that is too short; where clips come many at a time, those are left out and counted.
class ShortClipError : public InputError {
 public:
  using InputError::InputError;
};

/// Frames that a clip needs so that one is left after `given` ones.
inline int fewestFrames(int given) {
  return given + 1;
}
/// After the model's context: to be scored.
inline int fewestFrames(const ModelInfo& info) {
  return fewestFrames(info.context);
}

/// Throws ShortClipError naming `place` unless there are `needed` frames at the model's rate.
inline void requireFrames(const ModelInfo& info, int found, int needed, const Place& place) {
  if (found < needed)
    throw ShortClipError(
        place, fmt::format("more than {} frames at {} per second", needed - 1, info.features.fps),
        fmt::format("{}", found));
}

}  // namespace marey
