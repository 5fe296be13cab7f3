#include "gui/plots/statistics_data.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/error.h"
#include "motion/main_body.h"
#include "report/experiment_report.h"
#include "stats/footsteps.h"

namespace marey::gui {
namespace {

StatisticsRow& rowFor(StatisticsTable& table, const stats::StatisticResult& result) {
  const auto found = std::find_if(table.rows.begin(), table.rows.end(),
                                  [&](const StatisticsRow& r) { return r.name == result.name; });
  if (found != table.rows.end()) return *found;
  table.rows.push_back({.name = result.name,
                        .unit = result.unit,
                        .definition = result.definition,
                        .source = result.source,
                        .systems = {}});
  table.rows.back().systems.resize(table.systems.size());
  return table.rows.back();
}

std::string number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? fmt::format("{:.6g}", *value) : "";
}

/// Of the skeleton that the clips have; without feet there are no statistics of feet.
std::vector<int> feetOf(const std::vector<Clip>& clips, const std::string& names) {
  try {
    return stats::feetOf(*clips.front().skeleton, names);
  } catch (const InputError&) {
    return {};
  }
}

/// Motions of a path that was drawn are one cluster, which no natural clip shares.
std::vector<int> controlsOf(const ClipsInRange& set) {
  std::vector<int> out = set.follows;
  out.resize(set.clips.size(), -1);
  return out;
}

/// Of the natural clips inside the range, those to compare a set with.
ComparedNatural comparedWith(const ClipsInRange& set, const ClipsInRange& natural,
                             NaturalChoice choice) {
  std::vector<int> follows;
  for (const int clip : set.follows) {
    const auto at = std::find_if(natural.ids.begin(), natural.ids.end(),
                                 [&](const MotionId& id) { return id.index == clip; });
    follows.push_back(at == natural.ids.end() ? -1 : static_cast<int>(at - natural.ids.begin()));
  }
  const bool some = std::any_of(follows.begin(), follows.end(), [](int f) { return f >= 0; });
  return naturalToCompare(natural.clips, follows, some ? choice : NaturalChoice::All);
}

/// In the order of the registry: a set may have statistics that the first one lacks.
void sortRows(StatisticsTable& table) {
  const auto& all = stats::allStatistics();
  const auto place = [&](const StatisticsRow& row) {
    return std::find_if(all.begin(), all.end(), [&](const auto& s) { return s.name == row.name; });
  };
  std::stable_sort(table.rows.begin(), table.rows.end(),
                   [&](const auto& a, const auto& b) { return place(a) < place(b); });
}

}  // namespace

bool StatisticsInput::sameAs(const StatisticsInput& other) const {
  const auto sameSet = [](const MotionSet& a, const MotionSet& b) {
    return a.name == b.name && a.clips == b.clips && a.follows == b.follows;
  };
  return range == other.range && feet == other.feet && footStepCmS == other.footStepCmS &&
         seed == other.seed && against == other.against &&
         std::equal(sets.begin(), sets.end(), other.sets.begin(), other.sets.end(), sameSet);
}

std::string StatisticsInput::text() const {
  std::string out;
  for (const MotionSet& set : sets)
    out += fmt::format("{}{} ({} of {} motions)", out.empty() ? "" : ", ", set.name,
                       set.clips.size(), set.all);
  if (range) out += fmt::format(", {:.2f} to {:.2f} s", range->beginS, range->endS);
  return out;
}

