#include "model/data_set.h"

#include <cmath>

#include "tiny_run.h"
#include <gtest/gtest.h>

#include "base/error.h"

namespace marey {
namespace {

FeatureSequence ofLength(int frames) {
  return {.name = "s", .pose = Matrix::Zero(frames, 3), .control = Matrix::Zero(frames, 3)};
}

std::vector<std::array<int, 3>> windows(const std::vector<FeatureSequence>& sequences, int window,
                                        int hop) {
  std::vector<std::array<int, 3>> out;
  for (const Window& w : cutWindows(sequences, window, hop))
    out.push_back({w.sequence, w.first, w.length});
  return out;
}

using Windows = std::vector<std::array<int, 3>>;

TEST(Windows, HopsThatReachTheEndLeaveNoTail) {
  EXPECT_EQ(windows({ofLength(8)}, 4, 2), (Windows{{0, 0, 4}, {0, 2, 4}, {0, 4, 4}}));
  EXPECT_EQ(windows({ofLength(4)}, 4, 2), (Windows{{0, 0, 4}}));
}

TEST(Windows, ATailGetsAWindowThatEndsWithTheSequence) {
  EXPECT_EQ(windows({ofLength(9)}, 4, 2), (Windows{{0, 0, 4}, {0, 2, 4}, {0, 4, 4}, {0, 5, 4}}));
  EXPECT_EQ(windows({ofLength(5)}, 4, 4), (Windows{{0, 0, 4}, {0, 1, 4}}));
}

TEST(Windows, AShortSequenceGivesOneShortWindow) {
  EXPECT_EQ(windows({ofLength(8), ofLength(3)}, 8, 4), (Windows{{0, 0, 8}, {1, 0, 3}}));
}

TEST(Windows, HopsLongerThanAWindowStillEndWithTheSequence) {
  EXPECT_EQ(windows({ofLength(10)}, 3, 6), (Windows{{0, 0, 3}, {0, 6, 3}, {0, 7, 3}}));
}

TEST(DataSet, MirroredAndReversedClipsAreAppendedToTheTrainingDataAlone) {
  const DataSet& data = test::tinyData();
  ASSERT_EQ(data.train.size(), 12u);
  ASSERT_EQ(data.test.size(), 1u);
  const std::string name = data.train[0].name;
  EXPECT_EQ(data.train[3].name, name + "|mirror");
  EXPECT_EQ(data.train[6].name, name + "|reverse");
  EXPECT_EQ(data.train[9].name, name + "|mirror|reverse");
}

TEST(DataSet, TheStandardiserHoldsMeanAndPopulationDeviationOfAllTrainingFrames) {
  const DataSet& data = test::tinyData();
  for (const long column : {1L, 30L, 62L}) {
    // Two passes over the values, one by one.
    double sum = 0.0, squares = 0.0, n = 0.0;
    for (const auto& s : data.train)
      for (long t = 0; t < s.pose.rows(); ++t, ++n) sum += static_cast<double>(s.pose(t, column));
    for (const auto& s : data.train)
      for (long t = 0; t < s.pose.rows(); ++t)
        squares += std::pow(static_cast<double>(s.pose(t, column)) - sum / n, 2);
    const auto i = static_cast<size_t>(column);
    EXPECT_NEAR(data.standardiser.poseMean[i], sum / n, 1e-6);
    EXPECT_NEAR(data.standardiser.poseStd[i], std::sqrt(squares / n), 1e-6);
  }
  // Every motion appears with its mirror image: sideways motion and turning cancel.
  EXPECT_NEAR(data.standardiser.controlMean[0], 0.0, 1e-6);
  EXPECT_NEAR(data.standardiser.controlMean[2], 0.0, 1e-6);
}

TEST(DataSet, AConstantColumnIsStandardisedByOne) {
  // A body that stands like a statue: every column is constant.
  Clip clip = test::walkerClips(1, 1.0, 1).front();
  for (int t = 1; t < clip.frameCount(); ++t)
    std::copy(clip.frame(0).begin(), clip.frame(0).end(), clip.frame(t).begin());
  clip.transforms.reset();
  Progress progress;
  const auto data = prepareDataSet({clip}, {}, {.mirror = false, .reverse = false}, progress);
  for (const float s : data.standardiser.poseStd) EXPECT_EQ(s, 1.f);
  for (const float s : data.standardiser.controlStd) EXPECT_EQ(s, 1.f);
  EXPECT_EQ(data.standardiser.logDetPerFrame(), 0.0);
}

TEST(DataSet, BoneLengthsAreThoseOfTheWalker) {
  const auto truth = walkerDataSet(1, 1.0, 2, 20.0).front().truth.boneLengthsM;
  const auto& found = test::tinyData().boneLengthsM;
  ASSERT_EQ(found.size(), truth.size());
  for (size_t b = 0; b < truth.size(); ++b) EXPECT_NEAR(found[b], truth[b], 1e-4);
}

TEST(DataSet, AWrittenDataSetReadsBackTheSame) {
  const test::TempFolder folder;
  const DataSet& data = test::tinyData();
  writeDataSet(folder / "data.marey", data);
  const DataSet back = readDataSet(folder / "data.marey");
  ASSERT_EQ(back.train.size(), data.train.size());
  for (size_t i = 0; i < data.train.size(); ++i) {
    EXPECT_EQ(back.train[i].name, data.train[i].name);
    EXPECT_EQ(back.train[i].pose, data.train[i].pose);
    EXPECT_EQ(back.train[i].control, data.train[i].control);
    EXPECT_EQ(back.train[i].start.heading, data.train[i].start.heading);
  }
  ASSERT_EQ(back.test.size(), 1u);
  EXPECT_EQ(back.test[0].pose, data.test[0].pose);
  EXPECT_EQ(back.standardiser.poseStd, data.standardiser.poseStd);
  EXPECT_EQ(back.boneLengthsM, data.boneLengthsM);
  EXPECT_EQ(*back.skeleton, *data.skeleton);
  EXPECT_EQ(back.options.features, data.options.features);
  EXPECT_FALSE(back.hash.empty());
}

TEST(DataSet, ADataSetWithoutTestClipsReadsBack) {
  const test::TempFolder folder;
  DataSet data = test::tinyData();
  data.test.clear();
  writeDataSet(folder / "data.marey", data);
  EXPECT_TRUE(readDataSet(folder / "data.marey").test.empty());
}

TEST(DataSet, AModelIsNoDataSet) {
  const test::TempFolder folder;
  writeTensorFile(folder / "m.marey", test::tinyFile());
  EXPECT_THROW(readDataSet(folder / "m.marey"), InputError);
}

TEST(DataSet, NonFiniteFramesAreRefusedWhenRead) {
  const test::TempFolder folder;
  DataSet data = test::tinyData();
  data.train[1].pose(3, 4) = NAN;
  writeDataSet(folder / "data.marey", data);
  const auto message = test::messageOf<InputError>([&] { readDataSet(folder / "data.marey"); });
  EXPECT_NE(message.find(data.train[1].name), std::string::npos) << message;
}

TEST(DataSet, ClipsOfDifferentSkeletonsAreRefused) {
  auto clips = test::walkerClips(2, 1.0, 1);
  auto other = std::make_shared<Skeleton>(*clips[1].skeleton);
  other->names[5] = "tail";
  clips[1].skeleton = other;
  Progress progress;
  EXPECT_THROW(prepareDataSet(clips, {}, {}, progress), InputError);
  EXPECT_THROW(prepareDataSet({}, {}, {}, progress), InputError);
}

}  // namespace
}  // namespace marey
