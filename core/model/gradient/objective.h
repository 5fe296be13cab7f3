// What a training makes smaller, for people, logs and cards.
#pragma once

#include <string>
#include <vector>

namespace marey {

struct Objective {
  std::string name;  ///< "negative log-likelihood", "mean squared error"
  std::string unit;  ///< of a loss: "nats per frame", "squared standard deviations per frame"
  /// Of standardised poses in nats per frame: then it is shown in bits, and held-out clips get a
  /// likelihood.
  bool likelihood = false;
  std::vector<std::string> terms = {};  ///< names of the parts of a loss, where it has any
};

/// The unit in which losses are shown and logged: bits where the objective is a likelihood.
std::string shownUnit(const Objective& objective);
/// A loss in that unit.
double shownLoss(const Objective& objective, double loss);

}  // namespace marey