StatisticsTable statisticsTable(const StatisticsInput& input, Progress& progress) {
  StatisticsTable table{.input = input, .systems = {}, .rows = {}, .notes = {}};
  const MotionSet* naturalMotions = naturalSet(input.sets);
  ClipsInRange natural;
  if (naturalMotions != nullptr) natural = clipsIn(*naturalMotions, input.range);
  std::vector<ClipsInRange> sets;
  for (const MotionSet& set : input.sets) {
    if (set.natural) continue;
    ClipsInRange clips = clipsIn(set, input.range);
    if (clips.clips.empty()) continue;
    table.systems.push_back(set.name);
    sets.push_back(std::move(clips));
  }
  const bool naturalAlone = sets.empty() && !natural.clips.empty();
  if (naturalAlone) sets.push_back({.ids = {}, .clips = natural.clips, .wanted = {}});
  for (size_t i = 0; i < sets.size(); ++i) {
    stats::StatisticInput one{.clips = &sets[i].clips,
                              .wanted = sets[i].wanted.empty() ? nullptr : &sets[i].wanted,
                              .feet = feetOf(sets[i].clips, input.feet),
                              .footStepCmS = input.footStepCmS};
    if (!input.feet.empty()) one.toes = one.feet;
    if (!naturalAlone) one.controls = controlsOf(sets[i]);
    std::vector<Clip> compared;
    const bool comparable = !naturalAlone && !natural.clips.empty();
    const Skeleton& body = *sets[i].clips.front().skeleton;
    if (comparable && !sameJoints(body, *natural.clips.front().skeleton)) {
      table.notes.push_back(table.systems[i] + ": not compared with natural motion, " +
                            otherJoints(body, *natural.clips.front().skeleton));
      table.compared.emplace_back("no natural motion");
    } else if (comparable) {
      const ComparedNatural choice = comparedWith(sets[i], natural, input.against);
      table.compared.push_back(choice.text);
      for (const size_t c : choice.clips) {
        compared.push_back(natural.clips[c]);
        one.naturalControls.push_back(natural.ids[c].index);
      }
      one.natural = &compared;
    }
    Progress part = progress.part(static_cast<double>(i) / static_cast<double>(sets.size()),
                                  static_cast<double>(i + 1) / static_cast<double>(sets.size()));
    std::vector<stats::StatisticResult> results;
    try {
      results = stats::evaluate(stats::allStatistics(), one,
                                {.resamples = report::kReportResamples, .seed = input.seed}, part);
    } catch (const InputError& fault) {
      table.notes.push_back((naturalAlone ? naturalMotions->name : table.systems[i]) + ": " +
                            fault.what());
    }
    for (const stats::StatisticResult& result : results) {
      StatisticsRow& row = rowFor(table, result);
      if (naturalAlone) {
        row.natural = result.value;
        row.naturalLow = result.low;
        row.naturalHigh = result.high;
        continue;
      }
      row.systems[i] = result;
      if (row.natural) continue;
      row.natural = result.natural;
      row.naturalLow = result.naturalLow;
      row.naturalHigh = result.naturalHigh;
      row.noiseFloor = result.noiseFloor;
    }
  }
  sortRows(table);
  return table;
}

std::string statisticsText(const StatisticsTable& table, char separator) {
  std::string out;
  const auto line = [&](const std::vector<std::string>& cells) {
    for (size_t i = 0; i < cells.size(); ++i)
      out += (i > 0 ? std::string(1, separator) : "") +
             (separator == ',' ? csvField(cells[i]) : cells[i]);
    out += "\n";
  };
  std::vector<std::string> head{"statistic", "unit"};
  for (const std::string& system : table.systems)
    head.insert(head.end(), {system, system + " low", system + " high"});
  head.insert(head.end(),
              {"natural", "natural low", "natural high", "noise floor", "definition", "source"});
  line(head);
  for (const StatisticsRow& row : table.rows) {
    std::vector<std::string> cells{row.name, row.unit};
    for (const auto& s : row.systems) {
      cells.push_back(s ? number(s->value) : "");
      cells.push_back(s ? number(s->low) : "");
      cells.push_back(s ? number(s->high) : "");
    }
    cells.insert(cells.end(), {number(row.natural), number(row.naturalLow), number(row.naturalHigh),
                               number(row.noiseFloor), row.definition, row.source});
    line(cells);
  }
  return out;
}

}  // namespace marey::gui
