#include "model/gradient/objective.h"

#include <numbers>

namespace marey {

std::string shownUnit(const Objective& objective) {
  return objective.likelihood ? "bits per frame" : objective.unit;
}

double shownLoss(const Objective& objective, double loss) {
  return objective.likelihood ? loss / std::numbers::ln2 : loss;
}

}  // namespace marey
