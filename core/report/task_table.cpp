// What systems made of an experiment's tasks.
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "report/experiment_report.h"

namespace marey::report {
namespace {

double mean(const std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Population deviation: how much clips differ.
double deviation(const std::vector<double>& values) {
  const double centre = mean(values);
  double sum = 0.0;
  for (const double v : values) sum += (v - centre) * (v - centre);
  return values.empty() ? centre : std::sqrt(sum / static_cast<double>(values.size()));
}

std::vector<Cell> rowOf(const ExperimentCase& c, const std::string& name,
                        const std::vector<PoseError>& errors, int leftOut, double fps) {
  std::vector<double> means, best;
  std::map<int, std::vector<double>> at;
  for (const PoseError& error : errors) {
    means.push_back(error.meanCm);
    best.push_back(error.bestCm);
    for (const auto& [ms, cm] : errorsAtHorizons(error, fps)) at[ms].push_back(cm);
  }
  std::vector<Cell> out{{c.name},
                        {name},
                        numberCell(mean(means), 2),
                        numberCell(deviation(means), 2),
                        numberCell(mean(best), 2)};
  for (const int ms : kHorizonsMs) out.push_back(numberCell(mean(at[ms]), 2));
  out.push_back(numberCell(static_cast<double>(errors.size()), 0));
  out.push_back(numberCell(leftOut, 0));
  return out;
}

std::string settingsOf(const ExperimentCase& c) {
  std::string out = c.name + ": " + taskNamed(c.task).title;
  for (const auto& [name, value] : c.options) out += fmt::format(", {} {:g}", name, value);
  return out + fmt::format(", {} sample{} for each clip.", c.samples, c.samples == 1 ? "" : "s");
}

}  // namespace

Table taskTable(const ExperimentResult& r) {
  Table out{.id = "tasks",
            .title = "Tasks on the natural clips",
            .caption =
                "Mean distance of joints from where they really were (mean per joint position "
                "error, after Ionescu et al. 2014), over motions, frames and clips; sd: "
                "between clips; best: of the nearest sample; then after so much time.",
            .section = Section::Statistics,
            .columns = {{"case"}, {"system"}, {"error", "cm"}, {"sd", "cm"}, {"best", "cm"}}};
  for (const int ms : kHorizonsMs) out.columns.push_back({fmt::format("{} ms", ms), "cm"});
  out.columns.push_back({"clips"});
  out.columns.push_back({"left out", "clips"});
  for (const ExperimentCase& c : r.experiment.cases) {
    out.caption += " " + settingsOf(c);
    bool alone = true;  // what one has without a model is the same beside every system
    for (const SystemResult& s : r.systems) {
      const CaseResult& result = s.cases.at(c.name);
      if (!result.whyNot.empty()) {
        out.caption += fmt::format(" {} cannot {}: it is {}.", s.name, c.task, result.whyNot);
        continue;
      }
      if (alone)
        out.rows.push_back(
            rowOf(c, taskNamed(c.task).without, result.without, result.leftOut, r.experiment.fps));
      alone = false;
      out.rows.push_back(rowOf(c, labelOf(s), result.errors, result.leftOut, r.experiment.fps));
    }
  }
  return out;
}

}  // namespace marey::report
