#include "stats/statistic_parts.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "base/packing.h"
#include "motion/walker.h"
#include "stats/bones.h"
#include "stats/footsteps.h"
#include "stats/skate.h"
#include "stats/statistic.h"

namespace marey::stats {
namespace {

std::vector<float> heights(size_t count) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal(0.1f, 0.05f);
  std::vector<float> out(count);
  for (float& height : out) height = normal(random);
  return out;
}

TEST(CountedHeights, AreExactUpToAMillionAndWithinHalfAStepBeyond) {
  for (const size_t count : {size_t{1001}, HeightCounts::kExact, HeightCounts::kExact + 1001}) {
    std::vector<float> values = heights(count);
    HeightCounts counts;
    for (const float height : values) counts.add(height);
    std::sort(values.begin(), values.end());
    for (const double share : {0.05, 0.5, 1.0}) {
      const double position = share * static_cast<double>(count - 1);
      const auto k = static_cast<size_t>(position);
      const double next = values[std::min(k + 1, count - 1)];
      const double exact = values[k] + (position - static_cast<double>(k)) * (next - values[k]);
      const double error = count > HeightCounts::kExact ? 0.5 * HeightCounts::kResolutionM : 0.0;
      EXPECT_NEAR(counts.quantile(share), exact, error + 1e-9) << count << " " << share;
    }
  }
}

TEST(CountedHeights, AreTheSameHoweverTheyAreDealtOutAndSent) {
  const std::vector<float> values = heights(HeightCounts::kExact + 999);
  HeightCounts whole;
  for (const float height : values) whole.add(height);
  for (const size_t shares : {2u, 7u}) {
    HeightCounts sum;
    for (size_t s = shares; s-- > 0;) {
      HeightCounts share;
      for (size_t i = s; i < values.size(); i += shares) share.add(values[i]);
      Packer packer;
      share.pack(packer);
      const std::string bytes = packer.take();
      Unpacker rest(bytes);
      sum.add(HeightCounts::unpacked(rest));
    }
    for (const double share : {0.0, 0.05, 0.3, 1.0})
      EXPECT_EQ(sum.quantile(share), whole.quantile(share));
  }
}

TEST(Facts, AreThoseOfTheClipsInMemory) {
  std::vector<Clip> clips;
  for (WalkerClip& w : walkerDataSet(3, 2.0, 5, 20.0)) clips.push_back(std::move(w.clip));
  const auto feet = feetOf(*clips.front().skeleton);
  SetFacts facts;
  for (const Clip& clip : clips) {
    Packer packer;
    factsOf(clip, feet).pack(packer);
    const std::string bytes = packer.take();
    Unpacker rest(bytes);
    facts.add(SetFacts::unpacked(rest));
  }
  EXPECT_EQ(facts.clips, 3u);
  EXPECT_EQ(facts.frames, 120.0);
  EXPECT_TRUE(facts.moves);
  EXPECT_EQ(facts.meanBoneLengths(), meanBoneLengths(clips));
  EXPECT_EQ(facts.standingHeights(), standingHeights(clips, feet));
}

TEST(Rules, AreFollowedOnceForStatisticsThatShareThem) {
  const auto rules = rulesOf(allStatistics());
  EXPECT_LT(rules.size(), allStatistics().size());
  EXPECT_EQ(std::count(rules.begin(), rules.end(), footstepRule()), 1);
  std::vector<Clip> clips;
  for (WalkerClip& w : walkerDataSet(2, 2.0, 5, 20.0)) clips.push_back(std::move(w.clip));
  const StatisticInput input{.clips = &clips, .controls = {0, 0}};
  for (const Statistic& s : allStatistics())
    EXPECT_EQ(appliesTo(s, input),
              s.name == "jerk" || s.name == "diversity" || s.name == "bone_length_rmse")
        << s.name;
}

}  // namespace
}  // namespace marey::stats
