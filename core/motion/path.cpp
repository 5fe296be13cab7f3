#include "motion/path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"

namespace marey {
namespace {

/// Where no way-point says how fast to go.
constexpr double kDefaultSpeedMS = 1.2;
/// Straight pieces that stand for one span of the spline when its length is measured.
constexpr int kPiecesPerSpan = 64;

using Eigen::Vector2d;  // (x, z)

double wrapAngle(double a) {
  return std::remainder(a, 2.0 * std::numbers::pi);
}

Place pointPlace(const std::string& origin, size_t index) {
  return {.path = origin, .item = fmt::format("way-point {}", index + 1)};
}

void checkPoints(const std::vector<WayPoint>& points, const std::string& origin) {
  if (points.size() < 2)
    throwInput({.path = origin}, "at least two way-points", "{}", points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    const WayPoint& p = points[i];
    for (double value : {p.x, p.z, p.timeS.value_or(0.0), p.facing.value_or(0.0)})
      if (!std::isfinite(value))
        throw InputError(pointPlace(origin, i), "finite numbers", "NaN or infinity");
    if (p.speedMS && !(*p.speedMS > 0.0 && std::isfinite(*p.speedMS)))
      throwInput(pointPlace(origin, i), "a positive speed", "{} m/s", *p.speedMS);
  }
}

/// The line through the way-points and the distance walked along it.
class Spline {
 public:
  explicit Spline(const std::vector<WayPoint>& points) {
    for (const WayPoint& p : points) m_points.emplace_back(p.x, p.z);
    m_lengths.push_back(0.0);
    m_starts.push_back(0);
    for (size_t span = 0; span + 1 < m_points.size(); ++span) {
      for (int k = 0; k <= kPiecesPerSpan; ++k) {
        const Vector2d p = inSpan(span, static_cast<double>(k) / kPiecesPerSpan);
        if (!m_line.empty() && k > 0)
          m_lengths.push_back(m_lengths.back() + (p - m_line.back()).norm());
        if (m_line.empty() || k > 0) m_line.push_back(p);
      }
      m_starts.push_back(m_line.size() - 1);
    }
  }

  double lengthAt(size_t point) const { return m_lengths[m_starts[point]]; }

  Vector2d at(double length) const {
    const size_t k = pieceAt(length);
    const double piece = m_lengths[k + 1] - m_lengths[k];
    const double u = piece > 0.0 ? (length - m_lengths[k]) / piece : 0.0;
    return m_line[k] + std::clamp(u, 0.0, 1.0) * (m_line[k + 1] - m_line[k]);
  }

  /// Direction of travel, from a short chord around `length`; `fallback` where all points are one.
  double headingAt(double length, double fallback) const {
    const double reach =
        std::max(1e-4, 2.0 * m_lengths.back() / static_cast<double>(m_line.size()));
    const Vector2d d =
        at(std::min(length + reach, m_lengths.back())) - at(std::max(0.0, length - reach));
    return d.norm() > 1e-9 ? std::atan2(d.x(), d.y()) : fallback;
  }

 private:
  size_t pieceAt(double length) const {
    const auto it = std::upper_bound(m_lengths.begin(), m_lengths.end(), length);
    const auto k = std::max<std::ptrdiff_t>(0, it - m_lengths.begin() - 1);
    return std::min(static_cast<size_t>(k), m_line.size() - 2);
  }

  /// Centripetal Catmull-Rom (Yuksel et al. 2011) by the pyramid of Barry and Goldman; beyond the
  /// ends the neighbour is the mirrored one.
  Vector2d inSpan(size_t span, double u) const {
    const Vector2d& b = m_points[span];
    const Vector2d& c = m_points[span + 1];
    if ((c - b).norm() < 1e-9) return b;
    Vector2d a = span > 0 ? m_points[span - 1] : 2.0 * b - c;
    Vector2d d = span + 2 < m_points.size() ? m_points[span + 2] : 2.0 * c - b;
    if ((a - b).norm() < 1e-9) a = 2.0 * b - c;
    if ((d - c).norm() < 1e-9) d = 2.0 * c - b;
    const double ta = 0.0;
    const double tb = ta + std::sqrt((b - a).norm());
    const double tc = tb + std::sqrt((c - b).norm());
    const double td = tc + std::sqrt((d - c).norm());
    const double t = tb + u * (tc - tb);
    const auto mix = [t](const Vector2d& p, double tp, const Vector2d& q, double tq) -> Vector2d {
      return (tq - t) / (tq - tp) * p + (t - tp) / (tq - tp) * q;
    };
    const Vector2d ab = mix(a, ta, b, tb);
    const Vector2d bc = mix(b, tb, c, tc);
    const Vector2d cd = mix(c, tc, d, td);
    return mix(mix(ab, ta, bc, tc), tb, mix(bc, tb, cd, td), tc);
  }

