// Labels and signals beside a clip.
#include "io/annotation_files.h"

#include "../base/support.h"
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/npy.h"
#include "io/clip_io.h"
#include "io/inputs.h"
#include "motion/walker.h"

namespace marey::io {
namespace {

class AnnotationFiles : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    writeFileAtomically(m_folder / name, text);
    return m_folder / name;
  }
  std::filesystem::path clip() const {
    const auto path = m_folder / "walk.bvh";
    std::vector<RootFrame> way;
    for (int t = 0; t < 40; ++t) way.push_back({0.0, 0.05 * t, 0.0});
    writeClip(walk(way, {.fps = 20.0}).clip, path);
    return path;
  }
  template <typename Call>
  static std::string refusal(Call call) {
    try {
      call();
    } catch (const InputError& e) {
      return e.what();
    }
    return {};
  }

  test::TempFolder m_folder;
};

TEST_F(AnnotationFiles, LabelsAreReadWithTheirClip) {
  const auto path = clip();
  write("walk.labels.csv", "from;to;label\n0;0.5;stand\n0.8;2;walk\n");
  EXPECT_EQ(readClip(path).annotations.labels,
            (std::vector<LabelSpan>{{0.0, 0.5, "stand"}, {0.8, 2.0, "walk"}}));
  write("walk.labels.csv", "time_s,label\n0,stand\n0.5,\n0.8,walk\n");
  EXPECT_EQ(readClip(path).annotations.labels,
            (std::vector<LabelSpan>{{0.0, 0.5, "stand"}, {.fromS = 0.8, .label = "walk"}}));
  EXPECT_TRUE(readClip(path).annotations.signals.empty());
}

TEST_F(AnnotationFiles, WrongLabelsAreNamedWithTheirLine) {
  const auto at = [&](const std::string& text) {
    return refusal([&] { readLabels(write("a.labels.csv", text)); });
  };
  EXPECT_NE(at("from,to,label\n0,1,a\n0.5,2,b\n").find(".csv:3"), std::string::npos);
  EXPECT_NE(at("from,to,label\n1,0,a\n").find("an end after 1"), std::string::npos);
  EXPECT_NE(at("from,to,label\n,1,a\n").find("a time in seconds"), std::string::npos);
  EXPECT_NE(at("begin,label\n0,a\n").find("from,to,label"), std::string::npos);
}

TEST_F(AnnotationFiles, ARateComesFromTimesElseFromTheClip) {
  const Signal timed =
      readSignal(write("a.csv", "time,pitch,loud\n1,3,4\n1.02,5,6\n1.04,7,8\n"), 0);
  EXPECT_NEAR(timed.fps, 50.0, 1e-9);
  EXPECT_EQ(timed.startS, 1.0);
  EXPECT_EQ(timed.columns, (std::vector<std::string>{"pitch", "loud"}));
  EXPECT_EQ(timed.values, (std::vector<float>{3, 4, 5, 6, 7, 8}));
  const auto bare = write("b.csv", "1\n2\n3\n");
  EXPECT_EQ(readSignal(bare, 25.0).fps, 25.0);
  EXPECT_NE(refusal([&] { readSignal(bare, 0.0); }).find("3 rows without a rate"),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              readSignal(write("c.csv", "time,x\n0,1\n0.1,2\n0.5,3\n"), 0.0);
            }).find(".csv:3"),
            std::string::npos);
}

TEST_F(AnnotationFiles, SignalsOfALayoutAreFoundBesideTheClip) {
  const auto path = clip();
  const std::vector<float> values(40, 0.5F);
  write("walk.speech.npy", serialiseNpy(Tensor::fromFloats({40}, values.data())));
  write("walk.notes.csv", "hello\n");
  const ControlLayout layout{ControlChannel{},
                             {.name = "speech", .kind = ControlKind::Array, .values = {"0"}},
                             {.name = "music", .kind = ControlKind::Array, .values = {"0"}}};
  Clip read = readClip(path);
  readSignals(read, layout);
  ASSERT_EQ(read.annotations.signals.size(), 1U);
  EXPECT_EQ(read.annotations.signals["speech"].rows(), 40);
  EXPECT_EQ(read.annotations.signals["speech"].fps, 20.0);
  write("walk.music.npy", serialiseNpy(Tensor::fromFloats({20}, values.data())));
  EXPECT_NE(refusal([&] { readSignals(read, layout); }).find("40 frames"), std::string::npos);
}

/// Files beside a clip are no clips, and no strangers either.
TEST_F(AnnotationFiles, AreNoMotionsOfAFolder) {
  const auto path = clip();
  const std::vector<float> cube(40 * 21 * 3, 0.5F);
  write("walk.speech.npy", serialiseNpy(Tensor::fromFloats({40, 21, 3}, cube.data())));
  write("walk.labels.csv", "time,label\n0,walk\n");
  write("alone.speech.npy", serialiseNpy(Tensor::fromFloats({40, 21, 3}, cube.data())));
  const Inputs inputs = findInputs({path.parent_path().string()});
  ASSERT_EQ(inputs.files.size(), 2U);
  EXPECT_EQ(inputs.files[0].path.filename(), "alone.speech.npy");
  EXPECT_EQ(inputs.files[1].path.filename(), "walk.bvh");
  EXPECT_TRUE(inputs.notRead.empty());
  EXPECT_TRUE(inputs.others.empty());
}

}  // namespace
}  // namespace marey::io
