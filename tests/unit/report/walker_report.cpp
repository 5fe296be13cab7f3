#include "unit/report/walker_report.h"

#include <cmath>

#include "base/random.h"
#include "motion/path.h"
#include "motion/roles.h"
#include "motion/walker.h"
#include "stats/footsteps.h"
#include "stats/joint_samples.h"

namespace marey::report {

namespace {
constexpr double fps = 60.0;

void addClips(ReportSystem& system, const std::string& style, uint64_t seed,
              const std::vector<std::string>& paths, int count, double seconds) {
  for (const std::string& path : paths) {
    for (int i = 0; i < count; ++i) {
      WalkerOptions options;
      options.style = style;
      options.seed = seed + static_cast<uint64_t>(i);
      options.fps = fps;
      auto clip = walk(presetPath(path, seconds, fps), options).clip;
      system.clips[path].push_back(std::make_shared<const Clip>(std::move(clip)));
    }
  }
}

std::vector<Clip> allClips(const ReportSystem& system) {
  std::vector<Clip> clips;
  for (const auto& [path, shared] : system.clips) {
    for (const auto& clip : shared) clips.push_back(*clip);
  }
  return clips;
}

stats::FootstepCurve curveOf(const ReportSystem& system) {
  const std::vector<Clip> clips = allClips(system);
  return stats::footstepCurve(clips, {.feet = rolesOf(*clips.front().skeleton).feet});
}

void addFootsteps(ReportData& data) {
  FootstepPanel panel{"All paths", {}};
  Table table{
      .id = "footsteps",
      .title = "Footsteps",
      .caption = "Footsteps at v95, their duration, and how constant bone lengths are.",
      .section = Section::Footsteps,
      .columns = {{"System"},
                  {"f", "", "number of footsteps at v95"},
                  {"v95", "cm/s", "smallest speed tolerance that finds 95 % of the highest count"},
                  {"duration, mean", "s"},
                  {"duration, sd", "s"}},
      .rows = {}};
  for (int s = 0; s < static_cast<int>(data.systems.size()); ++s) {
    const stats::FootstepCurve curve = curveOf(data.systems[static_cast<size_t>(s)]);
    panel.curves.push_back(
        {s, curve.toleranceCmS, {curve.count.begin(), curve.count.end()}, curve.v95CmS});
    table.rows.push_back({{data.systems[static_cast<size_t>(s)].name},
                          numberCell(static_cast<double>(curve.maxCount), 0),
                          numberCell(curve.v95CmS, 0),
                          numberCell(curve.durationMeanS, 2),
                          numberCell(curve.durationStdS, 2)});
  }
  data.footsteps.push_back(std::move(panel));
  data.tables.push_back(std::move(table));
}

void addGait(ReportData& data, const std::string& path) {
  GaitPanel panel{"Foot contacts, path " + path, 0.0, {}};
  for (int s = 0; s < static_cast<int>(data.systems.size()); ++s) {
    const Clip& clip = *data.systems[static_cast<size_t>(s)].clips.at(path).front();
    panel.seconds = clip.seconds();
    for (const int foot : rolesOf(*clip.skeleton).feet) {
      GaitRow row{s, clip.skeleton->names[static_cast<size_t>(foot)], {}};
      for (const auto& c : stats::contactIntervals(clip, {foot}, 20.0)) {
        row.contactsS.emplace_back(c.firstFrame / clip.fps, (c.lastFrame + 1) / clip.fps);
      }
      panel.rows.push_back(std::move(row));
    }
  }
  data.gaits.push_back(std::move(panel));
}

void addDistributions(ReportData& data) {
  const Skeleton& skeleton = *walkerSkeleton();
  const std::vector<std::pair<stats::Quantity, std::vector<std::string>>> wanted = {
      {stats::Quantity::Speed, {"LeftFoot", "RightFoot", "LeftHand", "RightHand", "Head", "Hips"}},
      {stats::Quantity::Angle, {"LeftLeg", "RightLeg", "LeftForeArm"}}};
  for (const auto& [quantity, joints] : wanted) {
    for (const std::string& joint : joints) {
      const int index = skeleton.find(joint);
      if (index < 0 || !stats::isDefined(skeleton, quantity, index)) continue;
      const stats::QuantityText& text = stats::textOf(quantity);
      DistributionPanel panel{joint, text.name, text.unit, {}};
      for (int s = 0; s < static_cast<int>(data.systems.size()); ++s) {
        panel.samples.push_back(
            {s, stats::pooledSamples(allClips(data.systems[static_cast<size_t>(s)]), quantity,
                                     index)});
      }
      data.distributions.push_back(std::move(panel));
    }
  }
}

void addLikelihood(ReportData& data, const std::string& path, double seconds) {
  LikelihoodPanel panel{"Path " + path, "nats per frame, cm", 20.0, {}, 39.9};
  const int frames = static_cast<int>(seconds * 20.0);
  for (int s = 0; s < static_cast<int>(data.systems.size()); ++s) {
    LikelihoodGroup group{s, {}};
    for (uint32_t run = 0; run < 8; ++run) {
      std::vector<double> nats;
      for (int t = 0; t < frames; ++t) {
        const double noise = normalAt({.seed = 3,
                                       .sample = run,
                                       .frame = static_cast<uint32_t>(t),
                                       .stage = RandomStage::Test},
                                      static_cast<uint32_t>(s));
        nats.push_back(130.0 - 25.0 * s + 12.0 * std::sin(0.6 * t + s) + 9.0 * noise);
      }
      group.nats.push_back(std::move(nats));
    }
    panel.groups.push_back(std::move(group));
  }
  data.likelihoods.push_back(std::move(panel));
}

Table statisticsTable() {
  Table table{
      .id = "statistics",
      .title = "Statistics",
      .caption = "Value with its 95 % bootstrap interval, the natural value, and the noise floor.",
      .section = Section::Statistics,
      .columns =
          {{"Statistic"}, {"Value"}, {"95 % from"}, {"to"}, {"Natural"}, {"Noise floor"}, {"Unit"}},
      .rows = {}};
  table.rows.push_back({{"step duration, mean"},
                        numberCell(0.612, 3),
                        numberCell(0.598, 3),
                        numberCell(0.627, 3),
                        numberCell(0.634, 3),
                        numberCell(0.012, 3),
                        {"s"}});
  table.rows.push_back({{"root path error"},
                        numberCell(1.84, 2),
                        numberCell(1.71, 2),
                        numberCell(1.99, 2),
                        numberCell(NAN, 2),
                        numberCell(0.4, 2),
                        {"cm"}});
  return table;
}
}  // namespace

ReportData walkerReport(const std::vector<std::string>& paths, int clipsPerPath, double seconds) {
  ReportData data;
  data.title = "Walker against walker";
  data.summary =
      "Three gaits of the procedural walker on the same paths, shown as natural motion and two "
      "systems. "
      "The feet of all three are planted exactly, so differences lie in posture and timing.";
  data.recipe = {{"program", "marey"},
                 {"version", "0.1.0"},
                 {"command", "marey report walker.json --out report"},
                 {"seed", "1"},
                 {"temperature", "1"},
                 {"experiment", "0f5e9c2d7b1a4c3e8d6f0a1b2c3d4e5f"}};
  data.systems = {{"natural", 0, true}, {"MG", 1}, {"MG+", 0}};
  addClips(data.systems[0], "normal", 1, paths, 1, seconds);
  addClips(data.systems[1], walkerStyles().back().name, 100, paths, clipsPerPath, seconds);
  addClips(data.systems[2], "normal", 200, paths, clipsPerPath, seconds);
  for (const std::string& path : paths) {
    data.scenes.push_back(
        {.path = path, .title = "Path " + path, .line = presetPath(path, seconds, fps)});
  }
  addLikelihood(data, paths.front(), seconds);
  addFootsteps(data);
  addGait(data, paths.front());
  addDistributions(data);
  data.tables.push_back(statisticsTable());
  data.notes = {
      {"Limits", "Likelihoods on this page are made up.\n\nAll other numbers are measured."}};
  return data;
}

}  // namespace marey::report
