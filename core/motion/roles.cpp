#include "motion/roles.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <string_view>

#include "base/error.h"

namespace marey {
namespace {

/// Names of one part in lower case without prefix and punctuation, in order of preference: a
/// name that another habit uses for a neighbouring joint comes last. "<s>" is the side as a word,
/// "<l>" as a letter.
using Habits = std::span<const std::string_view>;
constexpr std::string_view kUpperLeg[] = {"<s>upleg",    "<l>femur", "upperleg<l>", "<s>upperleg",
                                          "<l>upperleg", "upleg<l>", "<s>thigh",    "<l>thigh",
                                          "thigh<l>",    "<s>hip",   "<l>hip",      "<l>thighbend"};
constexpr std::string_view kUpperArm[] = {"<s>arm",      "<l>humerus",  "upperarm<l>",
                                          "<s>upperarm", "<l>upperarm", "<l>shldrbend",
                                          "<l>shldr",    "<s>shoulder", "<l>shoulder"};
constexpr std::string_view kAnkle[] = {"<s>ankle", "<l>ankle", "<s>foot", "<l>foot", "foot<l>"};
constexpr std::string_view kHips[] = {"hips", "hip", "pelvis", "root", "vicon", "jointroot"};

/// "mixamorig:LeftUpLeg" -> "leftupleg", "UpperLeg_L" -> "upperlegl".
std::string plainName(const std::string& name) {
  const size_t colon = name.rfind(':');
  std::string out;
  for (const char c : colon == std::string::npos ? name : name.substr(colon + 1))
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

std::string replaced(std::string_view name, size_t at, std::string_view from, std::string_view to) {
  return fmt::format("{}{}{}", name.substr(0, at), to, name.substr(at + from.size()));
}

std::string withSide(std::string_view habit, bool left) {
  std::string out(habit);
  if (const size_t at = out.find("<s>"); at != std::string::npos)
    out = replaced(out, at, "<s>", left ? "left" : "right");
  if (const size_t at = out.find("<l>"); at != std::string::npos)
    out = replaced(out, at, "<l>", left ? "l" : "r");
  return out;
}

/// First joint of the first habit that is there on the given side, or -1.
int findPart(const std::vector<std::string>& plain, Habits habits, bool left) {
  for (const std::string_view habit : habits) {
    const auto it = std::find(plain.begin(), plain.end(), withSide(habit, left));
    if (it != plain.end()) return static_cast<int>(it - plain.begin());
  }
  return -1;
}

/// Names that the joint on the other side may have: words first, then single letters at the start
/// or end of the name proper.
std::vector<std::string> otherSideNames(const std::string& name) {
  static constexpr std::array<std::array<std::string_view, 2>, 3> words = {
      {{"Left", "Right"}, {"left", "right"}, {"LEFT", "RIGHT"}}};
  std::vector<std::string> out;
  for (const auto& pair : words)
    for (int side = 0; side < 2; ++side)
      for (size_t at = name.find(pair[side]); at != std::string::npos;
           at = name.find(pair[side], at + 1))
        out.push_back(replaced(name, at, pair[side], pair[1 - side]));
  const size_t colon = name.rfind(':');
  const size_t start = colon == std::string::npos ? 0 : colon + 1;
  static constexpr std::array<std::string_view, 4> letters = {"L", "R", "l", "r"};
  for (size_t i = 0; i < letters.size(); ++i) {
    const std::string_view letter = letters[i], other = letters[i ^ 1];
    if (name.compare(start, 1, letter) == 0) out.push_back(replaced(name, start, letter, other));
    if (name.size() > start && name.compare(name.size() - 1, 1, letter) == 0)
      out.push_back(replaced(name, name.size() - 1, letter, other));
    for (const char bar : {'_', '.', '-', ' '})  // "Leg_L_end", "c_l_foot"
      if (const size_t at = name.find(fmt::format("{0}{1}{0}", bar, letter));
          at != std::string::npos)
        out.push_back(replaced(name, at + 1, letter, other));
  }
  return out;
}

std::vector<int> mirrorMap(const Skeleton& skeleton) {
  std::vector<int> out(skeleton.names.size());
  for (int j = 0; j < skeleton.jointCount(); ++j) {
    out[static_cast<size_t>(j)] = j;
    for (const std::string& name : otherSideNames(skeleton.names[static_cast<size_t>(j)]))
      if (const int other = skeleton.find(name); other >= 0) {
        out[static_cast<size_t>(j)] = other;
        break;
      }
  }
  // A pair names each other; anything else is a coincidence of letters.
  for (size_t j = 0; j < out.size(); ++j)
    if (out[static_cast<size_t>(out[j])] != static_cast<int>(j)) out[j] = static_cast<int>(j);
  return out;
}

bool contains(const std::vector<std::string>& plain, std::string_view part) {
  return std::any_of(plain.begin(), plain.end(), [part](const std::string& name) {
    return name.find(part) != std::string::npos;
  });
}

/// The four toes: end sites that are joints of the skeleton, else paws. Left first.
std::vector<int> quadrupedFeet(const std::vector<std::string>& plain) {
  static constexpr std::string_view fore[] = {"<s>handsite", "<s>hand", "<s>frontfoot"};
  static constexpr std::string_view hind[] = {"<s>footsite", "<s>foot", "<s>hindfoot"};
  std::vector<int> out;
  for (const Habits paw : {Habits(fore), Habits(hind)})
    for (const bool left : {true, false})
      if (const int joint = findPart(plain, paw, left); joint >= 0) out.push_back(joint);
  return out;
}

std::vector<int> bipedFeet(const std::vector<std::string>& plain) {
  const int left = findPart(plain, kAnkle, true), right = findPart(plain, kAnkle, false);
  if (left < 0 || right < 0) return {};
  return {left, right};
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

}  // namespace

SkeletonRoles rolesOf(const Skeleton& skeleton) {
  std::vector<std::string> plain;
  for (const std::string& name : skeleton.names) plain.push_back(plainName(name));
  SkeletonRoles out;
  out.hips = std::max(0, findPart(plain, kHips, true));
  out.leftHip = findPart(plain, kUpperLeg, true);
  out.rightHip = findPart(plain, kUpperLeg, false);
  out.leftShoulder = findPart(plain, kUpperArm, true);
  out.rightShoulder = findPart(plain, kUpperArm, false);
  out.mirror = mirrorMap(skeleton);
  const std::vector<int> toes = quadrupedFeet(plain);
  out.quadruped = contains(plain, "tail") && toes.size() == 4;
  out.feet = out.quadruped ? toes : bipedFeet(plain);
  return out;
}

std::vector<int> jointsByName(const Skeleton& skeleton, const std::string& commaSeparated) {
  std::vector<int> out;
  size_t begin = 0;
  while (begin <= commaSeparated.size()) {
    const size_t end = std::min(commaSeparated.find(',', begin), commaSeparated.size());
    const std::string name = trimmed(std::string_view(commaSeparated).substr(begin, end - begin));
    const int joint = skeleton.find(name);
    if (joint < 0)
      throwInput({.path = "joint names"}, "one of " + joined(skeleton.names), "'{}'", name);
    out.push_back(joint);
    begin = end + 1;
  }
  return out;
}

}  // namespace marey
