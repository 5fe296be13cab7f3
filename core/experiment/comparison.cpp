#include "experiment/comparison.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"

namespace marey {
namespace {

constexpr std::array<std::pair<NaturalChoice, const char*>, 3> kNames = {
    {{NaturalChoice::SameControl, "same-control"},
     {NaturalChoice::SameStyle, "same-style"},
     {NaturalChoice::All, "all"}}};

std::string described(NaturalChoice choice, size_t clips, size_t all) {
  const char* plural = clips == 1 ? "" : "s";
  if (choice == NaturalChoice::All || clips == all)
    return fmt::format("all {} natural clip{}", clips, plural);
  const char* which = choice == NaturalChoice::SameControl ? "whose control was followed"
                                                           : "of the styles that were followed";
  return fmt::format("the {} of {} natural clips {}", clips, all, which);
}

}  // namespace

NaturalChoice naturalChoiceByName(std::string_view name) {
  std::string known;
  for (const auto& [choice, text] : kNames) {
    if (name == text) return choice;
    known += (known.empty() ? "" : ", ") + std::string(text);
  }
  throw UsageError(
      fmt::format("natural motion to compare with: expected one of {}, found '{}'", known, name));
}

const char* nameOf(NaturalChoice choice) {
  const auto found = std::find_if(kNames.begin(), kNames.end(),
                                  [&](const auto& entry) { return entry.first == choice; });
  return found->second;
}

std::string styleOf(const std::string& clipName) {
  size_t end = clipName.size();
  while (end > 0 && std::isdigit(static_cast<unsigned char>(clipName[end - 1])) != 0) --end;
  while (end > 0 && std::string_view("_-. #").find(clipName[end - 1]) != std::string_view::npos)
    --end;
  return end == 0 ? clipName : clipName.substr(0, end);
}

ComparedNatural naturalToCompare(const std::vector<std::string>& naturalNames,
                                 const std::vector<int>& follows, NaturalChoice choice) {
  std::set<size_t> followed;
  std::set<std::string> styles;
  for (const int clip : follows) {
    if (clip < 0 || static_cast<size_t>(clip) >= naturalNames.size()) continue;
    followed.insert(static_cast<size_t>(clip));
    styles.insert(styleOf(naturalNames[static_cast<size_t>(clip)]));
  }
  ComparedNatural out{.choice = choice};
  for (size_t i = 0; i < naturalNames.size(); ++i)
    if (choice == NaturalChoice::All ||
        (choice == NaturalChoice::SameControl && followed.contains(i)) ||
        (choice == NaturalChoice::SameStyle && styles.contains(styleOf(naturalNames[i]))))
      out.clips.push_back(i);
  if (out.clips.empty() && !naturalNames.empty())
    throw UsageError(fmt::format(
        "natural motion of '{}': expected motions along the control of natural clips, found none; "
        "compare with 'all'",
        nameOf(choice)));
  out.leftOut = naturalNames.size() - out.clips.size();
  out.text = described(choice, out.clips.size(), naturalNames.size());
  return out;
}

ComparedNatural naturalToCompare(const std::vector<Clip>& natural, const std::vector<int>& follows,
                                 NaturalChoice choice) {
  std::vector<std::string> names;
  for (const Clip& clip : natural) names.push_back(clip.name);
  return naturalToCompare(names, follows, choice);
}

std::vector<int> heldOutControls(const SystemResult& system, const Experiment& experiment) {
  std::vector<int> out;
  for (size_t i = 0; i < system.heldOut.size(); ++i)
    out.push_back(static_cast<int>(i) / std::max(1, experiment.heldOutSamples));
  return out;
}

}  // namespace marey
