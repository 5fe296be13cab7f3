#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "base/error.h"
#include "cli/command.h"
#include "cli/readers.h"
#include "experiment/clip_statistics.h"

namespace marey::cli {
namespace {

struct AnalyzeOptions {
  std::vector<std::string> inputs, against;
  io::ReadOptions read;
  double fps = 0.0;
  std::string feet;
  double toleranceStepCmS = 0.0;
  int resamples = 400;
  std::string controls = "each", natural = "all";
};

ControlRule controlRule(const std::string& name) {
  return name == "folder" ? ControlRule::Folder
         : name == "one"  ? ControlRule::One
                          : ControlRule::Each;
}

/// Counts are whole but for shares of several samples per control.
Json countJson(double count) {
  return count == std::floor(count) ? Json(static_cast<int64_t>(count)) : Json(count);
}

Json numberOrNull(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json footstepsJson(const stats::FootstepCurve& curve) {
  Json counts = Json::array();
  for (const double count : curve.count) counts.push_back(countJson(count));
  return {{"tolerance_cm_s", curve.toleranceCmS},   {"count", counts},
          {"max_count", countJson(curve.maxCount)}, {"v95_cm_s", numberOrNull(curve.v95CmS)},
          {"duration_mean_s", curve.durationMeanS}, {"duration_std_s", curve.durationStdS}};
}

Json statisticJson(const stats::StatisticResult& r, bool compared) {
  Json out = {{"name", r.name},
              {"unit", r.unit},
              {"value", numberOrNull(r.value)},
              {"low", numberOrNull(r.low)},
              {"high", numberOrNull(r.high)}};
  if (compared) {
    out["natural"] = numberOrNull(r.natural);
    out["natural_low"] = numberOrNull(r.naturalLow);
    out["natural_high"] = numberOrNull(r.naturalHigh);
    out["noise_floor"] = numberOrNull(r.noiseFloor);
  }
  out["clips"] = r.clips;
  out["controls"] = r.controls;
  out["left_out"] = r.leftOut;
  out["definition"] = r.definition;
  out["source"] = r.source;
  return out;
}

std::string cell(const std::optional<double>& value) {
  if (!value || !std::isfinite(*value)) return "-";
  return fmt::format("{:.4g}", *value);
}

std::string range(const std::optional<double>& low, const std::optional<double>& high) {
  return low && high ? cell(low) + " .. " + cell(high) : "";
}

std::string statisticsText(const std::vector<stats::StatisticResult>& results, bool compared) {
  std::string text =
      fmt::format("{:<28} {:<6} {:>9}  {:<20}", "statistic", "unit", "value", "95 % interval");
  if (compared) text += fmt::format(" {:>9}  {:<20} {:>9}", "natural", "95 % interval", "noise");
  text += "\n";
  for (const stats::StatisticResult& r : results) {
    text += fmt::format("{:<28} {:<6} {:>9}  {:<20}", r.name, r.unit, cell(r.value),
                        range(r.low, r.high));
    if (compared)
      text += fmt::format(" {:>9}  {:<20} {:>9}", cell(r.natural),
                          range(r.naturalLow, r.naturalHigh), cell(r.noiseFloor));
    if (r.leftOut > 0)
      text += fmt::format("  ({} of {} clips left out)", r.leftOut, r.clips + r.leftOut);
    text += "\n";
  }
  return text;
}

std::string headText(const ClipStatistics& found) {
  std::string text = fmt::format("{} clips, {:.1f} s at {} frames per second\n", found.clips,
                                 found.seconds, found.fps);
  if (const std::string missing = found.inputs.missingText(); !missing.empty())
    text += missing + "\n";
  if (found.compared) text += "compared with " + found.comparedWith + "\n";
  if (!found.footsteps) return text + "no feet: choose them with --feet to count footsteps\n\n";
  std::string names;
  for (int foot : found.feet) names += (names.empty() ? "" : ", ") + found.skeleton->names[foot];
  const stats::FootstepCurve& curve = *found.footsteps;
  text += fmt::format("footsteps of {}: {:g} at most", names, curve.maxCount);
  if (curve.maxCount > 0.0)
    text += fmt::format(", 95 % of them at {:.3g} cm/s, lasting {:.2f} +- {:.2f} s", curve.v95CmS,
                        curve.durationMeanS, curve.durationStdS);
  return text + "\n\n";
}

void runAnalyze(const Context& context, const AnalyzeOptions& options) {
  Progress progress = context.progress("analyzing");
  const io::Inputs inputs = io::findInputs(options.inputs);
  io::InputReport report(inputs);
  ClipStatisticsRequest request{.clips = {inputs.files, options.read, options.fps},
                                .natural = {{}, options.read, 0.0},
                                .controls = controlRule(options.controls),
                                .against = naturalChoiceByName(options.natural),
                                .feet = options.feet,
                                .footStepCmS = options.toleranceStepCmS,
                                .options = {.resamples = options.resamples, .seed = context.seed}};
  if (!options.against.empty()) {
    const io::Inputs natural = io::findInputs(options.against);
    request.natural.files = natural.files;
    report.add(io::InputReport(natural));
  }
  const ClipStatistics found = clipStatistics(request, *context.ranks, progress);
  if (!context.ranks->first()) return;
  report.add(found.inputs);
  Json result = {{"clips", found.clips}, {"seconds", found.seconds}, {"fps", found.fps}};
  if (found.compared) result["compared_with"] = found.comparedWith;
  if (found.footsteps) result["footsteps"] = footstepsJson(*found.footsteps);
  result["bone_length_rmse_cm"] = nullptr;
  Json list = Json::array();
  for (const stats::StatisticResult& r : found.results) {
    if (r.name == "bone_length_rmse") result["bone_length_rmse_cm"] = numberOrNull(r.value);
    list.push_back(statisticJson(r, found.compared));
  }
  result["statistics"] = std::move(list);
  report.addTo(result);
  tell(context, report);
  context.print(result, headText(found) + statisticsText(found.results, found.compared));
}

}  // namespace

void addAnalyzeCommand(CLI::App& app, Context& context) {
  auto options = std::make_shared<AnalyzeOptions>();
  CLI::App* command = addCommand(
      app, context, "analyze", "Footsteps, bone lengths and other statistics of clips",
      "marey analyze samples/ --against @test.txt --fps 20 --feet LeftFoot,RightFoot",
      [&context, options] { runAnalyze(context, *options); }, Processes::Many);
  command->add_option("inputs", options->inputs, "motion files, folders or @LIST")->required();
  command->add_option("--against", options->against,
                      "natural motion to compare with: files, folders or @LIST");
  command
      ->add_option(
          "--natural", options->natural,
          "which of them: all, same-control (of the same file name as a clip, drawn with it "
          "as a pair) or same-style (of the same name but for its number)")
      ->check(CLI::IsMember({"all", "same-control", "same-style"}))
      ->capture_default_str();
  command
      ->add_option("--controls", options->controls,
                   "which clips follow one control and are one cluster: each (none), folder (those "
                   "of one folder) or one (all)")
      ->check(CLI::IsMember({"each", "folder", "one"}))
      ->capture_default_str();
  command
      ->add_option("--fps", options->fps,
                   "frame rate of the analysis (default: that of the first clip)")
      ->check(CLI::PositiveNumber);
  command->add_option("--feet", options->feet,
                      "names of the foot joints, A,B (default: found by their names)");
  command
      ->add_option("--tolerance-step", options->toleranceStepCmS,
                   "increment of the footstep tolerance in cm/s (default: 1.0; quadrupeds 0.3)")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--resamples", options->resamples,
                   "bootstrap resamples of the intervals; 0: no intervals")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  addReadOptions(*command, options->read);
}

}  // namespace marey::cli
