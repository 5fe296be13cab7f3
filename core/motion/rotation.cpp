#include "motion/rotation.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"

namespace marey {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTurn = 2.0 * kPi;
/// Below this distance (radians) of the middle half-angle from its ends, only a sum or a
/// difference of the outer angles is determined: float32 rotations carry no more.
constexpr double kSingular = 1e-6;

double wrapped(double angle) {
  return std::remainder(angle, kTurn);
}

/// `angle` plus the whole turns that bring it nearest to `target`.
double nearestTurn(double angle, double target) {
  return angle + kTurn * std::round((target - angle) / kTurn);
}

/// Sum and difference of the outer half angles, the middle angle and whether it is singular.
struct HalfAngles {
  double sum = 0.0, difference = 0.0, middle = 0.0;
  bool noDifference = false, noSum = false;
  double sign = 1.0;
  bool tait = true;
};

/// Bernardes & Viollet 2022, algorithm 1. Intrinsic (i, j, k) equals extrinsic (k, j, i).
HalfAngles halfAngles(const Quatd& q, const EulerOrder& order) {
  HalfAngles out;
  const int i = order.axes[2], j = order.axes[1];
  int k = order.axes[0];
  out.tait = i != k;
  if (!out.tait) k = 3 - i - j;
  out.sign = ((i - j) * (j - k) * (k - i)) / 2.0;
  const std::array<double, 3> v = {q.x(), q.y(), q.z()};
  double a = q.w(), b = v[i], c = v[j], d = v[k] * out.sign;
  if (out.tait) {
    a = q.w() - v[j];
    b = v[i] + v[k] * out.sign;
    c = v[j] + q.w();
    d = v[k] * out.sign - v[i];
  }
  const double low = std::hypot(a, b), high = std::hypot(c, d);
  out.middle = 2.0 * std::atan2(high, low);
  out.noDifference = high < kSingular * std::hypot(low, high);
  out.noSum = low < kSingular * std::hypot(low, high);
  out.sum = std::atan2(b, a);
  out.difference = std::atan2(d, c);
  return out;
}

/// Outer angles (first, last of the order) from half sums, in the order's own signs.
Vec3d compose(const HalfAngles& h, double lastExtrinsicFirst, double firstExtrinsicLast) {
  Vec3d out(firstExtrinsicLast, h.middle, lastExtrinsicFirst);
  if (h.tait) {
    out[0] *= h.sign;
    out[1] -= kPi / 2.0;
  }
  return out;
}

Vec3d shifted(const Vec3d& angles, const Vec3d& previous) {
  Vec3d out;
  for (int i = 0; i < 3; ++i) out[i] = nearestTurn(angles[i], previous[i]);
  return out;
}

/// At the singularity: keeps the last angle of `previous` and puts the rest in the first.
Vec3d singularNear(const HalfAngles& h, const Vec3d& previous) {
  const double last = previous[2];
  const double first = h.noDifference ? 2.0 * h.sum - last : 2.0 * h.difference + last;
  return shifted(compose(h, last, first), previous);
}

}  // namespace

std::string EulerOrder::text() const {
  std::string out;
  for (const int axis : axes) out += "XYZ"[axis];
  return out;
}

EulerOrder parseEulerOrder(std::string_view text) {
  const Place place{.path = "Euler order"};
  EulerOrder out;
  const bool sized = text.size() == 3;
  for (size_t i = 0; sized && i < 3; ++i) {
    const size_t axis = std::string_view("XYZxyz").find(text[i]);
    if (axis == std::string_view::npos)
      throwInput(place, "three of the letters X, Y, Z", "'{}'", text);
    out.axes[i] = static_cast<int>(axis % 3);
  }
  if (!sized || out.axes[0] == out.axes[1] || out.axes[1] == out.axes[2])
    throwInput(place, "three axes, neighbours different, such as ZXY", "'{}'", text);
  return out;
}

