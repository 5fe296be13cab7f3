#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "report/experiment_report.h"
#include "stats/bones.h"
#include "stats/footsteps.h"
#include "stats/statistic.h"

namespace marey::report {
namespace {

constexpr int kResamples = 200;

double boneRmse(const std::vector<Clip>& clips, const ExperimentResult& r) {
  stats::StatisticInput input{.clips = &clips,
                              .natural = &r.natural,
                              .feet = r.feet,
                              .footStepCmS = r.experiment.toleranceStepCmS};
  return stats::valueOf(stats::statisticByName("bone_length_rmse"), input);
}

std::vector<Cell> footstepRow(const std::string& name, const std::vector<Clip>& clips,
                              const ExperimentResult& r, bool natural) {
  const auto curve =
      stats::footstepCurve(clips, {.feet = r.feet, .stepCmS = r.experiment.toleranceStepCmS});
  return {{name},
          numberCell(static_cast<double>(curve.maxCount), 0),
          numberCell(curve.v95CmS, 1),
          numberCell(curve.durationMeanS, 2),
          numberCell(curve.durationStdS, 2),
          natural ? Cell{"-"} : numberCell(boneRmse(clips, r), 2)};
}

/// Quantile of floor speeds of the feet, cm/s.
double footSpeedQuantile(const std::vector<ClipPtr>& clips, const std::vector<int>& feet,
                         double share) {
  std::vector<double> speeds;
  for (const auto& clip : clips)
    for (const int foot : feet) {
      const auto own = stats::horizontalSpeedsCmS(*clip, foot);
      speeds.insert(speeds.end(), own.begin(), own.end());
    }
  if (speeds.empty()) return std::nan("");
  const auto at =
      speeds.begin() + static_cast<long>(share * static_cast<double>(speeds.size() - 1));
  std::nth_element(speeds.begin(), at, speeds.end());
  return *at;
}

double meanNats(const std::vector<ClipScore>& scores) {
  double sum = 0.0, frames = 0.0;
  for (const auto& score : scores) {
    sum = std::accumulate(score.loglikNats.begin(), score.loglikNats.end(), sum);
    frames += static_cast<double>(score.loglikNats.size());
  }
  return frames > 0 ? sum / frames : std::nan("");
}

std::string tableId(const std::string& name) {
  std::string out;
  for (const unsigned char c : name)
    out += std::isalnum(c) ? static_cast<char>(std::tolower(c)) : '-';
  return out;
}

std::string interval(std::optional<double> low, std::optional<double> high) {
  return low && high ? fmt::format("{:.3g} to {:.3g}", *low, *high) : "-";
}

Cell optionalCell(std::optional<double> value) {
  if (!value || !std::isfinite(*value)) return {"-"};
  return {fmt::format("{:.4g}", *value), *value};
}

Table statisticTable(const ExperimentResult& r, const SystemResult& system, Progress& progress) {
  const stats::StatisticInput input{.clips = &system.heldOut,
                                    .natural = &r.natural,
                                    .wanted = &system.heldOutPaths,
                                    .feet = r.feet,
                                    .footStepCmS = r.experiment.toleranceStepCmS};
  Table out{.id = "statistics-" + tableId(system.name),
            .title = "Statistics of " + system.name + " beside natural motion",
            .caption =
                "Held-out control. Intervals: 95 % bootstrap over clips. Noise floor: natural "
                "against natural, random halves; "
                "a difference below it says nothing. For distances (0 is the same) the natural "
                "column is the distance between halves.",
            .section = Section::Statistics,
            .columns = {{"statistic"},
                        {"unit"},
                        {system.name},
                        {"95 % interval"},
                        {"natural"},
                        {"natural 95 %"},
                        {"noise floor"}}};
  for (const auto& s :
       stats::evaluate(stats::allStatistics(), input,
                       {.resamples = kResamples, .seed = r.experiment.seed}, progress))
    out.rows.push_back({{s.name},
                        {s.unit},
                        optionalCell(s.value),
                        {interval(s.low, s.high)},
                        optionalCell(s.natural),
                        {interval(s.naturalLow, s.naturalHigh)},
                        optionalCell(s.noiseFloor)});
  return out;
}

}  // namespace

Table footstepTable(const ExperimentResult& r) {
  Table out{.id = "footsteps",
            .title = "Footsteps and bones (the papers' Table 3)",
            .caption =
                "Held-out control. f: most footsteps at any speed tolerance; v95: the tolerance "
                "that reaches 95 % of them; "
                "duration at v95; bone RMSE against the natural mean lengths (Henter et al. 2020, "
                "Sec. 5.3).",
            .section = Section::Summary,
            .columns = {{"system"},
                        {"f"},
                        {"v95", "cm/s"},
                        {"duration mean", "s"},
                        {"duration sd", "s"},
                        {"bone RMSE", "cm"}}};
  out.rows.push_back(footstepRow("natural", r.natural, r, true));
  for (const auto& s : r.systems)
    if (!s.heldOut.empty()) out.rows.push_back(footstepRow(s.name, s.heldOut, r, false));
  return out;
}

Table likelihoodTable(const ExperimentResult& r) {
  Table out{.id = "likelihood",
            .title = "Log-likelihood",
            .caption =
                "Nats per frame. The linear-Gaussian value (ridge autoregression on the training "
                "data) is the floor that a flow has to beat. "
                "In centimetres a density is lower by ln 100 per value than in metres.",
            .section = Section::Likelihood,
            .columns = {{"system"},
                        {"natural clips", "nats, m"},
                        {"natural clips", "nats, cm"},
                        {"linear-Gaussian", "nats, cm"},
                        {"own samples", "nats, cm"},
                        {"parameters", "M"},
                        {"sampling", "frames/s"}}};
  for (const auto& s : r.systems) {
    const double toCm = s.info.poseDim * std::log(100.0);
    out.rows.push_back({{s.name},
                        numberCell(s.naturalNatsPerFrame, 1),
                        numberCell(s.naturalNatsPerFrame - toCm, 1),
                        numberCell(s.linearGaussianNats - toCm, 1),
                        numberCell(meanNats(s.heldOutScores) - toCm, 1),
                        numberCell(static_cast<double>(s.info.parameters) / 1e6, 2),
                        numberCell(s.framesPerSecond, 0)});
  }
  return out;
}

Table obedienceTable(const ExperimentResult& r) {
  Table out{.id = "paths",
            .title = "Feet along each path",
            .caption =
                "Floor speed of the feet over all samples: where the path stands still, feet "
                "should rest.",
            .section = Section::Footsteps,
            .columns = {{"path"},
                        {"system"},
                        {"median foot speed", "cm/s"},
                        {"95 % foot speed", "cm/s"},
                        {"footsteps per second"}}};
  for (const auto& path : r.experiment.paths)
    for (const auto& s : r.systems) {
      const auto& samples = s.paths.at(path.name);
      std::vector<Clip> clips;
      double seconds = 0.0;
      for (const auto& clip : samples.clips) {
        clips.push_back(*clip);
        seconds += clip->seconds();
      }
      const auto curve =
          stats::footstepCurve(clips, {.feet = r.feet, .stepCmS = r.experiment.toleranceStepCmS});
      out.rows.push_back({{path.name},
                          {s.name},
                          numberCell(footSpeedQuantile(samples.clips, r.feet, 0.5), 1),
                          numberCell(footSpeedQuantile(samples.clips, r.feet, 0.95), 1),
                          numberCell(static_cast<double>(curve.maxCount) / seconds, 2)});
    }
  return out;
}

Table definitionTable() {
  Table out{.id = "definitions",
            .title = "What the statistics are",
            .caption = "Definition and source of every statistic of this report.",
            .section = Section::Statistics,
            .columns = {{"statistic"}, {"unit"}, {"definition"}, {"source"}}};
  for (const auto& s : stats::allStatistics())
    out.rows.push_back({{s.name}, {s.unit}, {s.definition}, {s.source}});
  return out;
}

std::vector<Table> statisticTables(const ExperimentResult& r, Progress& progress) {
  std::vector<Table> out;
  for (const auto& s : r.systems)
    if (!s.heldOut.empty()) {
      Progress part = progress.part(
          static_cast<double>(out.size()) / static_cast<double>(r.systems.size()),
          static_cast<double>(out.size() + 1) / static_cast<double>(r.systems.size()));
      out.push_back(statisticTable(r, s, part));
    }
  if (!out.empty()) out.push_back(definitionTable());
  return out;
}

}  // namespace marey::report
