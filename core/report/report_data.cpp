#include "report/report_data.h"

#include <cctype>
#include <cmath>
#include <set>

#include "base/error.h"

namespace marey::report {

namespace {
void checkSystem(const ReportData& data, int system, const std::string& panel) {
  const int count = static_cast<int>(data.systems.size());
  if (system < 0 || system >= count) {
    throwInput({.path = "report", .item = panel}, fmt::format("a system from 0 to {}", count - 1),
               "{}", system);
  }
}

void checkTable(const Table& table, std::set<std::string>& ids) {
  const Place place{.path = "report", .item = "table '" + table.id + "'"};
  bool usable = !table.id.empty();
  for (const unsigned char c : table.id)
    usable = usable && (std::isalnum(c) != 0 || c == '-' || c == '_');
  if (!usable) throwInput(place, "an id of letters, digits, - and _", "'{}'", table.id);
  if (!ids.insert(table.id).second)
    throwInput(place, "an id of its own", "one that another table has");
  for (const auto& row : table.rows) {
    if (row.size() != table.columns.size()) {
      throwInput(place, fmt::format("{} cells in a row", table.columns.size()), "{}", row.size());
    }
  }
}

void checkScene(const ReportData& data, const ScenePanel& scene) {
  for (const ReportSystem& system : data.systems) {
    const auto found = system.clips.find(scene.path);
    if (found != system.clips.end() && !found->second.empty()) return;
  }
  throwInput({.path = "report", .item = "scene '" + scene.title + "'"}, "a clip of any system",
             "none for path '{}'", scene.path);
}
}  // namespace

Cell numberCell(double value, int decimals) {
  if (!std::isfinite(value)) return {"\u2013", std::nullopt};
  std::string text = fmt::format("{:.{}f}", std::abs(value), decimals);
  const bool zero = text.find_first_not_of("0.") == std::string::npos;
  return {value < 0.0 && !zero ? "\u2212" + text : text, value};
}

void validate(const ReportData& data) {
  for (const ScenePanel& scene : data.scenes) checkScene(data, scene);
  for (const LikelihoodPanel& panel : data.likelihoods) {
    for (const LikelihoodGroup& g : panel.groups) checkSystem(data, g.system, panel.title);
  }
  for (const FootstepPanel& panel : data.footsteps) {
    for (const FootstepSeries& c : panel.curves) checkSystem(data, c.system, panel.title);
  }
  for (const GaitPanel& panel : data.gaits) {
    for (const GaitRow& r : panel.rows) checkSystem(data, r.system, panel.title);
  }
  for (const DistributionPanel& panel : data.distributions) {
    for (const SystemSamples& s : panel.samples) checkSystem(data, s.system, panel.joint);
  }
  std::set<std::string> ids;
  for (const Table& table : data.tables) checkTable(table, ids);
}

}  // namespace marey::report
