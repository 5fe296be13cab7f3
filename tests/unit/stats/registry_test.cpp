#include <cmath>
#include <numeric>
#include <set>

#include "unit/stats/small_clips.h"
#include <gtest/gtest.h>

#include "base/error.h"
#include "motion/path.h"
#include "motion/walker.h"
#include "stats/bones.h"
#include "stats/footsteps.h"
#include "stats/statistic.h"
#include "stats/weighted.h"

namespace marey::stats {
namespace {

std::vector<Clip> walkerClips(int count, uint64_t seed) {
  std::vector<Clip> out;
  for (WalkerClip& w : walkerDataSet(count, 4.0, seed, 20.0)) out.push_back(std::move(w.clip));
  return out;
}

const std::vector<Clip>& samples() {
  static const std::vector<Clip> clips = walkerClips(14, 5);
  return clips;
}
const std::vector<Clip>& natural() {
  static const std::vector<Clip> clips = walkerClips(14, 6);
  return clips;
}

StatisticInput inputOf(const std::vector<Clip>& clips, const std::vector<Clip>* against = nullptr) {
  StatisticInput input{.clips = &clips, .natural = against};
  input.feet = feetOf(*clips.front().skeleton);
  return input;
}

const StatisticResult& find(const std::vector<StatisticResult>& results, const std::string& name) {
  for (const StatisticResult& r : results)
    if (r.name == name) return r;
  throw std::runtime_error("no result " + name);
}

TEST(Registry, EveryStatisticHasAUniqueNameADefinitionAndASource) {
  std::set<std::string> names;
  for (const Statistic& s : allStatistics()) {
    EXPECT_TRUE(names.insert(s.name).second) << s.name;
    EXPECT_GT(s.definition.size(), 20u) << s.name;
    EXPECT_TRUE(s.definition.ends_with(".")) << s.name;
    EXPECT_FALSE(s.source.empty()) << s.name;
    EXPECT_EQ(s.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_"), std::string::npos);
  }
  EXPECT_THROW(statisticByName("beauty"), UsageError);
}

TEST(Registry, EveryStatisticHasAFiniteValueOnWalkers) {
  std::vector<std::vector<RootFrame>> wanted;
  for (const Clip& clip : samples()) wanted.emplace_back(static_cast<size_t>(clip.frameCount()));
  StatisticInput input = inputOf(samples(), &natural());
  input.wanted = &wanted;
  input.controls.assign(samples().size(), 0);
  for (const Statistic& s : allStatistics()) {
    ASSERT_TRUE(appliesTo(s, input)) << s.name;
    EXPECT_TRUE(std::isfinite(valueOf(s, input))) << s.name;
  }
}

TEST(Registry, StatisticsWithoutWhatTheyNeedDoNotApply) {
  const std::vector<Clip> one = {pointClip({Vec3(0, 0, 0), Vec3(1, 0, 0)}, 20.0)};
  const StatisticInput input{.clips = &one};
  std::vector<std::string> names;
  for (const StatisticResult& r : evaluate(allStatistics(), input)) names.push_back(r.name);
  EXPECT_EQ(names, std::vector<std::string>{"jerk"});
  EXPECT_THROW(valueOf(statisticByName("footstep_v95"), input), InputError);
}

TEST(Registry, ValuesAreThoseOfTheFunctionsBehindThem) {
  const StatisticInput input = inputOf(samples(), &natural());
  const auto curve = footstepCurve(samples(), {.feet = input.feet});
  EXPECT_EQ(valueOf(statisticByName("footstep_v95"), input), curve.v95CmS);
  EXPECT_EQ(valueOf(statisticByName("footstep_duration"), input), curve.durationMeanS);
  EXPECT_EQ(valueOf(statisticByName("footstep_rate"), input), curve.stepsPerS);
  EXPECT_NEAR(valueOf(statisticByName("bone_length_rmse"), input),
              boneLengthRmseCm(samples(), meanBoneLengths(natural())), 1e-9);
}

TEST(Registry, AWeightOfTwoEqualsTheClipTwice) {
  const std::vector<Clip> clips(samples().begin(), samples().begin() + 4);
  std::vector<Clip> repeated = clips;
  repeated.push_back(clips[1]);
  const StatisticInput input = inputOf(clips, &natural());
  const StatisticInput doubled = inputOf(repeated, &natural());
  for (const Statistic& s : allStatistics()) {
    // Diversity needs motions along one control, path error wanted paths.
    if (!appliesTo(s, input)) continue;
    EXPECT_NEAR(prepared(s, input)({{1, 2, 1, 1}}), valueOf(s, doubled),
                1e-9 * std::max(1.0, std::abs(valueOf(s, doubled))))
        << s.name;
  }
}

TEST(Registry, MotionComparedWithItselfHasNoDistance) {
  const StatisticInput input = inputOf(samples(), &samples());
  for (const Statistic& s : allStatistics()) {
    if (!s.comparison) continue;
    EXPECT_NEAR(valueOf(s, input), 0.0, 1e-9) << s.name;
  }
}

TEST(Registry, AFasterWalkIsFartherFromNaturalThanTheNoiseFloor) {
  std::vector<Clip> slow, fast;
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    slow.push_back(walk(presetPath("slow", 4.0, 20.0), {.seed = seed, .fps = 20.0}).clip);
    fast.push_back(walk(presetPath("fast", 4.0, 20.0), {.seed = seed, .fps = 20.0}).clip);
  }
  const auto results = evaluate(allStatistics(), inputOf(fast, &slow));
  const StatisticResult& speed = find(results, "joint_speed_wasserstein");
  // The roots differ by 120 cm/s.
  EXPECT_GT(speed.value, 100.0);
  EXPECT_LT(*speed.noiseFloor, 20.0);
  EXPECT_EQ(speed.natural, speed.noiseFloor);
}

/// One number per clip.
Statistic meanOfX() {
  return {"mean",
          "",
          "The mean of x.",
          "test",
          false,
          [](const StatisticSetting&) { return true; },
          ratioRule([](const Clip& clip, size_t, const StatisticSetting&) {
            return RatioPart{clip.at(0, 0).x(), 1.0};
          }),
          combineRatio()};
}

TEST(Bootstrap, WeightsAddUpToTheNumberOfClipsAndDependOnTheSeed) {
  const auto weights = resampleWeights(50, 3, 0);
  EXPECT_EQ(std::accumulate(weights.begin(), weights.end(), 0), 50);
  EXPECT_EQ(weights, resampleWeights(50, 3, 0));
  EXPECT_NE(weights, resampleWeights(50, 3, 1));
  EXPECT_NE(weights, resampleWeights(50, 4, 0));
}

TEST(Bootstrap, TheIntervalOfAMeanIsThatOfTheNormalApproximation) {
  // A statistic that is the mean of one number per clip: 0 for even clips, 1 for odd ones. Its
  // standard error is 0.5 / sqrt(100), so that 95 % lie within 0.5 +- 0.098.
  std::vector<Clip> clips;
  for (int i = 0; i < 100; ++i)
    clips.push_back(pointClip({Vec3(static_cast<float>(i % 2), 0, 0)}, 20.0));
  const Statistic mean = meanOfX();
  const StatisticInput input{.clips = &clips, .natural = &clips};
  const StatisticResult r = evaluate({mean}, input, {.resamples = 2000, .splits = 2000}).front();
  EXPECT_NEAR(r.value, 0.5, 1e-12);
  EXPECT_NEAR(*r.low, 0.402, 0.02);
  EXPECT_NEAR(*r.high, 0.598, 0.02);
  // Two sets of 100 with replacement: the difference of their means has the standard deviation
  // 0.5 sqrt(2 / 100), and a normal value's mean absolute value is sqrt(2 / pi) of that.
  EXPECT_NEAR(*r.noiseFloor, 0.0564, 0.004);
}

TEST(Bootstrap, SamplesAlongOneControlAreOneCluster) {
  // Twenty controls with x = 0 or 1, five equal samples along each: as uncertain as twenty clips,
  // not as a hundred.
  std::vector<Clip> clips;
  StatisticInput input{.clips = &clips};
  for (int i = 0; i < 100; ++i) {
    clips.push_back(pointClip({Vec3(static_cast<float>(i / 5 % 2), 0, 0)}, 20.0));
    input.controls.push_back(i / 5);
  }
  const Statistic mean = meanOfX();
  const StatisticResult r = evaluate({mean}, input, {.resamples = 4000}).front();
  EXPECT_EQ(r.controls, 20U);
  EXPECT_EQ(r.clips, 100U);
  // The 2.5 and 97.5 percentiles of a binomial of 20 and 0.5 are 6 and 14; with 100 clusters they
  // would be 0.4 and 0.6. One step is 0.05.
  EXPECT_NEAR(*r.low, 0.3, 0.051);
  EXPECT_NEAR(*r.high, 0.7, 0.051);
}

TEST(Bootstrap, MoreSamplesAlongAControlDoNotWeighMore) {
  // x = 1 once along one control, x = 0 three times along the other: the mean over controls.
  std::vector<Clip> clips = {pointClip({Vec3(1, 0, 0)}, 20.0)};
  for (int i = 0; i < 3; ++i) clips.push_back(pointClip({Vec3(0, 0, 0)}, 20.0));
  EXPECT_NEAR(valueOf(meanOfX(), {.clips = &clips, .controls = {4, 9, 9, 9}}), 0.5, 1e-12);
}

TEST(Bootstrap, OneControlHasNoInterval) {
  StatisticInput input = inputOf(samples());
  input.controls.assign(samples().size(), 3);
  for (const StatisticResult& r : evaluate(allStatistics(), input)) {
    EXPECT_FALSE(r.low.has_value()) << r.name;
    EXPECT_TRUE(std::isfinite(r.value)) << r.name;
  }
}

TEST(Evaluation, ClipsThatAddNothingAreCountedBesideTheNumber) {
  std::vector<Clip> clips = {stepClip({0, 0, 0, 0.1f, 0}, 20.0), stepClip({0.1f}, 20.0)};
  const StatisticResult r = find(evaluate(allStatistics(), {.clips = &clips}), "jerk");
  EXPECT_EQ(r.clips, 1U);
  EXPECT_EQ(r.leftOut, 1U);
}

TEST(Evaluation, DiversityIsAlongTheSameControlOnly) {
  // Two walks along one control that differ by 0.3 m of height, and one far from both along
  // another.
  const Clip clip = walk(presetPath("slow", 3.0, 20.0), {.fps = 20.0}).clip;
  std::vector<Clip> clips = {clip, clip, clip};
  for (Vec3& p : clips[1].positions) p.y() += 0.3f;
  for (Vec3& p : clips[2].positions) p.y() += 5.0f;
  StatisticInput input{.clips = &clips, .controls = {0, 0, 1}};
  const Statistic& diversity = statisticByName("diversity");
  EXPECT_NEAR(valueOf(diversity, input), 30.0, 0.01);
  input.controls = {};
  EXPECT_FALSE(appliesTo(diversity, input));
}

TEST(Bootstrap, OneClipHasNoInterval) {
  const std::vector<Clip> one = {samples().front()};
  const auto results = evaluate(allStatistics(), inputOf(one));
  const StatisticResult& jerk = find(results, "jerk");
  EXPECT_FALSE(jerk.low.has_value());
  EXPECT_FALSE(jerk.noiseFloor.has_value());
}

TEST(Bootstrap, TheSameSeedGivesTheSameNumbers) {
  const StatisticInput input = inputOf(samples());
  const EvaluationOptions options{.resamples = 50, .seed = 9};
  const auto first = evaluate(allStatistics(), input, options);
  const auto second = evaluate(allStatistics(), input, options);
  ASSERT_EQ(first.size(), second.size());
  for (size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].low, second[i].low) << first[i].name;
    EXPECT_EQ(first[i].high, second[i].high) << first[i].name;
  }
}

TEST(Evaluation, MixedRatesJointsAndNoClipsAreRefused) {
  const std::vector<Clip> none;
  EXPECT_THROW(evaluate(allStatistics(), {.clips = &none}), InputError);
  std::vector<Clip> rates = {stepClip({0.1f}, 20.0), stepClip({0.1f}, 30.0)};
  EXPECT_THROW(evaluate(allStatistics(), {.clips = &rates}), InputError);
  const std::vector<Clip> point = {stepClip({0.1f}, 20.0)};
  EXPECT_THROW(evaluate(allStatistics(), inputOf(samples(), &point)), InputError);
}

TEST(Evaluation, StopsWhenAsked) {
  std::stop_source source;
  source.request_stop();
  Progress progress([](double, std::string_view) {}, source.get_token());
  EXPECT_THROW(evaluate(allStatistics(), inputOf(samples()), {}, progress), CancelledError);
}

}  // namespace
}  // namespace marey::stats
