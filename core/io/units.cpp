#include "io/units.h"

#include <algorithm>
#include <cmath>
#include <span>

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
constexpr int kMostFrames = 300;  ///< of a clip that are looked at

int frameStep(const Clip& clip) {
  return std::max(1, clip.frameCount() / kMostFrames);
}

/// Mean length of the bone to every joint; 0 for the root.
std::vector<double> boneLengthsOf(const Clip& clip) {
  std::vector<double> out(clip.skeleton->names.size(), 0.0);
  int frames = 0;
  for (int t = 0; t < clip.frameCount(); t += frameStep(clip), ++frames)
    for (const auto& [parent, child] : clip.skeleton->bones())
      out[static_cast<size_t>(child)] +=
          (clip.at(t, child) - clip.at(t, parent)).cast<double>().norm();
  for (double& length : out) length /= frames;
  return out;
}

/// Length of the bones from `joint` up to (not including) `stop` or the root.
double chainLength(const Skeleton& s, const std::vector<double>& lengths, int joint, int stop) {
  double out = 0.0;
  for (; joint >= 0 && joint != stop; joint = s.parents[static_cast<size_t>(joint)])
    out += lengths[static_cast<size_t>(joint)];
  return out;
}

/// The joint farthest from the hips along the tree that no leg or arm leads to: the head.
double spineLength(const Skeleton& s, const std::vector<double>& lengths,
                   const SkeletonRoles& roles) {
  double out = 0.0;
  for (int j = 0; j < s.jointCount(); ++j)
    if (roles.mirror[static_cast<size_t>(j)] == j && j >= roles.hips)
      out = std::max(out, chainLength(s, lengths, j, roles.hips));
  return out;
}

double largestExtent(std::span<const Vec3> positions) {
  Vec3 low = positions[0], high = positions[0];
  for (const Vec3& p : positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).maxCoeff();
}

/// How far outside of the range a size is, as the logarithm of a factor; 0 inside.
double misfit(double size, const Range& range) {
  return std::max({0.0, std::log(range.low / size), std::log(size / range.high)});
}

std::string unitEvidence(const BodySize& body, const LengthUnit& unit) {
  return fmt::format("{} is {:.4g} units, {:.2f} m if the unit is {}", body.what, body.size,
                     body.size * unit.metres, unit.name);
}

/// Feet are rarer than the others and would claim sizes between them.
constexpr const char* kGuessed[] = {"m", "cm", "cmu", "inch", "mm"};

UnitGuess bestUnit(const BodySize& body) {
  UnitGuess out;
  double best = INFINITY;
  for (const char* name : kGuessed) {
    const LengthUnit& unit = unitByName(name);
    const double miss = misfit(body.size * unit.metres, kPerson);
    if (miss >= best) continue;
    best = miss;
    out = {unit, body.size * unit.metres, body.person && miss == 0.0, {}};
  }
  out.evidence = unitEvidence(body, out.unit);
  return out;
}

Vec3 meanOf(const Clip& clip, int frame, const std::vector<int>& joints) {
  Vec3 out = Vec3::Zero();
  for (const int j : joints) out += clip.at(frame, j);
  return out / static_cast<float>(joints.size());
}

/// From feet to shoulders.
Vec3 bodyAt(const Clip& clip, const SkeletonRoles& roles, int frame) {
  return meanOf(clip, frame, {roles.leftShoulder, roles.rightShoulder}) -
         meanOf(clip, frame, roles.feet);
}

bool hasShoulders(const SkeletonRoles& roles) {
  return roles.leftShoulder >= 0 && roles.rightShoulder >= 0;
}

/// Whether the trunk is over the legs on the average, along whatever axis: people lie for a while,
/// animals never stand.
bool isUpright(const Clip& clip, const SkeletonRoles& roles) {
  if (!hasShoulders(roles)) return true;  // nothing says that it is not
  constexpr float kLeast = 0.5f;          // cosine between legs and trunk
  float sum = 0.0f;
  int frames = 0;
  for (int t = 0; t < clip.frameCount(); t += frameStep(clip), ++frames) {
    const Vec3 hips = meanOf(clip, t, {roles.leftHip, roles.rightHip});
    const Vec3 legs = hips - meanOf(clip, t, roles.feet);
    const Vec3 trunk = meanOf(clip, t, {roles.leftShoulder, roles.rightShoulder}) - hips;
    const float size = legs.norm() * trunk.norm();
    sum += size > 0.0f ? legs.dot(trunk) / size : 1.0f;
  }
  return sum > kLeast * static_cast<float>(frames);
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

BodySize bodySize(const Clip& clip) {
  const Skeleton& s = *clip.skeleton;
  const SkeletonRoles roles = rolesOf(s);
  const std::vector<double> lengths = boneLengthsOf(clip);
  const bool legs = roles.feet.size() == 2 && roles.hasFacing();
  const double leg = legs ? chainLength(s, lengths, roles.feet[0], roles.leftHip) : 0.0;
  const double spine = legs ? spineLength(s, lengths, roles) : 0.0;
  const bool person = leg > 0.0 && spine > 0.0 && !roles.animal && isUpright(clip, roles);
  if (person)
    return {kBodyPerLegAndSpine * (leg + spine), "body size (1.3 x leg plus spine)", true};
  const double rest = largestExtent(restPositions(s));
  if (rest > 0.0) return {rest, "largest extent of the rest pose", false};
  return {largestExtent(clip.frame(0)), "largest extent of the first pose", false};
}

UnitGuess guessUnit(const Clip& clip) {
  const BodySize body = bodySize(clip);
  if (!(body.size > 0.0) || !std::isfinite(body.size))
    return {unitByName("m"), 0.0, false, "the body has no size"};
  return bestUnit(body);
}

UnitGuess checkedUnit(const Clip& clip, const LengthUnit& stated) {
  const BodySize body = bodySize(clip);
  const auto fits = [&body](const LengthUnit& unit) {
    return misfit(body.size * unit.metres, kPerson) == 0.0;
  };
  if (!body.person || fits(stated))
    return {stated, body.size * stated.metres, true, "the file states it"};
  UnitGuess out = bestUnit(body);
  const std::string told = fmt::format(
      "{} is {:.4g} units, {:.2f} m in the unit that the file "
      "states ({})",
      body.what, body.size, body.size * stated.metres, stated.name);
  if (!out.certain)
    return {stated, body.size * stated.metres, false, told + ", and no other makes a person of it"};
  out.evidence = fmt::format("{}, {:.2f} m if the unit is {}", told, out.bodyM, out.unit.name);
  return out;
}

UpGuess guessUp(const Clip& clip) {
  const SkeletonRoles roles = rolesOf(*clip.skeleton);
  if (roles.feet.empty() || !roles.hasFacing() || !hasShoulders(roles))
    return {"y", false, "no feet, hips and shoulders known by name: Y up is assumed"};
  Vec3 body = Vec3::Zero();
  for (int t = 0; t < clip.frameCount(); t += frameStep(clip)) body += bodyAt(clip, roles, t);
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
