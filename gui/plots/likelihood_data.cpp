#include "gui/plots/likelihood_data.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gui/plots/count_strip.h"
#include <fmt/format.h>

#include "base/quantile.h"
#include "model/pose_units.h"
#include "motion/main_body.h"
#include "stats/sample_distance.h"

namespace marey::gui {
namespace {
using render::Series;
using render::SeriesKind;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

LikelihoodRun runOf(MotionId id, const ClipScore& score, const Clip& clip) {
  LikelihoodRun out{id, score.firstFrame, score.loglikNats};
  for (const int joint : score.oddestJoint)
    if (joint < clip.jointCount())
      out.joints.push_back(clip.skeleton->names[static_cast<size_t>(joint)]);
  return out;
}

void addNatural(std::vector<LikelihoodGroup>& out, const MotionSet& set, const std::string& system,
                const std::vector<ClipScore>& scores, double fps) {
  LikelihoodGroup group{.look = lookOf(set),
                        .fps = fps,
                        .runs = {},
                        .system = system,
                        .body = set.clips.front()->skeleton};
  group.look.name = "natural under " + system;
  group.look.dashed =
      std::any_of(out.begin(), out.end(), [](const LikelihoodGroup& g) { return g.look.natural; });
  group.look.ids.clear();
  for (size_t at = 0; at < set.ids.size(); ++at) {
    const MotionId id = set.ids[at];
    const auto index = static_cast<size_t>(id.index);
    if (index >= scores.size() || scores[index].loglikNats.empty()) continue;
    group.look.ids.push_back(id);
    group.unit = scores[index].unit;
    group.runs.push_back(runOf(id, scores[index], *set.clips[at]));
  }
  group.notScored = static_cast<int>(set.ids.size() - group.runs.size());
  out.push_back(std::move(group));
}

/// Values at the frames of the clip, from frame 0: runs of other models start elsewhere.
std::vector<double> fromFrameZero(const LikelihoodRun& run) {
  std::vector<double> out(static_cast<size_t>(run.firstFrame), kNaN);
  out.insert(out.end(), run.nats.begin(), run.nats.end());
  return out;
}

void addBand(LinkedGrid& out, const LikelihoodGroup& group) {
  std::vector<std::vector<double>> runs;
  for (const LikelihoodRun& run : group.runs) runs.push_back(fromFrameZero(run));
  Band band = bandOf(runs);
  if (band.step.empty()) return;
  for (double& t : band.step) t /= group.fps;
  if (group.runs.size() > 1)
    out.add(group.look.band(band.step, band.low, band.high), group.look.ids);
  out.add(group.look.line(std::move(band.step), std::move(band.median)), group.look.ids);
}

void addCloud(LinkedGrid& out, const LikelihoodGroup& group) {
  if (group.runs.empty()) return;
  size_t frames = 0;
  for (const LikelihoodRun& run : group.runs)
    frames = std::max(frames, static_cast<size_t>(run.firstFrame) + run.nats.size());
  std::vector<float> rows(frames * group.runs.size(), static_cast<float>(kNaN));
  for (size_t r = 0; r < group.runs.size(); ++r) {
    const LikelihoodRun& run = group.runs[r];
    auto to = rows.begin() + static_cast<std::ptrdiff_t>(r * frames) + run.firstFrame;
    for (const double v : run.nats) *to++ = static_cast<float>(v);
  }
  Series cloud{.kind = SeriesKind::Cloud,
               .name = group.look.name,
               .colour = group.look.colour,
               .width = 1.2,
               .opacity = std::clamp(3.0 / static_cast<double>(group.runs.size()), 0.03, 0.8)};
  for (size_t t = 0; t < frames; ++t) cloud.x.push_back(static_cast<double>(t) / group.fps);
  cloud.cloud = std::make_shared<const render::CloudLines>(std::move(rows));
  out.add(std::move(cloud), group.look.ids);
}

/// Scores of one set under one system.
struct Scored {
  LikelihoodRow row;
  std::vector<ClipScore> scores;
  std::shared_ptr<const ModelInfo> info;
};

std::vector<Scored> scoredSets(const std::vector<MotionGroup>& groups, const MotionSet& set,
                               const std::vector<std::string>& systems,
                               const NaturalScores& naturalScores) {
  const auto owner = std::find_if(groups.begin(), groups.end(),
                                  [&](const MotionGroup& g) { return g.id == set.group; });
  std::vector<Scored> out;
  for (const std::string& system : set.natural ? systems : std::vector<std::string>{set.system}) {
    const auto* natural = set.natural ? naturalScores(system) : nullptr;
    if (set.natural && natural == nullptr) continue;
    Scored scored{.row = {set.natural ? "natural" : set.name, system, set.natural, {}, {}},
                  .scores = {},
                  .info = nullptr};
    for (const MotionId& id : set.ids) {
      const auto index = static_cast<size_t>(id.index);
      const Motion& motion = owner->motions[index];
      if (natural != nullptr && index < natural->size() && !(*natural)[index].name.empty()) {
        scored.scores.push_back((*natural)[index]);
      } else if (!set.natural && motion.score) {
        scored.scores.push_back(*motion.score);
        scored.scores.back().name = motion.clip->name;
      }
    }
    if (!scored.scores.empty()) out.push_back(std::move(scored));
  }
  return out;
}

/// One frame far below all others must not flatten the rest.
std::optional<std::pair<double, double>> centralRange(const std::vector<LikelihoodGroup>& groups) {
  std::vector<double> all;
  for (const LikelihoodGroup& group : groups)
    for (const LikelihoodRun& run : group.runs)
      for (const double v : run.nats)
        if (std::isfinite(v)) all.push_back(v);
  if (all.size() < 2) return std::nullopt;
  std::sort(all.begin(), all.end());
  const double low = sortedQuantile(all, 0.002), high = all.back();
  if (!(low < high)) return std::nullopt;
  return std::pair{low - 0.06 * (high - low), high + 0.06 * (high - low)};
}
}  // namespace

std::vector<LikelihoodGroup> likelihoodGroups(const std::vector<MotionGroup>& groups,
                                              const std::vector<std::string>& systems,
                                              const NaturalScores& naturalScores, double fps) {
  std::vector<LikelihoodGroup> out;
  for (const MotionSet& set : motionSets(groups)) {
    if (set.natural) {
      for (const std::string& system : systems)
        if (const auto* scores = naturalScores(system)) addNatural(out, set, system, *scores, fps);
      continue;
    }
    const auto owner = std::find_if(groups.begin(), groups.end(),
                                    [&](const MotionGroup& g) { return g.id == set.group; });
    LikelihoodGroup group{.look = lookOf(set),
                          .fps = set.clips.front()->fps,
                          .runs = {},
                          .system = set.system,
                          .body = set.clips.front()->skeleton};
    group.look.ids.clear();
    for (const MotionId& id : set.ids) {
      const auto& score = owner->motions[static_cast<size_t>(id.index)].score;
      if (!score || score->loglikNats.empty()) continue;
      group.look.ids.push_back(id);
      group.unit = score->unit;
      group.runs.push_back(runOf(id, *score, *owner->motions[static_cast<size_t>(id.index)].clip));
    }
    if (!group.runs.empty()) out.push_back(std::move(group));
  }
  return out;
}

std::vector<double> runningMean(const std::vector<double>& values, int window) {
  const int half = std::max(0, window / 2), count = static_cast<int>(values.size());
  std::vector<double> sums{0.0}, out;
  for (const double v : values) sums.push_back(sums.back() + v);
  for (int t = 0; t < count; ++t) {
    const int first = std::max(0, t - half), last = std::min(count, t + half + 1);
    out.push_back((sums[static_cast<size_t>(last)] - sums[static_cast<size_t>(first)]) /
                  (last - first));
  }
  return out;
}

void smooth(std::vector<LikelihoodGroup>& groups, double seconds) {
  for (LikelihoodGroup& group : groups)
    for (LikelihoodRun& run : group.runs)
      run.nats = runningMean(run.nats, static_cast<int>(std::lround(seconds * group.fps)));
}

std::optional<WorstFrame> worstFrame(const std::vector<LikelihoodGroup>& groups,
                                     const std::optional<TimeRange>& range,
                                     const std::string& system) {
  std::optional<WorstFrame> worst;
  for (const bool natural : {false, true}) {
    for (const LikelihoodGroup& group : groups) {
      if (group.look.natural != natural || group.system != system) continue;
      for (const LikelihoodRun& run : group.runs)
        for (size_t i = 0; i < run.nats.size(); ++i) {
          const double time = (run.firstFrame + static_cast<double>(i)) / group.fps;
          if (range && (time < range->beginS || time > range->endS)) continue;
          if (!worst || run.nats[i] < worst->nats)
            worst = WorstFrame{run.id, time, run.nats[i], group.unit,
                               i < run.joints.size() ? run.joints[i] : std::string()};
        }
    }
    if (worst) break;
  }
  return worst;
}

std::vector<std::string> systemsIn(const std::vector<LikelihoodGroup>& groups) {
  std::vector<std::string> out;
  for (const LikelihoodGroup& group : groups)
    if (!group.runs.empty() && std::find(out.begin(), out.end(), group.system) == out.end())
      out.push_back(group.system);
  return out;
}

std::string notScoredText(const std::vector<LikelihoodGroup>& groups) {
  std::string out;
  for (const LikelihoodGroup& group : groups) {
    const int scored = static_cast<int>(group.runs.size());
    if (group.notScored > 0)
      out += fmt::format("{}{} {} of {} scored", out.empty() ? "" : ", ", group.look.name, scored,
                         scored + group.notScored);
  }
  return out;
}

std::vector<LikelihoodRow> likelihoodRows(const std::vector<MotionGroup>& groups,
                                          const std::vector<std::string>& systems,
                                          const NaturalScores& naturalScores,
                                          const ModelFacts& facts) {
  std::vector<Scored> sets;
  for (const MotionSet& set : motionSets(groups))
    for (Scored& scored : scoredSets(groups, set, systems, naturalScores))
      if ((scored.info = facts(scored.row.system))) sets.push_back(std::move(scored));
  int first = 0;
  std::erase_if(sets, [](const Scored& s) { return s.info->density == DensityKind::None; });
  for (const Scored& set : sets) first = std::max(first, set.info->context);
  std::vector<LikelihoodRow> out;
  for (Scored& set : sets) {
    set.row.summary = summarise(*set.info, set.scores, first);
    set.row.floor = floorText(*set.info);
    out.push_back(std::move(set.row));
  }
  return out;
}

namespace {
/// Whether likelihoods of two groups are on one scale. A group without runs has no unit.
bool comparable(const LikelihoodGroup& a, const LikelihoodGroup& b) {
  return sameJoints(*a.body, *b.body) && (a.unit == b.unit || a.unit.empty() || b.unit.empty());
}

/// The chart of every group: one for each skeleton and unit, by their first groups.
std::vector<int> chartsOf(const std::vector<LikelihoodGroup>& groups) {
  std::vector<int> out;
  std::vector<const LikelihoodGroup*> kinds;
  for (const LikelihoodGroup& group : groups) {
    size_t chart = 0;
    while (chart < kinds.size() && !comparable(*kinds[chart], group)) ++chart;
    if (chart == kinds.size()) kinds.push_back(&group);
    out.push_back(static_cast<int>(chart));
  }
  return out;
}

MotionCount countOf(const LikelihoodGroup& group) {
  MotionCount count{group.look, group.fps, {}};
  for (const LikelihoodRun& run : group.runs) {
    const auto first = static_cast<size_t>(run.firstFrame);
    count.goingOn.resize(std::max(count.goingOn.size(), first + run.nats.size()), 0);
    for (size_t i = 0; i < run.nats.size(); ++i) ++count.goingOn[first + i];
  }
  return count;
}

std::string unitOf(const std::vector<LikelihoodGroup>& alike) {
  for (const LikelihoodGroup& group : alike)
    if (!group.unit.empty()) return group.unit;
  return {};
}

/// What the linear-Gaussian autoregression of a system makes of the natural clips.
void addRule(LinkedGrid& out, const LikelihoodRow& row, bool named) {
  render::Chart& chart = out.grid.charts.back();
  const double nats = row.summary.linearGaussian;
  if (chart.y.range) {
    const double margin = 0.04 * (chart.y.range->second - nats);
    chart.y.range->first = std::min(chart.y.range->first, nats - margin);
  }
  out.add({.kind = SeriesKind::HorizontalRule,
           .name = named ? "linear-Gaussian, " + row.system : "linear-Gaussian",
           .colour = render::grey(0.45),
           .y = {nats},
           .width = 1.4,
           .dashed = true});
}

/// The groups of one skeleton and unit in the last chart of the grid.
void addBody(LinkedGrid& out, const std::vector<LikelihoodGroup>& groups,
             const std::vector<LikelihoodRow>& rows, bool everyMotion) {
  render::Chart& chart = out.grid.charts.back();
  chart.x = {.label = "time", .unit = "s"};
  chart.y = {.label = "log-likelihood", .unit = unitOf(groups)};
  for (const LikelihoodGroup& group : groups)
    everyMotion ? addCloud(out, group) : addBand(out, group);
  if (everyMotion) chart.y.range = centralRange(groups);
  std::vector<const LikelihoodRow*> rules;
  for (const LikelihoodRow& row : rows)
    if (row.natural && std::isfinite(row.summary.linearGaussian) &&
        std::any_of(groups.begin(), groups.end(),
                    [&](const LikelihoodGroup& g) { return g.system == row.system; }))
      rules.push_back(&row);
  for (const LikelihoodRow* row : rules) addRule(out, *row, rules.size() > 1);
}
}  // namespace

LinkedGrid likelihoodGrid(const std::vector<LikelihoodGroup>& groups,
                          const std::vector<LikelihoodRow>& rows, bool everyMotion) {
  if (groups.empty()) return {.grid = render::single({})};
  LinkedGrid out;
  const std::vector<int> charts = chartsOf(groups);
  const int bodies = *std::max_element(charts.begin(), charts.end()) + 1;
  for (int body = 0; body < bodies; ++body) {
    std::vector<LikelihoodGroup> alike;
    for (size_t g = 0; g < groups.size(); ++g)
      if (charts[g] == body) alike.push_back(groups[g]);
    out.grid.charts.push_back({});
    addBody(out, alike, rows, everyMotion);
    if (bodies > 1)
      out.grid.charts.back().title = fmt::format("{} joints: {}", alike.front().body->jointCount(),
                                                 fmt::join(systemsIn(alike), ", "));
  }
  out.grid.shareX = bodies > 1;
  std::vector<MotionCount> counts;
  for (const LikelihoodGroup& group : groups) counts.push_back(countOf(group));
  addCountStrip(out, counts);
  return out;
}

void markWorst(LinkedGrid& grid, const std::vector<LikelihoodGroup>& groups,
               const WorstFrame& worst) {
  const std::vector<int> charts = chartsOf(groups);
  for (size_t g = 0; g < groups.size(); ++g) {
    const auto& runs = groups[g].runs;
    if (std::none_of(runs.begin(), runs.end(), [&](const auto& r) { return r.id == worst.id; }))
      continue;
    grid.addTo(charts[g],
               {.kind = SeriesKind::VerticalRule,
                .name = fmt::format("worst frame, {:.0f} {}{}{}", worst.nats, natsUnit(worst.unit),
                                    worst.joint.empty() ? "" : ": ", worst.joint),
                .colour = render::grey(0.45),
                .x = {worst.timeS},
                .width = 1.2,
                .dashed = true},
               {worst.id});
    return;
  }
}

std::vector<ChartHighlight> likelihoodHighlights(const std::vector<LikelihoodGroup>& groups,
                                                 const std::set<MotionId>& picked) {
  std::vector<ChartHighlight> out;
  const std::vector<int> charts = chartsOf(groups);
  for (size_t g = 0; g < groups.size(); ++g) {
    const LikelihoodGroup& group = groups[g];
    if (!group.look.singles(picked)) continue;
    for (const LikelihoodRun& run : group.runs) {
      if (!picked.contains(run.id) || out.size() >= kMostHighlights) continue;
      std::vector<double> x;
      for (size_t i = 0; i < run.nats.size(); ++i)
        x.push_back((run.firstFrame + static_cast<double>(i)) / group.fps);
      out.push_back(group.look.highlight(charts[g], std::move(x), run.nats));
    }
  }
  return out;
}

}  // namespace marey::gui
