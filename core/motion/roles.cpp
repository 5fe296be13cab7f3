#include "motion/roles.h"

#include <algorithm>
#include <cctype>
#include <span>
#include <string_view>

#include "base/error.h"
#include "motion/joint_names.h"

namespace marey {
namespace {

/// Names of one part (JointName::part) in order of preference: one that another habit uses for a
/// neighbouring joint comes last.
using Habits = std::span<const std::string_view>;
constexpr std::string_view kUpperLeg[] = {"upleg",     "femur",    "upperleg", "thigh",
                                          "thighbend", "legupper", "hip"};
constexpr std::string_view kUpperArm[] = {"arm",       "humerus", "upperarm", "uparm",   "uarm",
                                          "shldrbend", "shldr",   "armupper", "shoulder"};
constexpr std::string_view kAnkle[] = {"ankle", "foot"};
constexpr std::string_view kHips[] = {"hips", "hip", "pelvis"};
constexpr std::string_view kRoots[] = {"root", "vicon", "jointroot"};
constexpr std::string_view kForePaw[] = {"handsite", "hand", "frontfoot"};
constexpr std::string_view kHindPaw[] = {"footsite", "foot", "hindfoot"};
/// Beginnings of what no person has.
constexpr std::string_view kAnimal[] = {"tail", "paw", "hoof", "wing", "beak", "udder"};

std::string_view withoutNumber(std::string_view part) {
  while (!part.empty() && std::isdigit(static_cast<unsigned char>(part.back())) != 0)
    part.remove_suffix(1);
  return part;
}

/// First joint of the first habit that is there on the given side, or -1; numbered parts
/// ('thigh01') where there is none without a number.
int findPart(const std::vector<JointName>& names, Habits habits, Side side) {
  for (const std::string_view habit : habits)
    for (const bool numbered : {false, true})
      for (size_t j = 0; j < names.size(); ++j) {
        const std::string_view part = names[j].part;
        if (names[j].side == side && habit == (numbered ? withoutNumber(part) : part))
          return static_cast<int>(j);
      }
  return -1;
}

/// The joint that both hang on, or -1.
int commonAncestor(const Skeleton& skeleton, int a, int b) {
  if (a < 0 || b < 0) return -1;
  const auto above = [&skeleton](int joint) {
    return skeleton.parents[static_cast<size_t>(joint)];
  };
  while (a != b && a >= 0 && b >= 0) (a > b ? a : b) = above(std::max(a, b));
  return std::min(a, b);
}

/// Where a limb begins: the last joint of a side on the way from `joint` to the root.
int firstOfLimb(const Skeleton& skeleton, const std::vector<JointName>& names, int joint) {
  int out = -1;
  for (; joint >= 0 && names[static_cast<size_t>(joint)].side != Side::None;
       joint = skeleton.parents[static_cast<size_t>(joint)])
    out = joint;
  return out;
}

int findHips(const Skeleton& skeleton, const std::vector<JointName>& names,
             const SkeletonRoles& roles) {
  if (const int named = findPart(names, kHips, Side::None); named >= 0) return named;
  if (const int both = commonAncestor(skeleton, roles.leftHip, roles.rightHip); both >= 0)
    return both;
  return std::max(0, findPart(names, kRoots, Side::None));
}

/// The four toes of a quadruped: end sites that are joints of the skeleton, else paws. Left first.
std::vector<int> fourFeet(const std::vector<JointName>& names) {
  std::vector<int> out;
  for (const Habits paw : {Habits(kForePaw), Habits(kHindPaw)})
    for (const Side side : {Side::Left, Side::Right})
      if (const int joint = findPart(names, paw, side); joint >= 0) out.push_back(joint);
  return out;
}

bool anyBegins(const std::vector<JointName>& names, std::span<const std::string_view> beginnings) {
  return std::any_of(names.begin(), names.end(), [&](const JointName& name) {
    return std::any_of(beginnings.begin(), beginnings.end(),
                       [&](std::string_view b) { return name.part.starts_with(b); });
  });
}

std::string trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

/// The joint of the longest text up to a comma or the end that is a name (names may hold commas
/// themselves), and where that text ends; -1 and the next comma where there is none.
std::pair<int, size_t> takeJoint(const Skeleton& skeleton, const std::string& text, size_t begin) {
  for (size_t end = text.size(); end != std::string::npos && end >= begin;
       end = end == 0 ? std::string::npos : text.rfind(',', end - 1)) {
    const int joint = skeleton.find(trimmed(std::string_view(text).substr(begin, end - begin)));
    if (joint >= 0) return {joint, end};
  }
  return {-1, std::min(text.find(',', begin), text.size())};
}

}  // namespace

SkeletonRoles rolesOf(const Skeleton& skeleton) {
  const std::vector<JointName> names = readJointNames(skeleton.names);
  SkeletonRoles out;
  for (const JointName& name : names) out.mirror.push_back(name.mirror);
  const int left = findPart(names, kAnkle, Side::Left),
            right = findPart(names, kAnkle, Side::Right);
  const bool ankles = left >= 0 && right >= 0;
  out.leftHip = findPart(names, kUpperLeg, Side::Left);
  out.rightHip = findPart(names, kUpperLeg, Side::Right);
  if (ankles && !out.hasFacing()) {
    out.leftHip = firstOfLimb(skeleton, names, left);
    out.rightHip = firstOfLimb(skeleton, names, right);
  }
  out.leftShoulder = findPart(names, kUpperArm, Side::Left);
  out.rightShoulder = findPart(names, kUpperArm, Side::Right);
  out.hips = findHips(skeleton, names, out);
  out.animal = anyBegins(names, kAnimal);
  const std::vector<int> paws = fourFeet(names);
  out.quadruped = anyBegins(names, std::span(kAnimal).first(1)) && paws.size() == 4;
  if (out.quadruped)
    out.feet = paws;
  else if (ankles)
    out.feet = {left, right};
  return out;
}

std::vector<int> jointsByName(const Skeleton& skeleton, const std::string& commaSeparated) {
  std::vector<int> out;
  for (size_t begin = 0; begin <= commaSeparated.size();) {
    const auto [joint, end] = takeJoint(skeleton, commaSeparated, begin);
    if (joint < 0)
      throwInput({.path = "joint names"}, "one of " + joined(skeleton.names), "'{}'",
                 trimmed(std::string_view(commaSeparated).substr(begin, end - begin)));
    out.push_back(joint);
    begin = end + 1;
  }
  return out;
}

}  // namespace marey
