#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include "experiment/comparison.h"
#include "model/pose_units.h"
#include "report/experiment_report.h"
#include "stats/bones.h"
#include "stats/footsteps.h"
#include "stats/statistic.h"

namespace marey::report {
namespace {

constexpr int kResamples = kReportResamples;

/// Clips of a set and what they follow, ready for statistics.
stats::StatisticInput inputOf(const std::vector<Clip>& clips, const std::vector<int>& controls,
                              const ExperimentResult& r) {
  return {.clips = &clips,
          .natural = &r.natural,
          .controls = controls,
          .naturalControls = stats::controlsEach(r.natural.size()),
          .feet = r.feet,
          .toes = r.experiment.feet.empty() ? std::vector<int>() : r.feet,
          .footStepCmS = r.experiment.toleranceStepCmS};
}

std::vector<Cell> footstepRow(const std::string& name, const std::vector<Clip>& clips,
                              const std::vector<int>& controls, const ExperimentResult& r) {
  const auto curve = stats::footstepCurve(
      clips, {.feet = r.feet, .stepCmS = r.experiment.toleranceStepCmS}, controls);
  const std::set<int> different(controls.begin(), controls.end());
  const stats::StatisticInput input = inputOf(clips, controls, r);
  // A share of a step is left where controls have several samples.
  return {{name},
          numberCell(static_cast<double>(clips.size()), 0),
          numberCell(static_cast<double>(different.size()), 0),
          numberCell(curve.maxCount, different.size() == clips.size() ? 0 : 1),
          numberCell(curve.v95CmS, 1),
          numberCell(curve.stepsPerS, 3),
          numberCell(curve.durationMeanS, 2),
          numberCell(curve.durationStdS, 2),
          numberCell(stats::valueOf(stats::statisticByName("bone_length_rmse"), input), 3)};
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

std::string statisticCaption(const SystemResult& system, const ComparedNatural& compared,
                             const ExperimentResult& r) {
  std::string out = fmt::format(
      "{} motions along held-out control, compared with {}. The unit of resampling is the control: "
      "samples along one control are one cluster. Intervals: 95 % bootstrap over controls; those "
      "of "
      "distances are corrected for bias and resample the natural side as well. Noise floor: "
      "natural "
      "against natural, two sets of as many controls as are compared; a difference below it says "
      "nothing. For distances (0 is the same) the natural column is that distance.",
      system.heldOut.size(), compared.text);
  if (system.info.deterministic())
    out += fmt::format(
        " {} draws nothing: equal control always gives the same motion, so its diversity is 0.",
        system.name);
  else if (r.experiment.heldOutSamples < 2)
    out += " Diversity needs two samples or more along a control (held_out_samples).";
  return out;
}

Table statisticTable(const ExperimentResult& r, const SystemResult& system, Progress& progress) {
  const std::vector<int> follows = heldOutControls(system, r.experiment);
  const auto compared =
      naturalToCompare(r.natural, follows, naturalChoiceByName(r.experiment.against));
  std::vector<Clip> natural;
  std::vector<int> naturalControls;
  for (const size_t i : compared.clips) {
    natural.push_back(r.natural[i]);
    naturalControls.push_back(static_cast<int>(i));
  }
  stats::StatisticInput input = inputOf(system.heldOut, follows, r);
  input.natural = &natural;
  input.naturalControls = naturalControls;
  input.wanted = &system.heldOutPaths;
  Table out{.id = "statistics-" + tableId(system.name),
            .title = "Statistics of " + system.name + " beside natural motion",
            .caption = statisticCaption(system, compared, r),
            .section = Section::Statistics,
            .columns = {{"statistic"},
                        {"unit"},
                        {labelOf(system)},
                        {"95 % interval"},
                        {"natural"},
                        {"natural 95 %"},
                        {"noise floor"},
                        {"clips"},
                        {"left out"}}};
  for (const auto& s :
       stats::evaluate(stats::allStatistics(), input,
                       {.resamples = kResamples, .seed = r.experiment.seed}, progress))
    out.rows.push_back({{s.name},
                        {s.unit},
                        optionalCell(s.value),
                        {interval(s.low, s.high)},
                        optionalCell(s.natural),
                        {interval(s.naturalLow, s.naturalHigh)},
                        optionalCell(s.noiseFloor),
                        numberCell(static_cast<double>(s.clips), 0),
                        numberCell(static_cast<double>(s.leftOut), 0)});
  return out;
}

}  // namespace

Table footstepTable(const ExperimentResult& r) {
  Table out{
      .id = "footsteps",
      .title = "Footsteps and bones (the papers' Table 3)",
      .caption =
          "Held-out control. f: most footsteps at any speed tolerance, per control (the mean "
          "over the motions along each, summed over controls); v95: the tolerance that "
          "reaches 95 % of them; rate and duration at v95; bone RMSE against the natural mean "
          "lengths (Henter et al. 2020, Sec. 5.3).",
      .section = Section::Summary,
      .columns = {{"system"},
                  {"motions"},
                  {"controls"},
                  {"f"},
                  {"v95", "cm/s"},
                  {"rate", "1/s"},
                  {"duration mean", "s"},
                  {"duration sd", "s"},
                  {"bone RMSE", "cm"}}};
  out.rows.push_back(footstepRow("natural", r.natural, stats::controlsEach(r.natural.size()), r));
  for (const auto& s : r.systems)
    if (!s.heldOut.empty())
      out.rows.push_back(footstepRow(labelOf(s), s.heldOut, heldOutControls(s, r.experiment), r));
  return out;
}

namespace {

using Systems = std::vector<const SystemResult*>;

/// The systems by the unit of their likelihoods, in their order.
std::vector<Systems> byUnit(const ExperimentResult& r) {
  std::vector<Systems> out;
  for (const SystemResult& s : r.systems) {
    const auto alike = std::find_if(out.begin(), out.end(), [&](const Systems& systems) {
      return systems.front()->naturalLikelihood.unit == s.naturalLikelihood.unit;
    });
    if (alike == out.end())
      out.push_back({&s});
    else
      alike->push_back(&s);
  }
  return out;
}

/// The unit, what is compared, and what the numbers hang on.
std::string likelihoodCaption(const Systems& systems, const std::string& unit, bool alone) {
  std::string out = fmt::format(
      "Unit: {}, mean over the frames that every system scores (from frame {} of each clip on). "
      "linear-Gaussian: a ridge autoregression without a network, fitted on the model's training "
      "data with the same observation floor and evaluated on the same frames. Effective "
      "dimensions: directions of pose space in which the model is wider than its floor (over half "
      "of its variance is its own).",
      unit, systems.empty() ? 0 : systems.front()->naturalLikelihood.firstFrame);
  if (!alone)
    out += " Numbers of another unit are densities of other values: they say nothing of these.";
  for (const SystemResult* s : systems) {
    out += " " + s->name + ": " + floorText(s->info);
    for (const auto* summary : {&s->naturalLikelihood, &s->heldOutLikelihood})
      if (const std::string text = tooShortText(*summary); !text.empty()) out += " " + text + ".";
  }
  return out;
}

std::vector<Cell> likelihoodRow(const SystemResult& s) {
  const LikelihoodSummary& natural = s.naturalLikelihood;
  return {{labelOf(s)},
          numberCell(natural.nats, 1),
          numberCell(natural.linearGaussian, 1),
          numberCell(s.heldOutLikelihood.nats, 1),
          numberCell(natural.natsPerEffectiveDimension, 2),
          numberCell(natural.effectiveDimensions, 0),
          numberCell(natural.floorDirections, 0),
          numberCell(natural.clips, 0),
          numberCell(static_cast<double>(natural.frames), 0),
          numberCell(static_cast<double>(natural.tooShort.size()), 0),
          numberCell(static_cast<double>(s.info.parameters) / 1e6, 2),
          numberCell(s.framesPerSecond, 0)};
}

/// Of systems of one unit.
Table likelihoodTable(const Systems& systems, bool alone) {
  const std::string unit =
      systems.empty() ? likelihoodUnit(FeatureSpec{}) : systems.front()->naturalLikelihood.unit;
  Table out{.id = "likelihood",
            .title = "Log-likelihood",
            .caption = likelihoodCaption(systems, unit, alone),
            .section = Section::Likelihood,
            .columns = {{"system"},
                        {"natural clips", unit},
                        {"linear-Gaussian", unit},
                        {"own samples", unit},
                        {"per effective dimension", natsUnit(unit)},
                        {"effective dimensions"},
                        {"on the floor", "directions"},
                        {"clips"},
                        {"frames"},
                        {"too short", "clips"},
                        {"parameters", "M"},
                        {"sampling", "frames/s"}}};
  for (const SystemResult* s : systems) out.rows.push_back(likelihoodRow(*s));
  return out;
}

}  // namespace

std::vector<Table> likelihoodTables(const ExperimentResult& r) {
  const auto groups = byUnit(r);
  if (groups.empty()) return {likelihoodTable({}, true)};
  std::vector<Table> out;
  for (const Systems& systems : groups) {
    out.push_back(likelihoodTable(systems, groups.size() == 1));
    if (groups.size() > 1) out.back().title += ", " + systems.front()->info.features.layout;
    if (out.size() > 1) out.back().id += "-" + std::to_string(out.size());
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
