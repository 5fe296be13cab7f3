// Curves, bands and tables of motions, against values worked out by hand.
#include <algorithm>
#include <cmath>

#include "gui/plots/distribution_data.h"
#include "gui/plots/diversity_data.h"
#include "gui/plots/footstep_data.h"
#include "gui/plots/likelihood_data.h"
#include "gui/plots/statistics_data.h"
#include <gtest/gtest.h>

#include "base/error.h"
#include "motion/path.h"
#include "motion/walker.h"
#include "render/chart/chart_frame.h"
#include "stats/diversity.h"
#include "stats/sample_distance.h"

namespace marey::gui {
namespace {

MotionGroup groupOf(int id, const std::string& name, int colour, std::vector<ClipPtr> clips) {
  MotionGroup group{
      .id = id, .name = name, .system = colour < 0 ? "" : name, .colourIndex = colour};
  for (ClipPtr& clip : clips) group.motions.push_back({.clip = std::move(clip), .score = {}});
  return group;
}

ClipPtr walkerClip(uint64_t seed, double seconds = 4.0) {
  return std::make_shared<const Clip>(walkerDataSet(1, seconds, seed, 20.0).front().clip);
}

std::vector<MotionGroup> twoGroups() {
  return {groupOf(1, "Natural", -1, {walkerClip(1), walkerClip(2), walkerClip(3)}),
          groupOf(2, "MG", 0, {walkerClip(4, 3.0), walkerClip(5, 3.0)})};
}

/// The same motion in a skeleton whose joints come in another order.
ClipPtr reordered(const Clip& clip) {
  Skeleton body = *clip.skeleton;
  Clip out = clip;
  // Leaves may swap places without breaking the order of parents: the two feet's ends.
  const auto feet = stats::feetOf(body);
  const auto a = static_cast<size_t>(feet.front()), b = static_cast<size_t>(feet.back());
  std::swap(body.names[a], body.names[b]);
  out.skeleton = std::make_shared<const Skeleton>(body);
  for (int t = 0; t < out.frameCount(); ++t)
    std::swap(out.positions[static_cast<size_t>(t * out.jointCount()) + a],
              out.positions[static_cast<size_t>(t * out.jointCount()) + b]);
  return std::make_shared<const Clip>(std::move(out));
}

ClipPtr oneJointFewer(const Clip& clip) {
  Clip out = clip;
  Skeleton body = *clip.skeleton;
  const auto joints = static_cast<size_t>(body.jointCount());
  body.names.pop_back();
  body.parents.pop_back();
  body.offsets.pop_back();
  out.skeleton = std::make_shared<const Skeleton>(body);
  out.transforms.reset();
  out.positions.clear();
  for (size_t i = 0; i < clip.positions.size(); ++i)
    if (i % joints + 1 < joints) out.positions.push_back(clip.positions[i]);
  return std::make_shared<const Clip>(std::move(out));
}

TEST(MotionSets, TakeWhatIsUsedWhetherItIsShownOrHidden) {
  auto groups = twoGroups();
  groups[0].motions[1].used = false;
  groups[1].motions[0].used = false;
  std::swap(groups[0], groups[1]);
  const auto sets = motionSets(groups);
  ASSERT_EQ(sets.size(), 2U);
  EXPECT_TRUE(sets[0].natural);
  EXPECT_EQ(sets[0].ids, (std::vector<MotionId>{{1, 0}, {1, 2}}));
  EXPECT_EQ(sets[1].ids, (std::vector<MotionId>{{2, 1}}));
  EXPECT_EQ(countedText(sets), "Counted: Natural: 2 of 3; MG: 1 of 2");
  for (MotionGroup& group : groups)
    for (Motion& motion : group.motions) motion.visible = false;
  const auto hidden = motionSets(groups);
  ASSERT_EQ(hidden.size(), 2U);
  EXPECT_EQ(hidden[0].ids, sets[0].ids);
  EXPECT_EQ(hidden[1].ids, sets[1].ids);
  groups[0].motions[1].used = false;
  EXPECT_EQ(motionSets(groups).size(), 1U) << "a group of which nothing is used is no set";
}

TEST(MotionSets, ClipsOfAnotherSkeletonThanMostAreCountedAsLeftOut) {
  const ClipPtr plain = walkerClip(1);
  const auto sets = motionSets({groupOf(
      1, "Natural", -1, {reordered(*plain), plain, walkerClip(2), oneJointFewer(*plain)})});
  ASSERT_EQ(sets.size(), 1U);
  EXPECT_EQ(sets[0].ids, (std::vector<MotionId>{{1, 1}, {1, 2}}));
  EXPECT_EQ(countedText(sets), "Counted: Natural: 2 of 4 (2 of another skeleton)");
}

TEST(MotionSets, ARangeCutsClipsAndWantedPathsAlike) {
  auto groups = twoGroups();
  groups[1].wanted.resize(60);
  const auto sets = motionSets(groups);
  const ClipsInRange cut = clipsIn(sets[1], TimeRange{0.5, 1.5});
  ASSERT_EQ(cut.clips.size(), 2U);
  const int frames = static_cast<int>(std::lround(sets[1].clips[0]->fps)) + 1;
  EXPECT_EQ(cut.clips[0].frameCount(), frames);
  EXPECT_EQ(cut.clips[0].at(0, 0), sets[1].clips[0]->at(frames / 2, 0));
  EXPECT_EQ(cut.wanted[0].size(), static_cast<size_t>(frames));
  EXPECT_TRUE(clipsIn(sets[1], TimeRange{50.0, 60.0}).clips.empty());
}

TEST(Bands, AreQuantilesOfThoseWhoHaveAValue) {
  const Band band = bandOf({{1, 10, NAN}, {3, NAN, NAN}, {2, 20, NAN, 7}});
  EXPECT_EQ(band.step, (std::vector<double>{0, 1, 3}));
  EXPECT_EQ(band.median, (std::vector<double>{2, 15, 7}));
  EXPECT_NEAR(band.low[0], 1.1, 1e-12);
  EXPECT_NEAR(band.high[0], 2.9, 1e-12);
}

std::vector<MotionGroup> scoredGroups() {
  auto groups = twoGroups();
  groups[1].motions[0].score = ClipScore{.firstFrame = 2, .loglikNats = {5, 6, -40, 7}};
  groups[1].motions[1].score = ClipScore{.firstFrame = 2, .loglikNats = {5, 4, 3, 2}};
  return groups;
}

TEST(Likelihoods, WorstFrameIsThatOfASampleInsideTheRange) {
  const std::vector<ClipScore> natural{{.firstFrame = 1, .loglikNats = {-99}}, {}, {}};
  const auto groups = likelihoodGroups(
      scoredGroups(), {"MG"}, [&](const std::string&) { return &natural; }, 10.0);
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[0].runs.size(), 1U) << "clips that were too short to score";
  const auto worst = worstFrame(groups, std::nullopt, "MG");
  ASSERT_TRUE(worst);
  EXPECT_EQ(worst->id, (MotionId{2, 0}));
  EXPECT_DOUBLE_EQ(worst->timeS, 4.0 / groups[1].fps);
  const auto early = worstFrame(groups, TimeRange{0.0, 3.0 / groups[1].fps}, "MG");
  EXPECT_EQ(early->id, (MotionId{2, 1}));
}

TEST(Likelihoods, CurvesKnowTheirMotions) {
  const auto groups = likelihoodGroups(
      scoredGroups(), {"MG"}, [](const std::string&) { return nullptr; }, 20.0);
  const LinkedGrid median = likelihoodGrid(groups, {}, false),
                   every = likelihoodGrid(groups, {}, true);
  EXPECT_EQ(median.motions.at({0, 1, -1}), (std::vector<MotionId>{{2, 0}, {2, 1}}));
  EXPECT_EQ(median.grid.charts[0].series[1].y, (std::vector<double>{5, 5, -18.5, 4.5}));
  EXPECT_EQ(every.motions.at({0, 0, 1}), (std::vector<MotionId>{{2, 1}}));
  EXPECT_TRUE(std::isnan(every.grid.charts[0].series[0].cloud->y[0])) << "history is not scored";
  EXPECT_NO_THROW(render::framesOf(every.grid, {400, 300}));
}

TEST(Likelihoods, RunningMeanIsCentredAndShorterAtTheEnds) {
  EXPECT_EQ(runningMean({0, 3, 6, 9}, 3), (std::vector<double>{1.5, 3, 6, 7.5}));
  EXPECT_EQ(runningMean({1, 2}, 1), (std::vector<double>{1, 2}));
}

TEST(Footsteps, AllFeetAreTheCurveOfTheStatistics) {
  const auto sets = motionSets(twoGroups());
  const stats::FootstepOptions options{.feet = stats::feetOf(*sets[0].clips[0]->skeleton)};
  Progress progress;
  const auto results = footstepResults(sets, std::nullopt, {}, progress);
  const auto expected = stats::footstepCurve(clipsIn(sets[0], std::nullopt).clips, options);
  EXPECT_EQ(results[0].all.count, expected.count);
  EXPECT_DOUBLE_EQ(results[0].all.v95CmS, expected.v95CmS);
  EXPECT_DOUBLE_EQ(results[0].all.durationStdS, expected.durationStdS);
  EXPECT_TRUE(perMinute(results));
  EXPECT_EQ(footstepGrid(results).grid.charts[0].y.label, "footsteps per minute");
  const auto rows = footstepRows(results);
  ASSERT_EQ(rows.size(), 6U);
  EXPECT_NEAR(rows[0].stepsPerMinute, rows[0].steps / (3 * 4.0 / 60.0),
              0.05 * rows[0].stepsPerMinute);
}

TEST(Footsteps, APickedMotionHasItsOwnCurveOnTheScaleOfItsSet) {
  const auto sets = motionSets(twoGroups());
  Progress progress;
  const auto results = footstepResults(sets, std::nullopt, {}, progress);
  const auto curves = footstepHighlights(results, {{2, 1}});
  ASSERT_EQ(curves.size(), 2U) << "counts, and durations";
  const auto alone = stats::footstepCurve({*sets[1].clips[1]},
                                          {.feet = stats::feetOf(*sets[1].clips[1]->skeleton)});
  for (size_t k = 0; k < alone.count.size(); ++k)
    EXPECT_NEAR(curves[0].y[k],
                static_cast<double>(alone.count[k]) / (sets[1].clips[1]->seconds() / 60.0), 1e-6);
  EXPECT_EQ(curves[1].chart, 1);
  EXPECT_TRUE(footstepHighlights(results, {{2, 0}, {2, 1}}).empty())
      << "a whole set is its own curve";
}

TEST(Footsteps, FeetAreThoseOfEverySetsOwnSkeleton) {
  const ClipPtr plain = walkerClip(1);
  const ClipPtr other = reordered(*plain);
  const auto sets = motionSets({groupOf(1, "Natural", -1, {plain}), groupOf(2, "MG", 0, {other})});
  const std::string foot =
      plain->skeleton->names[static_cast<size_t>(stats::feetOf(*plain->skeleton).front())];
  Progress progress;
  const auto results = footstepResults(sets, std::nullopt, {.feet = foot}, progress);
  ASSERT_EQ(results.size(), 2U);
  EXPECT_EQ(results[0].all.count, results[1].all.count);
  EXPECT_EQ(results[1].footNames, (std::vector<std::string>{foot}));
}

TEST(Distributions, SkeletonsOfEqualSizeButOtherNamesAreNotCompared) {
  const ClipPtr plain = walkerClip(1);
  const auto sets =
      motionSets({groupOf(1, "Natural", -1, {plain}), groupOf(2, "MG", 0, {reordered(*plain)})});
  Progress progress;
  const auto result = distributionResult(sets, {.joints = {0}, .range = {}}, progress);
  ASSERT_EQ(result.sets.size(), 1U) << "the others go on";
  EXPECT_TRUE(result.sets[0].look.natural);
  ASSERT_EQ(result.leftOut.size(), 1U);
  EXPECT_NE(result.leftOut[0].find("MG: another skeleton"), std::string::npos) << result.leftOut[0];
  const auto mixed = motionSets({groupOf(1, "MG", 0, {plain, reordered(*plain)})});
  EXPECT_TRUE(diversityCurves(mixed, progress).empty()) << "a pair of two skeletons";
}

TEST(Statistics, AModelOfAnotherSkeletonHasItsOwnValuesAndTheOthersGoOn) {
  auto groups = twoGroups();
  const ClipPtr other = oneJointFewer(*walkerClip(7));
  groups.push_back(groupOf(3, "Dog", 1, {other, oneJointFewer(*walkerClip(8))}));
  StatisticsInput input{.sets = motionSets(groups), .range = {}};
  Progress progress;
  const StatisticsTable with = statisticsTable(input, progress);
  input.sets.pop_back();
  const StatisticsTable without = statisticsTable(input, progress);
  ASSERT_EQ(with.systems, (std::vector<std::string>{"MG", "Dog"}));
  ASSERT_EQ(with.notes.size(), 1U);
  EXPECT_TRUE(with.notes[0].starts_with("Dog: not compared with natural motion")) << with.notes[0];
  size_t own = 0;
  for (const StatisticsRow& row : with.rows) own += row.systems[1] ? 1 : 0;
  EXPECT_GT(own, 0U);
  for (const StatisticsRow& row : without.rows) {
    const auto same = std::find_if(with.rows.begin(), with.rows.end(),
                                   [&](const StatisticsRow& r) { return r.name == row.name; });
    ASSERT_NE(same, with.rows.end());
    EXPECT_EQ(same->systems[0]->value, row.systems[0]->value) << row.name;
    EXPECT_EQ(same->natural, row.natural) << row.name;
  }
}

TEST(Diversity, AStripSaysHowManyMotionsGoOn) {
  const auto sets = motionSets(
      {groupOf(1, "Natural", -1, {walkerClip(1, 4.0), walkerClip(2, 3.0), walkerClip(3, 2.0)})});
  Progress progress;
  const auto curves = diversityCurves(sets, progress);
  ASSERT_EQ(curves.size(), 1U);
  const auto frames = [&](size_t clip) {
    return static_cast<size_t>(sets[0].clips[clip]->frameCount());
  };
  EXPECT_EQ(curves[0].pairs.motions[frames(2) - 1], 3);
  EXPECT_EQ(curves[0].pairs.motions[frames(2)], 2);
  const LinkedGrid grid = diversityGrid(curves);
  ASSERT_EQ(grid.grid.charts.size(), 2U);
  const render::Series& steps = grid.grid.charts[1].series.front();
  EXPECT_EQ(steps.y.front(), 3.0);
  EXPECT_EQ(steps.y.back(), 2.0);
  EXPECT_NEAR(steps.x[1], static_cast<double>(frames(2)) / curves[0].fps, 1e-12);
  EXPECT_EQ(
      diversityGrid(diversityCurves(motionSets({twoGroups()[1]}), progress)).grid.charts.size(), 1U)
      << "all go on to the end: the number of the set says it";
}

TEST(Likelihoods, ModelsOfOtherSkeletonsHaveTheirOwnAxisAndWorstFrame) {
  auto groups = scoredGroups();
  groups.push_back(groupOf(3, "Dog", 1, {oneJointFewer(*walkerClip(7))}));
  groups[2].motions[0].score = ClipScore{.firstFrame = 2, .loglikNats = {-900, -901}};
  const auto scored = likelihoodGroups(
      groups, {"MG", "Dog"}, [](const std::string&) { return nullptr; }, 20.0);
  EXPECT_EQ(systemsIn(scored), (std::vector<std::string>{"MG", "Dog"}));
  EXPECT_EQ(worstFrame(scored, std::nullopt, "MG")->id, (MotionId{2, 0}));
  EXPECT_EQ(worstFrame(scored, std::nullopt, "Dog")->id, (MotionId{3, 0}));
  const auto rule = [](const char* system, double nats) {
    LikelihoodRow row{
        .name = "natural", .system = system, .natural = true, .summary = {}, .floor = {}};
    row.summary.linearGaussian = nats;
    return row;
  };
  const LinkedGrid grid = likelihoodGrid(scored, {rule("MG", 1.5), rule("Dog", -950.0)}, false);
  ASSERT_GE(grid.grid.charts.size(), 2U);
  for (const double nats : grid.grid.charts[0].series.back().y) EXPECT_GT(nats, -100.0);
  const auto frames = render::framesOf(grid.grid, {600, 500});
  EXPECT_GT(frames[0].yLow, -100.0) << "the other model's scale is in this one's axis";
  EXPECT_LT(frames[1].yHigh, -800.0);
  EXPECT_EQ(likelihoodHighlights(scored, {{2, 1}}).front().chart, 0);
}

TEST(Likelihoods, ModelsOfOtherUnitsHaveTheirOwnAxisWithTheUnit) {
  auto groups = scoredGroups();
  groups.push_back(groupOf(3, "Turns", 1, {walkerClip(7)}));
  for (Motion& motion : groups[1].motions)
    if (motion.score) motion.score->unit = "nats per frame, cm";
  groups[2].motions[0].score =
      ClipScore{.firstFrame = 2, .unit = "nats per frame, cm and rad", .loglikNats = {900, 901}};
  const auto scored = likelihoodGroups(
      groups, {"MG", "Turns"}, [](const std::string&) { return nullptr; }, 20.0);
  LinkedGrid grid = likelihoodGrid(scored, {}, false);
  ASSERT_GE(grid.grid.charts.size(), 2U);
  EXPECT_EQ(grid.grid.charts[0].y.unit, "nats per frame, cm");
  EXPECT_EQ(grid.grid.charts[1].y.unit, "nats per frame, cm and rad");
  markWorst(grid, scored, *worstFrame(scored, std::nullopt, "Turns"));
  EXPECT_EQ(grid.grid.charts[1].series.back().name, "worst frame, 900 nats, cm and rad");
}

TEST(Diversity, APickedMotionShowsItsDistanceFromTheOthers) {
  const auto sets = motionSets(twoGroups());
  Progress progress;
  const auto curves = diversityCurves(sets, progress);
  const auto picked = diversityHighlights(curves, {{2, 0}});
  ASSERT_EQ(picked.size(), 1U);
  // Of a set of two, every distance is that of the one pair.
  ASSERT_LE(curves[1].pairs.pairs.size(), picked[0].y.size());
  for (size_t t = 0; t < curves[1].pairs.pairs.size(); ++t)
    EXPECT_NEAR(picked[0].y[t], 100.0 * curves[1].pairs.meanM(t), 1e-3);
}

TEST(Distributions, APickedMotionHasItsDensityAndItsValuesOverTime) {
  const auto sets = motionSets(twoGroups());
  Progress progress;
  const auto result = distributionResult(
      sets, {.quantity = stats::Quantity::Height, .joints = {3}, .range = {}}, progress);
  const auto in = [&](DistributionView view) {
    return distributionHighlights(result, view, distributionGrid(result, view).grid, {{1, 1}});
  };
  const auto time = in(DistributionView::Envelope);
  ASSERT_EQ(time.size(), 1U);
  EXPECT_EQ(time[0].y, result.sets[0].values[0].byMotion[1]);
  const auto density = in(DistributionView::Density);
  ASSERT_EQ(density.size(), 1U);
  EXPECT_GT(*std::max_element(density[0].y.begin(), density[0].y.end()), 0.0);
  const auto violin = in(DistributionView::Violin);
  ASSERT_EQ(violin.size(), 1U);
  for (const double y : violin[0].y) EXPECT_TRUE(y > 0.0 && y <= 0.5) << "in the first row";
}

TEST(Likelihoods, TheWorstFrameIsALineThatStandsForItsMotion) {
  const auto groups = likelihoodGroups(
      scoredGroups(), {"MG"}, [](const std::string&) { return nullptr; }, 20.0);
  LinkedGrid grid = likelihoodGrid(groups, {}, false);
  markWorst(grid, groups, *worstFrame(groups, std::nullopt, "MG"));
  const int last = static_cast<int>(grid.grid.charts[0].series.size()) - 1;
  EXPECT_EQ(grid.motions.at({0, last, -1}), (std::vector<MotionId>{{2, 0}}));
  const auto picked = likelihoodHighlights(groups, {{2, 1}});
  ASSERT_EQ(picked.size(), 1U);
  EXPECT_EQ(picked[0].y, (std::vector<double>{5, 4, 3, 2}));
}

/// One who stands still, with a hand raised by 1 mm more in every frame, times `way`.
ClipPtr raising(double way) {
  Clip out =
      walk(presetPath("still", 2.0, 20.0), {.seed = 3, .fps = 20.0, .noise = 0.0}).clip;
  const int hand = out.skeleton->find("LeftHandIndex");
  for (int t = 0; t < out.frameCount(); ++t)
    out.positions[static_cast<size_t>(t * out.jointCount() + hand)].y() +=
        static_cast<float>(0.001 * way * t);
  return std::make_shared<const Clip>(std::move(out));
}

// Three motions that differ in the height of one joint of 21 alone: at frame t two pairs are
// t / sqrt(21) mm apart and one twice as far.
TEST(Diversity, MeanOverTimeIsTheStatistic) {
  const auto sets = motionSets({groupOf(1, "MG", 0, {raising(0.0), raising(1.0), raising(2.0)})});
  Progress progress;
  const auto curves = diversityCurves(sets, progress);
  ASSERT_EQ(curves.size(), 1U);
  const int frames = sets[0].clips[0]->frameCount();
  const double meanCm = 0.1 * 0.5 * (frames - 1) * (4.0 / 3.0) / std::sqrt(21.0);
  // Heights below 2 m are known to 2^-23 m.
  const double known = 100.0 * std::pow(2.0, -23);
  EXPECT_NEAR(meanInRange(curves[0], std::nullopt), meanCm, known);
  const std::vector<Clip> clips = clipsIn(sets[0], std::nullopt).clips;
  EXPECT_NEAR(stats::valueOf(stats::statisticByName("diversity"),
                             {.clips = &clips, .controls = std::vector<int>(clips.size(), 0)}),
              meanCm, known);
}

TEST(Diversity, OfDifferentControlsIsCalledSo) {
  const auto sets = motionSets(twoGroups());
  Progress progress;
  const auto curves = diversityCurves(sets, progress);
  ASSERT_EQ(curves.size(), 2U);
  EXPECT_EQ(curves[1].pairs.motions.front(), 2);
  EXPECT_TRUE(curves[0].look.name.ends_with("(different controls)")) << curves[0].look.name;
  EXPECT_FALSE(curves[1].look.name.ends_with("(different controls)")) << curves[1].look.name;
}

TEST(Distributions, DistanceOfASetToItselfIsZeroAndElsewhereThatOfTheStatistics) {
  auto groups = twoGroups();
  groups.push_back(
      groupOf(3, "Copy", 1,
              {groups[0].motions[0].clip, groups[0].motions[1].clip, groups[0].motions[2].clip}));
  const auto sets = motionSets(groups);
  Progress progress;
  const auto result = distributionResult(
      sets, {.quantity = stats::Quantity::Height, .joints = {0, 3}, .range = {}}, progress);
  ASSERT_EQ(result.sets.size(), 3U);
  EXPECT_TRUE(result.sets[0].distance.empty());
  EXPECT_NEAR(result.sets[2].distance[3], 0.0, 1e-12);
  EXPECT_NEAR(result.sets[1].distance[3],
              stats::wasserstein1(result.sets[1].values[1].pooled, result.sets[0].values[1].pooled),
              1e-9);
  EXPECT_EQ(distributionRows(result).size(), 6U);
  for (const auto view :
       {DistributionView::Density, DistributionView::Violin, DistributionView::Envelope}) {
    const LinkedGrid grid = distributionGrid(result, view);
    EXPECT_EQ(grid.grid.charts.size(), 2U);
    EXPECT_NO_THROW(render::drawImage(grid.grid, {600, 300}));
  }
}

TEST(Statistics, TableHasSystemsBesideNaturalMotionAndKnowsItsInput) {
  const auto groups = twoGroups();
  StatisticsInput input{.sets = motionSets(groups), .range = {}};
  Progress progress;
  const StatisticsTable table = statisticsTable(input, progress);
  EXPECT_EQ(table.systems, (std::vector<std::string>{"MG"}));
  EXPECT_GT(table.rows.size(), 5U);
  EXPECT_TRUE(table.rows[0].systems[0] && table.rows[0].natural);
  EXPECT_EQ(input.text(), "Natural (3 of 3 motions), MG (2 of 2 motions)");
  StatisticsInput later = input;
  EXPECT_TRUE(table.input.sameAs(later));
  later.range = TimeRange{0.0, 1.0};
  EXPECT_FALSE(table.input.sameAs(later));
  const std::string text = statisticsText(table, '\t');
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), static_cast<long>(table.rows.size()) + 1);
  input.sets.pop_back();
  const StatisticsTable alone = statisticsTable(input, progress);
  EXPECT_TRUE(alone.systems.empty());
  EXPECT_TRUE(alone.rows[0].natural);
}

}  // namespace
}  // namespace marey::gui
