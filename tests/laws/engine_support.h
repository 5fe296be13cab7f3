// Sequences that the tests of the engine score.
#pragma once

#include <vector>

#include "model/motion_model.h"

namespace marey {

struct Sequence {
  Matrix poses, controls;
};

/// All of them together, from mean poses.
inline std::vector<SequenceScore> scoresOf(const MotionModel& model,
                                           const std::vector<Sequence>& sequences) {
  std::vector<RolloutState> states;
  std::vector<ObservedSequence> observed;
  for (const Sequence& s : sequences) {
    states.push_back(model.start(1, {}));
    observed.push_back({&s.poses, &s.controls});
  }
  return model.observeMany(states, observed, [] {});
}

}  // namespace marey
