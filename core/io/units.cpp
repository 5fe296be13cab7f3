#include "io/units.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "motion/kinematics.h"
#include "motion/roles.h"

namespace marey::io {
namespace {

/// Foot and head add about 0.3 of hip-to-ankle plus hip-to-head-joint.
constexpr double kBodyPerLegAndSpine = 1.3;
struct Range {
  double low, high;
};
constexpr Range kPerson = {1.2, 2.3};
constexpr Range kAnimal = {0.4, 2.0};

/// Length of the bones from `joint` up to (not including) `stop` or the root.
double chainLength(const Skeleton& s, int joint, int stop) {
  double out = 0.0;
  for (; joint >= 0 && joint != stop; joint = s.parents[static_cast<size_t>(joint)])
    if (s.parents[static_cast<size_t>(joint)] >= 0)
      out += s.offsets[static_cast<size_t>(joint)].norm();
  return out;
}

/// The joint farthest from `from` along the tree that no leg or arm leads to: the head.
double spineLength(const Skeleton& s, const SkeletonRoles& roles) {
  double out = 0.0;
  for (int j = 0; j < s.jointCount(); ++j)
    if (roles.mirror[static_cast<size_t>(j)] == j && j >= roles.hips)
      out = std::max(out, chainLength(s, j, roles.hips));
  return out;
}

double largestExtent(const Skeleton& s) {
  const std::vector<Vec3> rest = restPositions(s);
  Vec3 low = rest[0], high = rest[0];
  for (const Vec3& p : rest) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).maxCoeff();
}

/// How far outside of the range a size is, as the logarithm of a factor; 0 inside.
double misfit(double size, const Range& range) {
  return std::max({0.0, std::log(range.low / size), std::log(size / range.high)});
}

UnitGuess bestUnit(double size, const Range& range, const std::string& what) {
  UnitGuess out;
  double best = INFINITY;
  // Feet are rarer than the others and would claim sizes between them.
  for (const char* name : {"m", "cm", "cmu", "inch", "mm"}) {
    const LengthUnit& unit = unitByName(name);
    const double miss = misfit(size * unit.metres, range);
    if (miss >= best) continue;
    best = miss;
    out = {unit, size * unit.metres, miss == 0.0, {}};
  }
  out.evidence = fmt::format("{} is {:.4g} units, {:.2f} m if the unit is {}", what, size,
                             out.bodyM, out.unit.name);
  return out;
}

Vec3 meanOf(const Clip& clip, int frame, const std::vector<int>& joints) {
  Vec3 out = Vec3::Zero();
  for (const int j : joints) out += clip.at(frame, j);
  return out / static_cast<float>(joints.size());
}

}  // namespace

const std::vector<LengthUnit>& lengthUnits() {
  static const std::vector<LengthUnit> units = {{"m", 1.0},       {"cm", 0.01},
                                                {"mm", 0.001},    {"inch", 0.0254},
                                                {"foot", 0.3048}, {"cmu", 0.0254 / 0.45}};
  return units;
}

const LengthUnit& unitByName(const std::string& name) {
  std::string known;
  for (const LengthUnit& unit : lengthUnits()) {
    if (unit.name == name) return unit;
    known += (known.empty() ? "" : ", ") + unit.name;
  }
  throw UsageError(fmt::format("unit: expected one of {}, found '{}'", known, name));
}

BodySize bodySize(const Skeleton& skeleton) {
  const SkeletonRoles roles = rolesOf(skeleton);
  const bool legs = !roles.feet.empty() && roles.leftHip >= 0;
  const double leg = legs ? chainLength(skeleton, roles.feet[0], roles.leftHip) : 0.0;
  const double spine = legs ? spineLength(skeleton, roles) : 0.0;
  if (roles.quadruped || !(leg > 0.0) || !(spine > 0.0))
    return {largestExtent(skeleton), "largest extent of the rest pose", roles.quadruped};
  return {kBodyPerLegAndSpine * (leg + spine), "body size (1.3 x leg plus spine)", false};
}

UnitGuess guessUnit(const Skeleton& skeleton) {
  const BodySize body = bodySize(skeleton);
  if (!(body.size > 0.0) || !std::isfinite(body.size))
    return {unitByName("m"), 0.0, false, "the rest pose has no size"};
  return bestUnit(body.size, body.quadruped ? kAnimal : kPerson, body.what);
}

UpGuess guessUp(const Clip& clip) {
  const SkeletonRoles roles = rolesOf(*clip.skeleton);
  if (roles.feet.empty() || !roles.hasFacing() || roles.leftShoulder < 0 || roles.rightShoulder < 0)
    return {"y", false, "no feet, hips and shoulders known by name: Y up is assumed"};
  const std::vector<int> trunk = {roles.leftHip, roles.rightHip, roles.leftShoulder,
                                  roles.rightShoulder};
  constexpr int kMostFrames = 300;
  const int step = std::max(1, clip.frameCount() / kMostFrames);
  Vec3 body = Vec3::Zero();
  for (int t = 0; t < clip.frameCount(); t += step)
    body +=
        meanOf(clip, t, {roles.leftShoulder, roles.rightShoulder}) - meanOf(clip, t, roles.feet);
  if (!(body.norm() > 0.0f) || !body.allFinite())
    return {"y", false, "feet and trunk coincide: Y up is assumed"};
  const Vec3 direction = body.normalized();
  const bool zUp = direction.z() > 0.8f;
  return {zUp ? "z" : "y", zUp || direction.y() > 0.8f,
          fmt::format("from feet to trunk the mean direction is ({:.2f}, {:.2f}, {:.2f})",
                      direction.x(), direction.y(), direction.z())};
}

const std::string& checkedUp(const std::string& up) {
  if (up != "y" && up != "z")
    throw UsageError(fmt::format("up axis: expected y or z, found '{}'", up));
  return up;
}

}  // namespace marey::io
