#include "motion/path_edit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"

namespace marey {
namespace {

/// Two way-points in time are at least so far apart.
constexpr double kShortestS = 0.05;
/// A heading this near to the direction of travel counts as along the path.
constexpr double kAlongRad = 12.0 * std::numbers::pi / 180.0;

double wrapAngle(double a) {
  return std::remainder(a, 2.0 * std::numbers::pi);
}

double distance(const WayPoint& a, const WayPoint& b) {
  return std::hypot(a.x - b.x, a.z - b.z);
}

std::vector<double> spanLengths(const std::vector<WayPoint>& points) {
  const std::vector<RootFrame> line = lineThrough(points);
  std::vector<double> out(points.size() - 1, 0.0);
  for (size_t i = 1; i < line.size(); ++i) {
    const size_t span = std::min((i - 1) / kPiecesPerSpan, out.size() - 1);
    out[span] += std::hypot(line[i].x - line[i - 1].x, line[i].z - line[i - 1].z);
  }
  return out;
}

bool anyTimeFrom(const std::vector<WayPoint>& points, size_t first) {
  return std::any_of(points.begin() + static_cast<std::ptrdiff_t>(first), points.end(),
                     [](const WayPoint& p) { return p.timeS.has_value(); });
}

}  // namespace

PathEdit::PathEdit(std::vector<WayPoint> points) : m_points(std::move(points)) {
  if (m_points.size() < 2)
    throwInput({.path = "path"}, "at least two way-points", "{}", m_points.size());
}

size_t PathEdit::add(double x, double z, double reachM) {
  const WayPoint point{.x = x, .z = z, .timeS = {}, .speedMS = {}, .facing = {}};
  const LinePlace place = nearestOnLine(m_points, x, z);
  return place.distanceM <= reachM ? insertInSpan(place.span, point) : append(point);
}

size_t PathEdit::insertInSpan(size_t span, WayPoint point) {
  const WayPoint& from = m_points[span];
  const WayPoint& to = m_points[span + 1];
  const double before = distance(from, point);
  const double share = before / std::max(1e-9, before + distance(point, to));
  if (to.timeS) {
    const std::vector<double> times = arrivalTimes(m_points);
    point.timeS = std::lerp(times[span], times[span + 1], std::clamp(share, 0.02, 0.98));
  }
  if (from.facing && to.facing)
    point.facing = *from.facing + share * wrapAngle(*to.facing - *from.facing);
  m_points.insert(m_points.begin() + static_cast<std::ptrdiff_t>(span) + 1, point);
  return span + 1;
}

size_t PathEdit::append(WayPoint point) {
  WayPoint& last = m_points.back();
  const bool spoken = std::any_of(m_points.begin(), m_points.end(),
                                  [](const WayPoint& p) { return p.speedMS.has_value(); });
  if (last.timeS && !spoken) {
    // Walk on as fast as the last span was walked.
    const std::vector<double> times = arrivalTimes(m_points);
    const double taken = times.back() - times[times.size() - 2];
    const double speed = taken > 0.0 ? spanLengths(m_points).back() / taken : 0.0;
    last.speedMS = speed > kSlowestMS ? speed : kUsualSpeedMS;
  }
  point.facing = last.facing;
  // Two points in one place take no time, which a path does not allow.
  if (distance(last, point) < 0.01) point.x += 0.05;
  m_points.push_back(point);
  return m_points.size() - 1;
}

void PathEdit::move(size_t index, double x, double z) {
  WayPoint& point = m_points.at(index);
  if (!std::isfinite(x) || !std::isfinite(z)) return;
  point.x = x;
  point.z = z;
}

bool PathEdit::remove(size_t index) {
  const WayPoint gone = m_points.at(index);
  if (m_points.size() <= 2) return false;
  if (index + 1 < m_points.size()) {
    WayPoint& next = m_points[index + 1];
    if (!next.speedMS) next.speedMS = gone.speedMS;
    // The path begins at its first way-point's time, which the later times count from.
    if (index == 0 && !next.timeS && anyTimeFrom(m_points, 2))
      next.timeS = arrivalTimes(m_points)[1];
  }
  m_points.erase(m_points.begin() + static_cast<std::ptrdiff_t>(index));
  return true;
}

void PathEdit::setSpeed(size_t index, std::optional<double> speedMS) {
  if (speedMS) speedMS = std::max(kSlowestMS, *speedMS);
  m_points.at(index).speedMS = speedMS;
}

void PathEdit::setFacing(size_t index, std::optional<double> radians) {
  m_points.at(index).facing = radians;
}

void PathEdit::setType(size_t index, const std::string& type) {
  m_points.at(index).type = type;
}

void PathEdit::face(size_t index, double x, double z) {
  const WayPoint& point = m_points.at(index);
  if (x == point.x && z == point.z) return;
  setFacing(index, std::atan2(x - point.x, z - point.z));
}

void PathEdit::setTime(size_t index, std::optional<double> timeS) {
  if (timeS) {
    const std::vector<double> times = arrivalTimes(m_points);
    const double low = index > 0 ? times[index - 1] + kShortestS : 0.0;
    double high = std::numeric_limits<double>::infinity();
    for (size_t i = index + 1; i < m_points.size() && !std::isfinite(high); ++i)
      if (m_points[i].timeS) high = *m_points[i].timeS - kShortestS;
    timeS = std::max(low, std::min(*timeS, high));
  }
  m_points.at(index).timeS = timeS;
}

std::vector<RootFrame> lineThrough(const std::vector<WayPoint>& points) {
  // With one second for every span, samplePath gives the same number of pieces to each.
  std::vector<WayPoint> timed = points;
  for (size_t i = 0; i < timed.size(); ++i) {
    timed[i].timeS = static_cast<double>(i);
    timed[i].speedMS.reset();
  }
  return samplePath(timed, kPiecesPerSpan, "path");
}

std::vector<double> arrivalTimes(const std::vector<WayPoint>& points) {
  const std::vector<double> lengths = spanLengths(points);
  std::vector<double> out = {points.front().timeS.value_or(0.0)};
  double speed = points.front().speedMS.value_or(kUsualSpeedMS);
  for (size_t i = 1; i < points.size(); ++i) {
    out.push_back(points[i].timeS.value_or(out.back() + lengths[i - 1] / speed));
    speed = points[i].speedMS.value_or(speed);
  }
  return out;
}

LinePlace nearestOnLine(const std::vector<WayPoint>& points, double x, double z) {
  const std::vector<RootFrame> line = lineThrough(points);
  LinePlace best{.span = 0, .distanceM = std::numeric_limits<double>::infinity()};
  for (size_t i = 0; i + 1 < line.size(); ++i) {
    const double dx = line[i + 1].x - line[i].x;
    const double dz = line[i + 1].z - line[i].z;
    const double along = (x - line[i].x) * dx + (z - line[i].z) * dz;
    const double u = std::clamp(along / std::max(1e-12, dx * dx + dz * dz), 0.0, 1.0);
    const double away = std::hypot(line[i].x + u * dx - x, line[i].z + u * dz - z);
    if (away < best.distanceM)
      best = {.span = std::min(i / kPiecesPerSpan, points.size() - 2), .distanceM = away};
  }
  return best;
}

std::vector<WayPoint> fitWayPoints(const std::vector<RootFrame>& frames, double fps,
                                   double everyS) {
  if (frames.size() < 2) throwInput({.path = "path"}, "at least two frames", "{}", frames.size());
  const size_t last = frames.size() - 1;
  const auto step = std::max<size_t>(1, static_cast<size_t>(std::lround(everyS * fps)));
  std::vector<WayPoint> out;
  for (size_t i = 0; i <= last;) {
    const RootFrame& at = frames[i];
    WayPoint point{
        .x = at.x, .z = at.z, .timeS = static_cast<double>(i) / fps, .speedMS = {}, .facing = {}};
    const RootFrame& from = frames[i > 0 ? i - 1 : 0];
    const RootFrame& to = frames[std::min(i + 1, last)];
    const double moved = std::hypot(to.x - from.x, to.z - from.z);
    const double heading = std::atan2(to.x - from.x, to.z - from.z);
    const bool moves = moved * fps > 2.0 * kSlowestMS;
    if (!moves || std::abs(wrapAngle(at.heading - heading)) > kAlongRad) point.facing = at.heading;
    out.push_back(point);
    if (i == last) break;
    // The last way-point may be up to half a step further on than the others.
    i = i + step + step / 2 >= last ? last : i + step;
  }
  return out;
}

}  // namespace marey
