#include "motion/joint_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <set>
#include <string_view>

namespace marey {
namespace {

using Words = std::vector<std::string>;

bool isUpper(char c) {
  return std::isupper(static_cast<unsigned char>(c)) != 0;
}
bool isLower(char c) {
  return std::islower(static_cast<unsigned char>(c)) != 0;
}
/// Letters, digits and bytes of other scripts.
bool isPartOfWord(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return std::isalnum(byte) != 0 || byte >= 0x80;
}

std::string replacedAll(std::string text, std::string_view from, std::string_view to) {
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

/// "mixamorig:LeftUpLeg" -> left, up, leg; "LHipJoint" -> l, hip, joint.
Words wordsOf(const std::string& name) {
  const size_t space = name.find_last_of(":|");  // name spaces and paths
  std::string text = space == std::string::npos ? name : name.substr(space + 1);
  text = replacedAll(replacedAll(std::move(text), "左", " left "), "右", " right ");
  Words out;
  bool inside = false;
  for (size_t i = 0; i < text.size(); ++i) {
    if (!isPartOfWord(text[i])) {
      inside = false;
      continue;
    }
    const bool hump = i > 0 && isUpper(text[i]) &&
                      (!isUpper(text[i - 1]) || (i + 1 < text.size() && isLower(text[i + 1])));
    if (!inside || hump) out.emplace_back();
    inside = true;
    out.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(text[i])));
  }
  return out;
}

Side sideOfWord(std::string_view word) {
  if (word == "l" || word == "left") return Side::Left;
  return word == "r" || word == "right" ? Side::Right : Side::None;
}

/// Words that most names share say nothing: 'Character1', 'm avg', 'JNT', 'DEF'. Parts of the body
/// are never among them, however many fingers there are.
std::set<std::string> sharedWords(const std::vector<Words>& names) {
  static const std::set<std::string> body = {"hand", "finger", "thumb", "index", "foot", "toe",
                                             "leg",  "arm",    "spine", "tail",  "head", "wing"};
  constexpr size_t kLeastNames = 6;
  std::map<std::string, size_t> counts;
  for (const Words& words : names)
    for (const std::string& word : std::set<std::string>(words.begin(), words.end()))
      ++counts[word];
  std::set<std::string> out;
  for (const auto& [word, count] : counts)
    if (names.size() >= kLeastNames && 2 * count > names.size() && !body.contains(word) &&
        sideOfWord(word) == Side::None)
      out.insert(word);
  return out;
}

/// A way to see a side in a name.
struct Reading {
  Side side = Side::None;
  Words rest;  ///< the words without it
};

/// The side taken off a word, by the `habit`-th habit: the word itself, 'left' in front or at the
/// end, its letter in front or at the end.
constexpr int kHabits = 5;
std::optional<std::pair<Side, std::string>> withoutSide(const std::string& word, int habit) {
  if (habit == 0) {
    if (const Side side = sideOfWord(word); side != Side::None)
      return std::pair{side, std::string()};
    return std::nullopt;
  }
  static constexpr std::array<std::string_view, 2> sides[] = {{"left", "right"}, {"l", "r"}};
  const bool front = habit % 2 == 1;
  for (int k = 0; k < 2; ++k) {
    const std::string_view piece = sides[habit / 3][static_cast<size_t>(k)];
    if (word.size() <= piece.size()) continue;
    const size_t kept = word.size() - piece.size();
    if (front ? word.starts_with(piece) : word.ends_with(piece))
      return std::pair{k == 0 ? Side::Left : Side::Right,
                       front ? word.substr(piece.size()) : word.substr(0, kept)};
  }
  return std::nullopt;
}

std::vector<Reading> readingsOf(const Words& words, int habit) {
  std::vector<Reading> out;
  for (size_t i = 0; i < words.size(); ++i) {
    const auto found = withoutSide(words[i], habit);
    if (!found) continue;
    Reading reading{found->first, words};
    if (found->second.empty())
      reading.rest.erase(reading.rest.begin() + static_cast<long>(i));
    else
      reading.rest[i] = found->second;
    if (!reading.rest.empty()) out.push_back(std::move(reading));
  }
  return out;
}

std::string partOf(const Words& words, const std::set<std::string>& shared) {
  std::string out, all;
  for (const std::string& word : words) {
    all += word;
    if (!shared.contains(word)) out += word;
  }
  return out.empty() ? all : out;
}

/// Pairs the joints that have no side yet and whose names are the same but for a side seen by one
/// habit.
void pairUp(const std::vector<Words>& names, int habit, const std::set<std::string>& shared,
            std::vector<JointName>& out) {
  std::map<Words, std::array<int, 2>> joints;  // left, right; -1: none
  for (size_t j = 0; j < names.size(); ++j) {
    if (out[j].side != Side::None) continue;
    for (const Reading& reading : readingsOf(names[j], habit)) {
      auto& pair = joints.try_emplace(reading.rest, std::array{-1, -1}).first->second;
      int& own = pair[reading.side == Side::Left ? 0 : 1];
      if (own < 0) own = static_cast<int>(j);
    }
  }
  for (const auto& [rest, pair] : joints) {
    if (pair[0] < 0 || pair[1] < 0 || pair[0] == pair[1]) continue;
    auto &left = out[static_cast<size_t>(pair[0])], &right = out[static_cast<size_t>(pair[1])];
    if (left.side != Side::None || right.side != Side::None) continue;
    left = {Side::Left, partOf(rest, shared), pair[1]};
    right = {Side::Right, left.part, pair[0]};
  }
}

}  // namespace

std::vector<JointName> readJointNames(const std::vector<std::string>& names) {
  std::vector<Words> words;
  for (const std::string& name : names) words.push_back(wordsOf(name));
  const std::set<std::string> shared = sharedWords(words);
  std::vector<JointName> out(names.size());
  for (int habit = 0; habit < kHabits; ++habit) pairUp(words, habit, shared, out);
  for (size_t j = 0; j < out.size(); ++j)
    if (out[j].side == Side::None) {
      out[j].part = partOf(words[j], shared);
      out[j].mirror = static_cast<int>(j);
    }
  return out;
}

}  // namespace marey
