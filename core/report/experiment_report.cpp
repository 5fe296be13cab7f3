#include "report/experiment_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiment/comparison.h"
#include "experiment/recipe.h"
#include "stats/footsteps.h"
#include "stats/joint_samples.h"

namespace marey::report {
namespace {

constexpr double kSceneSeconds = 6.0;
constexpr double kGaitToleranceCmS = 15.0;
constexpr size_t kLikelihoodRuns = 12;  ///< natural clips in a timeline, the longest first

std::vector<ReportSystem> systemsOf(const ExperimentResult& r) {
  std::vector<ReportSystem> out;
  out.push_back({.name = "natural", .natural = true});
  for (size_t i = 0; i < r.systems.size(); ++i) {
    ReportSystem system{.name = labelOf(r.systems[i]), .colourIndex = static_cast<int>(i)};
    for (const auto& [name, samples] : r.systems[i].paths) system.clips[name] = samples.clips;
    out.push_back(std::move(system));
  }
  return out;
}

/// The natural clip that is shown: the longest one.
size_t shownClip(const std::vector<Clip>& clips) {
  return static_cast<size_t>(std::max_element(clips.begin(), clips.end(),
                                              [](const Clip& a, const Clip& b) {
                                                return a.frameCount() < b.frameCount();
                                              }) -
                             clips.begin());
}

/// One natural clip and what each system made of its control, as a path of its own.
void addHeldOutScene(const ExperimentResult& r, ReportData& out) {
  const size_t shown = shownClip(r.natural);
  const std::string name = "control of " + r.natural[shown].name;
  out.systems[0].clips[name] = {std::make_shared<const Clip>(r.natural[shown])};
  ScenePanel panel{.path = name,
                   .title = "Held-out control: " + r.natural[shown].name,
                   .clipsPerSystem = 1,
                   .seconds = kSceneSeconds};
  for (size_t i = 0; i < r.systems.size(); ++i) {
    const auto& system = r.systems[i];
    const size_t index = shown * static_cast<size_t>(r.experiment.heldOutSamples);
    if (index >= system.heldOut.size()) continue;
    out.systems[i + 1].clips[name] = {std::make_shared<const Clip>(system.heldOut[index])};
    panel.line = system.heldOutPaths[index];
  }
  out.scenes.push_back(std::move(panel));
}

void addPathScenes(const ExperimentResult& r, ReportData& out) {
  if (r.systems.empty()) return;
  for (const auto& path : r.experiment.paths)
    out.scenes.push_back({.path = path.name,
                          .title = "Sampled along the path: " + path.name,
                          .line = r.systems.front().paths.at(path.name).wanted,
                          .seconds = kSceneSeconds});
}

std::vector<std::vector<double>> longestRuns(const std::vector<ClipScore>& scores) {
  std::vector<const ClipScore*> order;
  for (const auto& score : scores) order.push_back(&score);
  std::stable_sort(order.begin(), order.end(),
                   [](auto a, auto b) { return a->loglikNats.size() > b->loglikNats.size(); });
  if (order.size() > kLikelihoodRuns) order.resize(kLikelihoodRuns);
  std::vector<std::vector<double>> out;
  for (const auto* score : order) {
    if (score->loglikNats.empty()) continue;
    out.push_back(score->loglikNats);
  }
  return out;
}

/// What the numbers hang on, and what was left out of them.
std::string likelihoodNote(const SystemResult& s) {
  std::string out = floorText(s.info);
  if (const std::string text = tooShortText(s.naturalLikelihood); !text.empty())
    out += " Natural motion: " + text + ".";
  if (const std::string text = tooShortText(s.heldOutLikelihood); !text.empty())
    out += " Samples: " + text + ".";
  return out;
}

void addLikelihoods(const ExperimentResult& r, ReportData& out) {
  for (size_t i = 0; i < r.systems.size(); ++i) {
    const SystemResult& s = r.systems[i];
    if (s.info.density == DensityKind::None) continue;
    LikelihoodPanel panel{.title = "Log-likelihood under " + labelOf(s),
                          .unit = s.naturalLikelihood.unit,
                          .fps = r.experiment.fps};
    panel.groups.push_back({0, longestRuns(s.naturalScores)});
    std::vector<ClipScore> sampled;
    for (const auto& [name, samples] : s.paths)
      sampled.insert(sampled.end(), samples.scores.begin(), samples.scores.end());
    if (sampled.empty()) sampled = s.heldOutScores;
    panel.groups.push_back({static_cast<int>(i + 1), longestRuns(sampled)});
    if (std::isfinite(s.naturalLikelihood.linearGaussian))
      panel.linearGaussianNats = s.naturalLikelihood.linearGaussian;
    panel.note = likelihoodNote(s);
    out.likelihoods.push_back(std::move(panel));
  }
}

FootstepSeries seriesOf(int system, const std::vector<Clip>& clips,
                        const std::vector<int>& controls, const ExperimentResult& r) {
  auto curve = stats::footstepCurve(
      clips, {.feet = r.feet, .stepCmS = r.experiment.toleranceStepCmS}, controls);
  return {system, std::move(curve.toleranceCmS), std::move(curve.count), curve.v95CmS};
}

void addFootsteps(const ExperimentResult& r, ReportData& out) {
  FootstepPanel panel{.title = "Footsteps on held-out control"};
  panel.curves.push_back(seriesOf(0, r.natural, {}, r));
  for (size_t i = 0; i < r.systems.size(); ++i)
    if (!r.systems[i].heldOut.empty())
      panel.curves.push_back(seriesOf(static_cast<int>(i + 1), r.systems[i].heldOut,
                                      heldOutControls(r.systems[i], r.experiment), r));
  out.footsteps.push_back(std::move(panel));
}

void addGaitRows(int system, const Clip& clip, const ExperimentResult& r, double toleranceCmS,
                 GaitPanel& panel) {
  for (const int foot : r.feet) {
    GaitRow row{.system = system, .foot = clip.skeleton->names[static_cast<size_t>(foot)]};
    for (const auto& contact : stats::contactIntervals(clip, {foot}, toleranceCmS))
      row.contactsS.emplace_back((contact.firstFrame - 1) / clip.fps, contact.lastFrame / clip.fps);
    panel.rows.push_back(std::move(row));
  }
}

void addGait(const ExperimentResult& r, ReportData& out) {
  const size_t shown = shownClip(r.natural);
  const double v95 = out.footsteps.front().curves.front().v95CmS;
  if (!std::isfinite(v95)) return;
  // Feet that plant exactly have a v95 at which no sample would ever touch the floor.
  const double tolerance = std::max(kGaitToleranceCmS, v95);
  GaitPanel panel{.title = fmt::format("Feet on the floor: {} (slower than {:.0f} cm/s)",
                                       r.natural[shown].name, tolerance),
                  .seconds = std::min(10.0, r.natural[shown].seconds())};
  addGaitRows(0, r.natural[shown], r, tolerance, panel);
  for (size_t i = 0; i < r.systems.size(); ++i) {
    const size_t index = shown * static_cast<size_t>(r.experiment.heldOutSamples);
    if (index < r.systems[i].heldOut.size())
      addGaitRows(static_cast<int>(i + 1), r.systems[i].heldOut[index], r, tolerance, panel);
  }
  out.gaits.push_back(std::move(panel));
}

render::Recipe recipeFor(const ExperimentResult& r, const std::string& command) {
  std::vector<RecipeSet> sets = {{"natural", {}, std::to_string(r.natural.size())}};
  for (const auto& s : r.systems)
    sets.push_back(
        {s.name, SampleOrigin{s.info.hash, r.experiment.seed, s.temperature, s.options},
         std::to_string(r.experiment.samples * static_cast<int>(r.experiment.paths.size()))});
  render::Recipe out = recipeOf(r.hash, sets);
  out.emplace_back("command", command);
  out.emplace_back("fps", fmt::format("{}", r.experiment.fps));
  for (const auto& s : r.systems) {
    out.emplace_back("model " + s.name, s.info.variant);
    if (s.info.provenance.contains("steps"))
      out.emplace_back(
          "training " + s.name,
          fmt::format("{} steps, {:.0f} min", s.info.provenance["steps"].get<int64_t>(),
                      s.info.provenance.value("training_seconds", 0.0) / 60.0));
  }
  return out;
}

std::string leftOutText(const ExperimentResult& r) {
  std::string out = fmt::format("Not counted anywhere in this report ({}):", r.leftOut.size());
  for (const LeftOut& one : r.leftOut) out += fmt::format("\n\n{}: {}", one.what, one.why);
  return out;
}

/// Files that were not read and what is doubtful in the others; empty: neither.
std::string filesText(const ExperimentResult& r) {
  std::string out = r.inputs.missingText();
  for (const std::string& remark : r.inputs.remarks()) out += (out.empty() ? "" : "\n\n") + remark;
  return out;
}

std::string summaryOf(const ExperimentResult& r) {
  double seconds = 0.0;
  for (const Clip& clip : r.natural) seconds += clip.seconds();
  std::string out = fmt::format("{} natural clips ({:.1f} min at {:g} frames per second)",
                                r.natural.size(), seconds / 60.0, r.experiment.fps);
  for (const auto& s : r.systems)
    out += fmt::format(
        "; {} ({:.2f} M parameters, temperature {:g}) sampled along the control of every natural "
        "clip and {} times along each of {} paths",
        s.name, static_cast<double>(s.info.parameters) / 1e6, s.temperature, r.experiment.samples,
        r.experiment.paths.size());
  return out + ". Natural motion is drawn near-black, every system in one colour of its own.";
}

}  // namespace

std::vector<DistributionPanel> distributionPanels(const ExperimentResult& r) {
  const Skeleton& skeleton = *r.natural.front().skeleton;
  const SkeletonRoles roles = rolesOf(skeleton);
  std::vector<int> joints{roles.hips};
  joints.insert(joints.end(), r.feet.begin(), r.feet.end());
  if (const int head = skeleton.find("Head"); head >= 0) joints.push_back(head);
  // Hands: the far ends of the arms, as children go on from the shoulders.
  for (int joint : {roles.leftShoulder, roles.rightShoulder}) {
    if (joint < 0) continue;
    for (int depth = 0; depth < 2; ++depth)
      for (int child = joint + 1; child < skeleton.jointCount(); ++child)
        if (skeleton.parents[static_cast<size_t>(child)] == joint) {
          joint = child;
          break;
        }
    joints.push_back(joint);
  }
  std::vector<DistributionPanel> out;
  for (const auto quantity :
       {stats::Quantity::Speed, stats::Quantity::Height, stats::Quantity::Angle}) {
    for (const int joint : joints) {
      if (!stats::isDefined(skeleton, quantity, joint)) continue;
      const auto& text = stats::textOf(quantity);
      DistributionPanel panel{skeleton.names[static_cast<size_t>(joint)], text.name, text.unit, {}};
      panel.samples.push_back({0, stats::pooledSamples(r.natural, quantity, joint)});
      for (size_t i = 0; i < r.systems.size(); ++i)
        if (!r.systems[i].heldOut.empty())
          panel.samples.push_back({static_cast<int>(i + 1),
                                   stats::pooledSamples(r.systems[i].heldOut, quantity, joint)});
      out.push_back(std::move(panel));
    }
  }
  return out;
}

std::string missingText(const ExperimentResult& r) {
  std::string out = r.inputs.missingText();
  if (!r.leftOut.empty())
    out += fmt::format("{}{} left out of every number", out.empty() ? "" : ", ", r.leftOut.size());
  return out;
}

ReportData reportOf(const ExperimentResult& r, const std::string& command, Progress& progress) {
  ReportData out{.title = r.experiment.title,
                 .summary = summaryOf(r),
                 .recipe = recipeFor(r, command),
                 .systems = systemsOf(r)};
  addHeldOutScene(r, out);
  addPathScenes(r, out);
  addLikelihoods(r, out);
  addFootsteps(r, out);
  addGait(r, out);
  out.distributions = distributionPanels(r);
  out.tables = {footstepTable(r)};
  for (Table& table : likelihoodTables(r)) out.tables.push_back(std::move(table));
  if (!r.experiment.paths.empty() && !r.systems.empty()) out.tables.push_back(obedienceTable(r));
  if (!r.experiment.cases.empty() && !r.systems.empty()) out.tables.push_back(taskTable(r));
  for (Table& table : statisticTables(r, progress)) out.tables.push_back(std::move(table));
  if (!r.leftOut.empty()) out.notes.push_back({"Left out", leftOutText(r)});
  if (std::string text = filesText(r); !text.empty())
    out.notes.push_back({"Files of the natural motion", std::move(text)});
  if (!r.experiment.notes.empty())
    out.notes.push_back({"About this experiment", r.experiment.notes});
  return out;
}

}  // namespace marey::report
