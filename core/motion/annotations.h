// What is known of a clip, or wanted of a motion, beside its poses: labels over time and further
// signals. Time 0 is that of the first frame; the frame rate does not matter.
#pragma once

#include <limits>
#include <map>
#include <string>
#include <vector>

namespace marey {

/// A label that holds from one time up to another ("walk", "run", ...).
struct LabelSpan {
  double fromS = 0.0;
  double toS = std::numeric_limits<double>::infinity();
  std::string label;

  bool operator==(const LabelSpan&) const = default;
};

/// Values at a rate of their own: features of speech, of music, of a sensor.
struct Signal {
  double fps = 0.0;
  double startS = 0.0;               ///< time of row 0; may be before the first frame
  std::vector<std::string> columns;  ///< names; "0", "1", ... where a file has none
  std::vector<float> values;         ///< rows x columns, row by row

  int width() const { return static_cast<int>(columns.size()); }
  int rows() const { return columns.empty() ? 0 : static_cast<int>(values.size()) / width(); }
  bool operator==(const Signal&) const = default;
};

struct Annotations {
  std::vector<LabelSpan> labels;  ///< in the order of time, without overlap
  std::map<std::string, Signal> signals;

  bool empty() const { return labels.empty() && signals.empty(); }
  bool operator==(const Annotations&) const = default;
};

/// With time 0 moved to `seconds` (of the old time).
Annotations startingAt(Annotations annotations, double seconds);

}  // namespace marey
