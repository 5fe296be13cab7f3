#include "motion/rotation.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/random.h"

namespace marey {
namespace {

constexpr double kPi = std::numbers::pi;
const char* const kOrders[] = {"XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX",
                               "XYX", "XZX", "YXY", "YZY", "ZXZ", "ZYZ"};

/// Rotation matrices written out by hand, independent of the quaternions under test.
Eigen::Matrix3d byHand(int axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  Eigen::Matrix3d m;
  if (axis == 0) m << 1, 0, 0, 0, c, -s, 0, s, c;
  if (axis == 1) m << c, 0, s, 0, 1, 0, -s, 0, c;
  if (axis == 2) m << c, -s, 0, s, c, 0, 0, 0, 1;
  return m;
}

Eigen::Matrix3d byHand(const Vec3d& angles, const EulerOrder& order) {
  return byHand(order.axes[0], angles[0]) * byHand(order.axes[1], angles[1]) *
         byHand(order.axes[2], angles[2]);
}

Quatd randomRotation(uint32_t index) {
  const RandomKey key{.seed = 7, .sample = index, .stage = RandomStage::Test};
  return Quatd(normalAt(key, 0), normalAt(key, 1), normalAt(key, 2), normalAt(key, 3)).normalized();
}

TEST(Rotation, EulerAnglesInAnyOrderEqualProductsOfMatricesWrittenByHand) {
  const Vec3d angles(0.3, -0.7, 1.9);
  for (const char* text : kOrders) {
    const EulerOrder order = parseEulerOrder(text);
    const Eigen::Matrix3d found = quatFromEuler(angles, order).toRotationMatrix();
    EXPECT_LT((found - byHand(angles, order)).norm(), 1e-12) << text;
  }
}

TEST(Rotation, EulerAnglesOfRandomRotationsRebuildThemInEveryOrder) {
  for (const char* text : kOrders) {
    const EulerOrder order = parseEulerOrder(text);
    for (uint32_t i = 0; i < 200; ++i) {
      const Quatd q = randomRotation(i);
      const Vec3d angles = eulerFromQuat(q, order);
      EXPECT_LT((byHand(angles, order) - q.toRotationMatrix()).norm(), 1e-9) << text << " " << i;
      EXPECT_LE(std::abs(angles[0]), kPi + 1e-12);
      EXPECT_LE(std::abs(angles[2]), kPi + 1e-12);
    }
  }
}

TEST(Rotation, EulerAnglesWithinTheirRangeComeBackAsTheyWere) {
  const EulerOrder order = parseEulerOrder("ZXY");
  const Vec3d angles(2.9, -1.2, -0.4);
  EXPECT_LT((eulerFromQuat(quatFromEuler(angles, order), order) - angles).norm(), 1e-12);
}

TEST(Rotation, EulerAnglesAtAndNearTheSingularityRebuildTheRotation) {
  for (const char* text : kOrders) {
    const EulerOrder order = parseEulerOrder(text);
    const double poles[] = {order.allDifferent() ? kPi / 2 : 0.0,
                            order.allDifferent() ? -kPi / 2 : kPi};
    for (const double pole : poles)
      for (const double off : {0.0, 1e-9, 1e-7, 1e-5, 1e-3}) {
        const Eigen::Matrix3d wanted = byHand({0.4, pole - off, 0.9}, order);
        const Vec3d angles = eulerFromQuat(Quatd(wanted), order);
        EXPECT_TRUE(angles.allFinite());
        EXPECT_LT((byHand(angles, order) - wanted).norm(), 5e-6)
            << text << " " << pole << " " << off;
      }
  }
}

/// Each nearest to the one before.
std::vector<Vec3d> followed(const std::vector<Quatd>& rotations, const EulerOrder& order) {
  std::vector<Vec3d> out{eulerFromQuat(rotations.front(), order)};
  for (size_t i = 1; i < rotations.size(); ++i)
    out.push_back(eulerNear(rotations[i], order, out.back()));
  return out;
}

TEST(Rotation, UnwrappedAnglesFollowTwoFullTurnsWithoutAJump) {
  const EulerOrder order = parseEulerOrder("ZXY");
  std::vector<Quatd> turning;
  for (int i = 0; i <= 200; ++i)
    turning.push_back(quatFromEuler({0.1, 0.2, i * 4 * kPi / 200}, order));
  const std::vector<Vec3d> angles = followed(turning, order);
  for (size_t i = 1; i < angles.size(); ++i)
    EXPECT_LT((angles[i] - angles[i - 1]).norm(), 0.07) << i;
  EXPECT_NEAR(angles.back()[2] - angles.front()[2], 4 * kPi, 1e-9);
}

TEST(Rotation, UnwrappedAnglesPassStraightThroughTheSingularity) {
  const EulerOrder order = parseEulerOrder("ZXY");
  std::vector<Quatd> rotations;
  for (int i = 0; i <= 100; ++i)
    rotations.push_back(quatFromEuler({0.3, i * 0.02 + 0.57, 0.5}, order));
  const std::vector<Vec3d> angles = followed(rotations, order);
  for (size_t i = 0; i < angles.size(); ++i) {
    EXPECT_LT(angleBetween(quatFromEuler(angles[i], order), rotations[i]), 1e-5);
    EXPECT_NEAR(angles[i][1], static_cast<double>(i) * 0.02 + 0.57, 1e-5) << i;
  }
}

TEST(Rotation, AnOrderThatIsNoOrderIsRefused) {
  for (const char* text : {"", "XY", "XXY", "ZYY", "ABC", "XYZX"})
    EXPECT_THROW(parseEulerOrder(text), InputError) << text;
  EXPECT_EQ(parseEulerOrder("zxy").text(), "ZXY");
}

TEST(Rotation, ExponentialMapAgreesWithTheMatrixSeries) {
  const Vec3d v(0.3, -0.5, 0.2);
  Eigen::Matrix3d cross;
  cross << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Identity(), term = Eigen::Matrix3d::Identity();
  for (int n = 1; n < 30; ++n) {
    term = term * cross / n;
    sum += term;
  }
  EXPECT_LT((expMap(v).toRotationMatrix() - sum).norm(), 1e-14);
}

TEST(Rotation, LogarithmUndoesTheExponentialFromTinyToNearlyHalfTurns) {
  const Vec3d axis = Vec3d(1.0, -2.0, 0.5).normalized();
  for (const double angle : {0.0, 1e-12, 1e-8, 9e-5, 1.1e-4, 0.1, 1.0, 3.0, kPi - 1e-6}) {
    const Vec3d v = angle * axis;
    EXPECT_LT((logMap(expMap(v)) - v).norm(), 1e-14 + 1e-9 * angle) << angle;
  }
  const Quatd q = expMap(axis);
  EXPECT_LT((logMap(Quatd(-q.coeffs())) - axis).norm(), 1e-12) << "q and -q are one rotation";
}

TEST(Rotation, ShortestArcTurnsOneDirectionIntoTheOther) {
  const Vec3d a(1.0, 2.0, 3.0);
  for (const Vec3d& b : {Vec3d(0.0, -1.0, 4.0), Vec3d(1.0, 2.0, 3.0), Vec3d(-1.0, -2.0, -3.0)}) {
    const Quatd q = shortestArc(a, b);
    EXPECT_NEAR(q.norm(), 1.0, 1e-12);
    EXPECT_LT((q * a.normalized() - b.normalized()).norm(), 1e-12);
  }
  EXPECT_THROW(shortestArc(Vec3d::Zero(), a), NumericError);
}

}  // namespace
}  // namespace marey