Quatd axisRotation(int axis, double angle) {
  Quatd out(std::cos(angle / 2.0), 0.0, 0.0, 0.0);
  out.vec()[axis] = std::sin(angle / 2.0);
  return out;
}

Quatd quatFromEuler(const Vec3d& angles, const EulerOrder& order) {
  return axisRotation(order.axes[0], angles[0]) * axisRotation(order.axes[1], angles[1]) *
         axisRotation(order.axes[2], angles[2]);
}

Vec3d eulerFromQuat(const Quatd& rotation, const EulerOrder& order) {
  const HalfAngles h = halfAngles(rotation, order);
  Vec3d out = compose(h, h.sum - h.difference, h.sum + h.difference);
  if (h.noDifference) out = compose(h, 0.0, 2.0 * h.sum);
  if (h.noSum) out = compose(h, 0.0, 2.0 * h.difference);
  out[0] = wrapped(out[0]);
  out[2] = wrapped(out[2]);
  return out;
}

Vec3d eulerNear(const Quatd& rotation, const EulerOrder& order, const Vec3d& previous) {
  const HalfAngles h = halfAngles(rotation, order);
  if (h.noDifference || h.noSum) return singularNear(h, previous);
  const Vec3d plain = eulerFromQuat(rotation, order);
  const double flippedMiddle = order.allDifferent() ? kPi - plain[1] : -plain[1];
  const Vec3d one = shifted(plain, previous);
  const Vec3d two = shifted({plain[0] + kPi, flippedMiddle, plain[2] + kPi}, previous);
  return (one - previous).squaredNorm() <= (two - previous).squaredNorm() ? one : two;
}

Vec3d logMap(const Quatd& rotation) {
  const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
  const Vec3d vector = sign * rotation.vec();
  const double sine = vector.norm();  // of the half angle
  const double w = sign * rotation.w();
  // angle / sin(angle / 2) = 2 + sine^2 / 3 + ... near zero
  const double factor = sine < 1e-4 ? 2.0 + sine * sine / 3.0 : 2.0 * std::atan2(sine, w) / sine;
  return factor * vector;
}

Quatd expMap(const Vec3d& axisAngle) {
  const double angle = axisAngle.norm();
  // sin(angle / 2) / angle = 1/2 - angle^2 / 48 + ... near zero
  const double factor = angle < 1e-4 ? 0.5 - angle * angle / 48.0 : std::sin(angle / 2.0) / angle;
  Quatd out;
  out.w() = std::cos(angle / 2.0);
  out.vec() = factor * axisAngle;
  return out.normalized();
}

Vec3d logNear(const Quatd& rotation, const Vec3d& before) {
  const Vec3d least = logMap(rotation);
  const double angle = least.norm();
  // Whole turns have any axis: that of `before` is the nearest.
  const Vec3d axis = angle > 1e-9 ? Vec3d(least / angle) : before.normalized();
  const double turns = std::round((before.dot(axis) - angle) / kTurn);
  return turns == 0.0 ? least : Vec3d((angle + kTurn * turns) * axis);
}

double angleBetween(const Quatd& a, const Quatd& b) {
  const Quatd difference = a.conjugate() * b;
  return 2.0 * std::atan2(difference.vec().norm(), std::abs(difference.w()));
}

Quatd shortestArc(const Vec3d& from, const Vec3d& to) {
  if (!(from.norm() > 0.0) || !(to.norm() > 0.0))
    throw NumericError("rotation between directions: expected two directions, found a zero vector");
  const Vec3d a = from.normalized(), b = to.normalized();
  const Vec3d half = a + b;
  if (half.norm() < 1e-12) {  // opposite: a half turn about any axis across
    Quatd out(0.0, 0.0, 0.0, 0.0);
    out.vec() = a.unitOrthogonal();
    return out;
  }
  const Vec3d middle = half.normalized();
  Quatd out(a.dot(middle), 0.0, 0.0, 0.0);
  out.vec() = a.cross(middle);
  return out.normalized();
}

}  // namespace marey
