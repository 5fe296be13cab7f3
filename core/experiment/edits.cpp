#include "experiment/edits.h"

#include <algorithm>
#include <set>

#include "base/error.h"

namespace marey {
namespace {

namespace fs = std::filesystem;

template <typename Items>
bool isTaken(const Items& items, const std::string& name) {
  return std::any_of(items.begin(), items.end(), [&](const auto& i) { return i.name == name; });
}

template <typename Items>
std::string freeName(const Items& items, const std::string& wanted) {
  std::string name = wanted;
  for (int n = 2; isTaken(items, name); ++n) name = fmt::format("{} {}", wanted, n);
  return name;
}

template <typename Items>
void rename(Items& items, size_t index, const std::string& name, const char* kind) {
  if (items.at(index).name == name) return;
  if (name.empty()) throw InputError({.path = kind}, "a name", "an empty one");
  if (isTaken(items, name))
    throw InputError({.path = kind}, "a name that is not in use", "'" + name + "'");
  items[index].name = name;
}

bool isFile(const std::string& source) {
  return !source.starts_with("walker:") && !source.starts_with("preset:") && !source.empty();
}

/// Way-points are edited whole: /paths/INDEX/waypoints/INDEX.
constexpr size_t kDeepestPlace = 4;

std::vector<std::string> stepsOf(const std::string& pointer) {
  std::vector<std::string> out;
  for (size_t at = 0; at < pointer.size() && out.size() < kDeepestPlace;) {
    const size_t next = std::min(pointer.find('/', at + 1), pointer.size());
    out.push_back(pointer.substr(at, next - at));
    at = next;
  }
  return out;
}

/// `source` may have a mark in front (@LIST, clip:FILE).
std::string moved(const std::string& source, const fs::path& from, const fs::path& to) {
  if (!isFile(source)) return source;
  const size_t mark = source.starts_with("@") ? 1 : source.starts_with("clip:") ? 5 : 0;
  const fs::path file = source.substr(mark);
  // What lies beside the document moves along with it, however it was named.
  const fs::path whole = fs::absolute(from / file).lexically_normal();
  const fs::path near = whole.lexically_relative(fs::absolute(to).lexically_normal());
  // A way up and down again is harder to read and no more lasting than a whole one.
  const bool below = !near.empty() && *near.begin() != "..";
  return source.substr(0, mark) + (below ? near : whole).string();
}

}  // namespace

std::string freeSystemName(const Experiment& experiment, const std::string& wanted) {
  return freeName(experiment.systems, wanted);
}

std::string freePathName(const Experiment& experiment, const std::string& wanted) {
  return freeName(experiment.paths, wanted);
}

size_t addSystem(Experiment& experiment, const std::string& model, const std::string& name,
                 double temperature) {
  experiment.systems.push_back({freeSystemName(experiment, name), model, temperature});
  return experiment.systems.size() - 1;
}

size_t addPath(Experiment& experiment, ExperimentPath path) {
  path.name = freePathName(experiment, path.name);
  experiment.paths.push_back(std::move(path));
  return experiment.paths.size() - 1;
}

size_t addNatural(Experiment& experiment, const std::vector<std::string>& sources) {
  size_t added = 0;
  for (const std::string& source : sources) {
    auto& all = experiment.natural;
    if (std::find(all.begin(), all.end(), source) != all.end()) continue;
    all.push_back(source);
    ++added;
  }
  return added;
}

void renameSystem(Experiment& experiment, size_t index, const std::string& name) {
  rename(experiment.systems, index, name, "system");
}

void renamePath(Experiment& experiment, size_t index, const std::string& name) {
  rename(experiment.paths, index, name, "path");
}

void removeSystem(Experiment& experiment, size_t index) {
  if (index < experiment.systems.size())
    experiment.systems.erase(experiment.systems.begin() + static_cast<std::ptrdiff_t>(index));
}

void removeNatural(Experiment& experiment, const std::string& source) {
  std::erase(experiment.natural, source);
}

void setPathSeconds(Experiment& experiment, size_t index, double seconds) {
  const bool whole = !(seconds >= 0.5 * kShortestPathS);
  experiment.paths.at(index).seconds = whole ? 0.0 : std::max(kShortestPathS, seconds);
}

std::vector<std::string> motionTypes(
    const Experiment& experiment, const std::vector<std::shared_ptr<const MotionModel>>& models) {
  std::set<std::string> out;
  for (const auto& model : models)
    if (const auto* channel = channelOf(model->info().features.control, ControlKind::Label))
      out.insert(channel->values.begin(), channel->values.end());
  for (const ExperimentPath& path : experiment.paths) {
    out.insert(path.control.type);
    for (const WayPoint& point : path.wayPoints) out.insert(point.type);
  }
  out.erase("");
  return {out.begin(), out.end()};
}

namespace {

void move(ExperimentPath& path, const fs::path& from, const fs::path& to) {
  path.path = moved(path.path, from, to);
  for (auto& [channel, file] : path.control.signals) file = moved(file, from, to);
  if (!path.control.body.empty()) path.control.body = moved(path.control.body, from, to);
}

}  // namespace

void moveToFolder(Experiment& experiment, const fs::path& folder) {
  const fs::path from = experiment.folder;
  for (std::string& source : experiment.natural) source = moved(source, from, folder);
  for (ExperimentSystem& system : experiment.systems)
    system.model = moved(system.model, from, folder);
  for (ExperimentPath& path : experiment.paths) move(path, from, folder);
  ViewState& view = experiment.view;
  if (view.natural)
    for (ShownClips& shown : *view.natural) shown.source = moved(shown.source, from, folder);
  for (KeptSet& set : view.sets) {
    set.system.model = moved(set.system.model, from, folder);
    // The path of held-out control is a word, no file.
    if (!set.heldOut) move(set.path, from, folder);
  }
  view.trainingRun = moved(view.trainingRun, from, folder);
  experiment.folder = folder;
}

bool isEmpty(const Experiment& e) {
  return e.natural.empty() && e.systems.empty() && e.paths.empty();
}

Experiment asStored(const Experiment& experiment) {
  Experiment out = experimentFromJson(toJson(experiment), experiment.title);
  out.folder = experiment.folder;
  return out;
}

std::string changedPlace(const Experiment& before, const Experiment& after) {
  std::vector<std::string> common;
  bool first = true;
  for (const Json& change : Json::diff(toJson(before), toJson(after))) {
    const auto steps = stepsOf(change["path"].get<std::string>());
    if (first) common = steps;
    first = false;
    const auto ends = std::mismatch(common.begin(), common.end(), steps.begin(), steps.end());
    common.erase(ends.first, common.end());
  }
  std::string out;
  for (const std::string& step : common) out += step;
  return out;
}

}  // namespace marey