  std::vector<Vector2d> m_points;
  std::vector<Vector2d> m_line;
  std::vector<double> m_lengths;  ///< up to each point of m_line
  std::vector<size_t> m_starts;   ///< index in m_line of every way-point
};

std::vector<double> arrivalTimes(const std::vector<WayPoint>& points, const Spline& spline,
                                 const std::string& origin) {
  std::vector<double> times = {points[0].timeS.value_or(0.0)};
  double speed = points[0].speedMS.value_or(kDefaultSpeedMS);
  for (size_t i = 1; i < points.size(); ++i) {
    const double length = spline.lengthAt(i) - spline.lengthAt(i - 1);
    times.push_back(points[i].timeS.value_or(times.back() + length / speed));
    if (!(times[i] > times[i - 1]))
      throwInput(pointPlace(origin, i), fmt::format("a time after {} s", times[i - 1]), "{} s",
                 times[i]);
    speed = points[i].speedMS.value_or(speed);
  }
  return times;
}

/// Distance over time: a monotone cubic (Fritsch and Carlson 1980), so that speed has no jumps and
/// the walker never goes back.
class Timing {
 public:
  Timing(std::vector<double> times, std::vector<double> lengths)
      : m_times(std::move(times)), m_lengths(std::move(lengths)) {
    const size_t n = m_times.size();
    std::vector<double> slopes;
    for (size_t i = 0; i + 1 < n; ++i)
      slopes.push_back((m_lengths[i + 1] - m_lengths[i]) / (m_times[i + 1] - m_times[i]));
    m_speeds.push_back(slopes.front());
    for (size_t i = 1; i + 1 < n; ++i) {
      const double h0 = m_times[i] - m_times[i - 1];
      const double h1 = m_times[i + 1] - m_times[i];
      const bool stops = slopes[i - 1] <= 0.0 || slopes[i] <= 0.0;
      const double w0 = 2.0 * h1 + h0;
      const double w1 = h1 + 2.0 * h0;
      m_speeds.push_back(stops ? 0.0 : (w0 + w1) / (w0 / slopes[i - 1] + w1 / slopes[i]));
    }
    m_speeds.push_back(slopes.back());
  }

  size_t spanAt(double timeS) const {
    const auto it = std::upper_bound(m_times.begin(), m_times.end(), timeS);
    const auto k = std::max<std::ptrdiff_t>(0, it - m_times.begin() - 1);
    return std::min(static_cast<size_t>(k), m_times.size() - 2);
  }
  double partOfSpan(size_t span, double timeS) const {
    return (timeS - m_times[span]) / (m_times[span + 1] - m_times[span]);
  }
  double lengthAt(double timeS) const {
    const size_t k = spanAt(timeS);
    const double h = m_times[k + 1] - m_times[k];
    const double u = partOfSpan(k, timeS);
    const double v = 1.0 - u;
    return v * v * (1.0 + 2.0 * u) * m_lengths[k] + u * u * (3.0 - 2.0 * u) * m_lengths[k + 1] +
           h * u * v * (v * m_speeds[k] - u * m_speeds[k + 1]);
  }
  double beginS() const { return m_times.front(); }
  double endS() const { return m_times.back(); }

 private:
  std::vector<double> m_times, m_lengths, m_speeds;
};

/// Heading in a span: along the path, turned towards the facings of its ends where they are given.
double headingIn(const WayPoint& from, const WayPoint& to, double u, double tangent,
                 double tangentFrom, double tangentTo) {
  const double w = u * u * (3.0 - 2.0 * u);
  if (from.facing && to.facing) return *from.facing + w * wrapAngle(*to.facing - *from.facing);
  const double offsetFrom = from.facing ? wrapAngle(*from.facing - tangentFrom) : 0.0;
  const double offsetTo = to.facing ? wrapAngle(*to.facing - tangentTo) : 0.0;
  return tangent + (1.0 - w) * offsetFrom + w * offsetTo;
}

}  // namespace

std::vector<RootFrame> samplePath(const std::vector<WayPoint>& points, double fps,
                                  const std::string& origin) {
  checkPoints(points, origin);
  if (!(fps > 0.0) || !std::isfinite(fps))
    throwInput({.path = origin}, "a positive frame rate", "{}", fps);
  const Spline spline(points);
  std::vector<double> lengths;
  for (size_t i = 0; i < points.size(); ++i) lengths.push_back(spline.lengthAt(i));
  const Timing timing(arrivalTimes(points, spline, origin), lengths);
  std::vector<RootFrame> out;
  const auto frames =
      static_cast<int64_t>(std::floor((timing.endS() - timing.beginS()) * fps + 1e-9));
  for (int64_t i = 0; i <= frames; ++i) {
    const double t = timing.beginS() + static_cast<double>(i) / fps;
    const size_t span = timing.spanAt(t);
    const double length = timing.lengthAt(t);
    const Vector2d place = spline.at(length);
    const double tangent = spline.headingAt(length, 0.0);
    RootFrame frame{place.x(), place.y(),
                    headingIn(points[span], points[span + 1], timing.partOfSpan(span, t), tangent,
                              spline.headingAt(lengths[span], tangent),
                              spline.headingAt(lengths[span + 1], tangent))};
    if (!out.empty())
      frame.heading = out.back().heading + wrapAngle(frame.heading - out.back().heading);
    out.push_back(frame);
  }
  return out;
}

std::vector<LabelSpan> pathLabels(const std::vector<WayPoint>& points, const std::string& origin) {
  checkPoints(points, origin);
  const auto times = arrivalTimes(points, Spline(points), origin);
  std::vector<LabelSpan> out;
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    if (points[i].type.empty() || (!out.empty() && out.back().label == points[i].type)) continue;
    const double fromS = times[i] - times.front();
    if (!out.empty()) out.back().toS = fromS;
    out.push_back({.fromS = fromS, .label = points[i].type});
  }
  return out;
}

}  // namespace marey
