#include "motion/annotations.h"

#include <algorithm>

namespace marey {

Annotations startingAt(Annotations annotations, double seconds) {
  for (LabelSpan& span : annotations.labels) {
    span.fromS -= seconds;
    span.toS -= seconds;
  }
  for (auto& [name, signal] : annotations.signals) signal.startS -= seconds;
  return annotations;
}

}  // namespace marey
