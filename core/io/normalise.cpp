#include "io/normalise.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "motion/kinematics.h"
#include "motion/roles.h"
#include "motion/rotation.h"

namespace marey::io {
namespace {

/// A quarter turn about X of the whole clip: sign -1 takes +Z to +Y, +1 takes it back.
void turnAboutX(Clip& clip, float sign) {
  const auto turned = [sign](const Vec3& p) { return Vec3(p.x(), -sign * p.z(), sign * p.y()); };
  for (Vec3& p : clip.positions) p = turned(p);
  Skeleton skeleton = *clip.skeleton;
  skeleton.offsets[0] = turned(skeleton.offsets[0]);
  if (!clip.transforms) {  // offsets of clips without rotations are in world axes
    for (size_t j = 1; j < skeleton.offsets.size(); ++j)
      skeleton.offsets[j] = turned(skeleton.offsets[j]);
    for (auto& site : skeleton.endSites) site.offset = turned(site.offset);
  } else {
    const Quat turn(Eigen::AngleAxisf(sign * std::numbers::pi_v<float> / 2.0f, Vec3::UnitX()));
    const auto width = static_cast<size_t>(clip.jointCount());
    for (size_t i = 0; i < clip.transforms->rotations.size(); i += width) {
      clip.transforms->rotations[i] = turn * clip.transforms->rotations[i];
      clip.transforms->translations[i] = turned(clip.transforms->translations[i]);
    }
  }
  clip.skeleton = std::make_shared<const Skeleton>(std::move(skeleton));
}

void applyUnit(Clip& clip, const FormatFacts& facts, const ReadOptions& options) {
  LengthUnit unit;
  if (!options.unit.empty()) {
    unit = unitByName(options.unit);
    clip.source.notes.push_back("unit " + unit.name + " was given");
  } else if (facts.unit && !facts.unitFromFile) {
    unit = *facts.unit;
  } else {
    const UnitGuess guess = facts.unit ? checkedUnit(clip, *facts.unit) : guessUnit(clip);
    unit = guess.unit;
    const bool sure = guess.certain && (!facts.unit || unit.name == facts.unit->name);
    if (!sure || !facts.unit)
      clip.source.notes.push_back(fmt::format(
          "unit {} is {}: {}", unit.name, sure ? "a guess" : "an uncertain guess", guess.evidence));
  }
  clip.source.unit = unit.name;
  clip.source.metresPerUnit = unit.metres;
  scaleLengths(clip, unit.metres);
}

void applyUp(Clip& clip, const FormatFacts& facts, const ReadOptions& options) {
  std::string up = facts.up.value_or("");
  if (!options.up.empty()) {
    up = checkedUp(options.up);
    clip.source.notes.push_back("up axis " + up + " was given");
  } else if (!facts.up) {
    const UpGuess guess = guessUp(clip);
    up = guess.up;
    if (!guess.certain)
      clip.source.notes.push_back("up axis " + up + " is an uncertain guess: " + guess.evidence);
    else if (up != "y")
      clip.source.notes.push_back("up axis " + up + " is a guess: " + guess.evidence);
  }
  clip.source.up = up;
  if (up == "z") turnToYUp(clip);
}

void applyRate(Clip& clip, const ReadOptions& options) {
  if (!options.fps) return;
  clip.source.notes.push_back(
      fmt::format("{:g} frames per second were given in place of {:g}", *options.fps, clip.fps));
  clip.fps = *options.fps;
}

/// Bones of joints that have no offset but stand somewhere by their position channels: the mean of
/// where. Without them the rest pose is a point, and files written from it have no bones.
void takeBonesFromPoses(Clip& clip) {
  const auto width = static_cast<size_t>(clip.jointCount());
  const auto& translations = clip.transforms->translations;
  Skeleton skeleton = *clip.skeleton;
  size_t taken = 0;
  for (size_t j = 1; j < width; ++j) {
    if (!skeleton.offsets[j].isZero(0.0f)) continue;
    Vec3d sum = Vec3d::Zero();
    for (size_t i = j; i < translations.size(); i += width) sum += translations[i].cast<double>();
    skeleton.offsets[j] =
        (sum * (static_cast<double>(width) / static_cast<double>(translations.size())))
            .cast<float>();
    if (!skeleton.offsets[j].isZero(0.0f)) ++taken;
  }
  if (taken == 0) return;
  clip.skeleton = std::make_shared<const Skeleton>(std::move(skeleton));
  clip.source.notes.push_back(
      fmt::format("{} of {} joints have no offset: their bones are those of the poses, on the mean",
                  taken, width));
}

/// A root with one child that stays on the floor below it: a marker of where the body is, which
/// exporters write for games. No body hangs on one bone from the floor.
bool rootIsFloorMarker(const Clip& clip) {
  constexpr float kFloorM = 1e-3f;
  constexpr float kLeastHeightM = 0.2f;
  const auto& parents = clip.skeleton->parents;
  if (parents.size() < 2 || std::count(parents.begin(), parents.end(), 0) != 1) return false;
  float height = 0.0f;
  for (int t = 0; t < clip.frameCount(); ++t) {
    if (std::abs(clip.at(t, 0).y()) > kFloorM) return false;
    height += clip.at(t, 1).y() / static_cast<float>(clip.frameCount());
  }
  return height > kLeastHeightM;
}

/// Gives the motion of the root to its only child, so that the root is static at the origin.
void stillRoot(Clip& clip) {
  const auto width = static_cast<size_t>(clip.jointCount());
  for (size_t i = 0; i < clip.positions.size(); i += width) clip.positions[i].setZero();
  if (!clip.transforms) return;
  auto& [rotations, translations] = *clip.transforms;
  for (size_t i = 0; i < rotations.size(); i += width) {
    translations[i + 1] = translations[i] + rotations[i] * translations[i + 1];
    rotations[i + 1] = rotations[i] * rotations[i + 1];
    translations[i].setZero();
    rotations[i].setIdentity();
  }
}

Clip withoutExtraRoot(Clip clip) {
  const bool marker = rootIsFloorMarker(clip);
  if (marker) stillRoot(clip);
  const int joints = clip.jointCount();
  const std::string name = clip.skeleton->names[0];
  clip = withoutStaticRoot(std::move(clip));
  if (marker && clip.jointCount() < joints)
    clip.source.notes.back() =
        "root joint '" + name + "' stays on the floor below the body: left out, its motion kept";
  return clip;
}

}  // namespace

Clip normalised(Clip clip, const FormatFacts& facts, const ReadOptions& options) {
  if (clip.transforms) clip.positions = forwardKinematics(*clip.skeleton, *clip.transforms);
  validate(clip);
  if (clip.transforms) takeBonesFromPoses(clip);
  applyUnit(clip, facts, options);
  applyUp(clip, facts, options);
  applyRate(clip, options);
  if (options.swapSides) swapSides(clip);
  validate(clip);
  return options.dropStaticRoot ? withoutExtraRoot(std::move(clip)) : clip;
}

void turnToYUp(Clip& clip) {
  turnAboutX(clip, -1.0f);
}
void turnToZUp(Clip& clip) {
  turnAboutX(clip, 1.0f);
}

void swapSides(Clip& clip) {
  const Skeleton& old = *clip.skeleton;
  const std::vector<int> mirror = rolesOf(old).mirror;
  const auto other = [&](int joint) { return mirror[static_cast<size_t>(joint)]; };
  bool any = false;
  for (int j = 0; j < old.jointCount(); ++j) {
    const int parent = old.parents[static_cast<size_t>(j)];
    const int expected = parent < 0 ? -1 : other(parent);
    any = any || other(j) != j;
    if (old.parents[static_cast<size_t>(other(j))] != expected)
      throw InputError({.path = clip.source.path, .item = old.names[static_cast<size_t>(j)]},
                       "the same tree of joints on both sides", "another one on the other side");
  }
  if (!any)
    throw InputError({.path = clip.source.path}, "joints of a left and a right side",
                     "none by their names");
  const auto permute = [&](auto& values) {
    const auto before = values;
    const auto joints = static_cast<size_t>(old.jointCount());
    for (size_t i = 0; i < values.size(); ++i)
      values[i] = before[i - i % joints + static_cast<size_t>(mirror[i % joints])];
  };
  auto body = std::make_shared<Skeleton>(old);
  permute(body->offsets);
  for (Skeleton::EndSite& end : body->endSites) end.parent = other(end.parent);
  clip.skeleton = std::move(body);
  permute(clip.positions);
  if (clip.transforms) {
    permute(clip.transforms->rotations);
    permute(clip.transforms->translations);
  }
  if (!clip.source.eulerOrders.empty()) permute(clip.source.eulerOrders);
  clip.source.notes.push_back("left and right were swapped, as asked for");
}

void scaleLengths(Clip& clip, double factor) {
  if (factor == 1.0) return;
  const auto scale = static_cast<float>(factor);
  for (Vec3& p : clip.positions) p *= scale;
  if (clip.transforms)
    for (Vec3& p : clip.transforms->translations) p *= scale;
  Skeleton skeleton = *clip.skeleton;
  for (Vec3& p : skeleton.offsets) p *= scale;
  for (auto& site : skeleton.endSites) site.offset *= scale;
  clip.skeleton = std::make_shared<const Skeleton>(std::move(skeleton));
}

}  // namespace marey::io
