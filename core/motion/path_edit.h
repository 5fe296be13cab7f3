// Way-points under edit, without any widget: what the top view, the 3D view and the inspector
// change, and the tests.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "motion/path.h"

namespace marey {

/// Slower than this a path would take for ever.
inline constexpr double kSlowestMS = 0.05;
/// Where no way-point says how fast to go (see WayPoint).
inline constexpr double kUsualSpeedMS = 1.2;

/// At least two way-points at any time, with times that rise.
/// Indices are below size(); others throw std::out_of_range.
class PathEdit {
 public:
  /// Throws InputError for fewer than two way-points.
  explicit PathEdit(std::vector<WayPoint> points);

  const std::vector<WayPoint>& points() const { return m_points; }
  size_t size() const { return m_points.size(); }

  /// A new way-point on the line where the place is within `reachM` of it, else behind the last
  /// one. It takes its time and facing from its neighbours where these are fixed. Returns its
  /// index.
  size_t add(double x, double z, double reachM = 0.25);
  void move(size_t index, double x, double z);
  /// What comes after keeps its speed. Returns false, and nothing changes, where only two are left.
  bool remove(size_t index);
  /// How fast to leave the way-point; none: as before it.
  void setSpeed(size_t index, std::optional<double> speedMS);
  /// Heading in radians; none: along the path.
  void setFacing(size_t index, std::optional<double> radians);
  /// Faces a place on the floor; nothing changes where that is the way-point itself.
  void face(size_t index, double x, double z);
  /// Type of the motion from here on; empty: as before it.
  void setType(size_t index, const std::string& type);
  /// When to be there, kept between the times of its neighbours; none: by speed.
  void setTime(size_t index, std::optional<double> timeS);

 private:
  size_t insertInSpan(size_t span, WayPoint point);
  size_t append(WayPoint point);

  std::vector<WayPoint> m_points;
};

/// Pieces of lineThrough from one way-point to the next.
inline constexpr int kPiecesPerSpan = 32;
/// The line through at least two way-points as samplePath draws it, whatever their times.
std::vector<RootFrame> lineThrough(const std::vector<WayPoint>& points);
/// When every way-point is reached, seconds; rises except where fixed times contradict speeds.
std::vector<double> arrivalTimes(const std::vector<WayPoint>& points);

struct LinePlace {
  size_t span = 0;  ///< between way-points span and span + 1
  double distanceM = 0.0;
};
LinePlace nearestOnLine(const std::vector<WayPoint>& points, double x, double z);

/// Way-points every `everyS` along root frames, with their times; with a facing where the root
/// does not face along its way. Throws InputError for fewer than two frames.
std::vector<WayPoint> fitWayPoints(const std::vector<RootFrame>& frames, double fps,
                                   double everyS = 1.0);

}  // namespace marey
