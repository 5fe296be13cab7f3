#include "io/doctor.h"

#include <cmath>

#include "unit/io/support.h"

#include "base/atomic_file.h"
#include "io/clip_io.h"
#include "io/known_skeletons.h"

namespace marey::io {
namespace {

/// The field's 21 joints as a person who faces +Z, left on +X, walks 1 m/s at 30 fps with swinging
/// feet; metres.
Clip walker(int frames = 150) {
  Skeleton s = locomotionSkeleton();
  const std::vector<Vec3> rest = {{0, 0.95f, 0},     {0.1f, 0.9f, 0},      {0.1f, 0.5f, 0},
                                  {0.1f, 0.08f, 0},  {0.1f, 0.02f, 0.14f}, {-0.1f, 0.9f, 0},
                                  {-0.1f, 0.5f, 0},  {-0.1f, 0.08f, 0},    {-0.1f, 0.02f, 0.14f},
                                  {0, 1.1f, 0},      {0, 1.25f, 0},        {0, 1.5f, 0},
                                  {0, 1.6f, 0},      {0.18f, 1.45f, 0},    {0.2f, 1.15f, 0},
                                  {0.2f, 0.9f, 0},   {0.2f, 0.82f, 0},     {-0.18f, 1.45f, 0},
                                  {-0.2f, 1.15f, 0}, {-0.2f, 0.9f, 0},     {-0.2f, 0.82f, 0}};
  for (size_t j = 0; j < rest.size(); ++j)
    s.offsets[j] = j == 0 ? rest[0] : Vec3(rest[j] - rest[static_cast<size_t>(s.parents[j])]);
  Clip clip;
  clip.name = "walker";
  clip.fps = 30.0;
  clip.skeleton = std::make_shared<const Skeleton>(s);
  clip.source.format = "test";
  for (int t = 0; t < frames; ++t)
    for (const Vec3& p : rest)
      clip.positions.push_back(p + Vec3(0, 0, static_cast<float>(t) / 30.0f));
  return clip;
}

/// Feet planted for half of each second, left and right in turn, lifted while they move.
Clip steppingWalker() {
  Clip clip = walker(150);
  for (int t = 0; t < 150; ++t)
    for (const int ankle : {3, 7}) {
      const int phase = (t + (ankle == 3 ? 0 : 15)) % 30;
      const float base = static_cast<float>(t - phase) / 30.0f;
      const float move = phase < 15 ? 0.0f : static_cast<float>(phase - 15) / 15.0f;
      for (const int j : {ankle, ankle + 1}) {
        Vec3& p = clip.frame(t)[static_cast<size_t>(j)];
        p.z() = base + move + (j == ankle ? 0.0f : 0.14f);
        p.y() += 0.15f * std::sin(static_cast<float>(M_PI) * move);
      }
    }
  return clip;
}

const Fault* find(const DoctorReport& report, const std::string& kind) {
  for (const Fault& fault : report.faults)
    if (fault.kind == kind) return &fault;
  return nullptr;
}

TEST(Doctor, AGoodClipHasNoFault) {
  const DoctorReport report = examineClip(walker());
  for (const Fault& fault : report.faults)
    EXPECT_EQ(fault.kind, "foot_skate") << fault.evidence;  // this body glides as a whole
  EXPECT_EQ(report.frames, 150);
  EXPECT_EQ(report.joints, 21);
  EXPECT_NEAR(report.seconds, 5.0, 1e-9);
  EXPECT_EQ(report.sides.value, "as named");
  EXPECT_NEAR(*report.floorM, 0.02, 1e-6);
  EXPECT_LT(report.boneDrift.maxStdM, 1e-6);
}

TEST(Doctor, GlidingFeetSkateAndPlantedOnesDoNot) {
  EXPECT_NEAR(*examineClip(walker()).footSkateShare, 1.0, 1e-9);
  EXPECT_NE(find(examineClip(walker()), "foot_skate"), nullptr);
  const DoctorReport stepping = examineClip(steppingWalker());
  EXPECT_LT(*stepping.footSkateShare, 0.05);
  EXPECT_EQ(find(stepping, "foot_skate"), nullptr);
}

TEST(Doctor, SwappedSidesAreSeenFromTheFeet) {
  Clip clip = walker();
  for (Vec3& p : clip.positions) p.x() = -p.x();
  const DoctorReport report = examineClip(clip);
  EXPECT_EQ(report.sides.value, "swapped");
  ASSERT_NE(find(report, "swapped_sides"), nullptr);
  test::expectContains(find(report, "swapped_sides")->evidence, "0 % of 150 frames");
}

TEST(Doctor, AWholeBodyJumpIsATeleportAndNoSpike) {
  Clip clip = walker();
  for (int t = 60; t < 150; ++t)
    for (Vec3& p : clip.frame(t)) p.x() += 3.0f;
  const DoctorReport report = examineClip(clip);
  ASSERT_NE(find(report, "teleport"), nullptr);
  EXPECT_EQ(find(report, "teleport")->frame, 61);
  test::expectContains(find(report, "teleport")->evidence, "between frames 60 and 61");
  EXPECT_EQ(find(report, "spike"), nullptr);
}

TEST(Doctor, ACalibrationPoseBeforeTheMotionIsNamed) {
  Clip clip = walker();
  for (Vec3& p : clip.frame(0)) p += Vec3(2, 0, 2);
  const DoctorReport report = examineClip(clip);
  const Fault* fault = find(report, "calibration_pose");
  ASSERT_NE(fault, nullptr);
  EXPECT_EQ(find(report, "teleport"), nullptr);
  test::expectContains(fault->evidence, "calibration pose");
}

TEST(Doctor, OneJointOffItsPathForOneFrameIsASpike) {
  Clip clip = walker();
  clip.frame(70)[15].y() += 0.4f;
  const DoctorReport report = examineClip(clip);
  ASSERT_NE(find(report, "spike"), nullptr);
  EXPECT_EQ(find(report, "spike")->frame, 71);
  test::expectContains(find(report, "spike")->evidence, "'LeftHand'");
  EXPECT_EQ(find(report, "teleport"), nullptr);
}

TEST(Doctor, FrozenRunsAndRepeatedFramesAreToldApart) {
  Clip clip = walker();
  for (int t = 51; t < 80; ++t) std::copy_n(clip.frame(50).begin(), 21, clip.frame(t).begin());
  const DoctorReport frozen = examineClip(clip);
  ASSERT_NE(find(frozen, "frozen"), nullptr);
  EXPECT_EQ(find(frozen, "frozen")->frame, 51);
  test::expectContains(find(frozen, "frozen")->evidence, "frames 51 to 80");
  EXPECT_EQ(find(frozen, "duplicate_frames"), nullptr);

  Clip doubled = walker();
  for (int t = 1; t < 150; t += 2)
    std::copy_n(doubled.frame(t - 1).begin(), 21, doubled.frame(t).begin());
  const DoctorReport twice = examineClip(doubled);
  EXPECT_EQ(find(twice, "frozen"), nullptr);
  ASSERT_NE(find(twice, "duplicate_frames"), nullptr);
  test::expectContains(find(twice, "duplicate_frames")->evidence, "75 of 150");
}

TEST(Doctor, AStretchingBoneIsNamedWithItsDeviation) {
  Clip clip = walker();
  for (int t = 0; t < 150; ++t) clip.frame(t)[12].y() += t % 2 == 0 ? 0.02f : -0.02f;
  const DoctorReport report = examineClip(clip);
  EXPECT_EQ(report.boneDrift.bone, "Neck1-Head");
  EXPECT_NEAR(report.boneDrift.maxStdM, 0.02, 1e-5);
  EXPECT_NE(find(report, "bone_drift"), nullptr);
}

TEST(Doctor, AFloorElsewhereAndJointsBelowItAreFound) {
  Clip clip = walker();
  for (Vec3& p : clip.positions) p.y() += 0.5f;
  for (int t = 30; t < 40; ++t) clip.frame(t)[15].y() = 0.3f;
  const DoctorReport report = examineClip(clip);
  EXPECT_NEAR(*report.floorM, 0.52, 1e-6);
  EXPECT_NE(find(report, "floor_offset"), nullptr);
  ASSERT_NE(find(report, "below_floor"), nullptr);
  EXPECT_EQ(find(report, "below_floor")->frame, 31);
  test::expectContains(find(report, "below_floor")->evidence, "in 10 frames");
}

TEST(Doctor, ALyingBodyMakesTheUpAxisUncertain) {
  Clip clip = walker();
  for (Vec3& p : clip.positions) p = Vec3(p.y(), p.x(), p.z());
  EXPECT_NE(find(examineClip(clip), "up_uncertain"), nullptr);
}

TEST(Doctor, ZUpFilesAreRecognised) {
  const test::TemporaryFolder folder;
  writeClip(walker(), folder / "z.bvh", {.up = "z"});
  const DoctorReport report = examine(folder / "z.bvh").at(0);
  EXPECT_EQ(report.up.value, "z");
  EXPECT_EQ(report.unit.value, "cm");
  EXPECT_NEAR(*report.floorM, 0.02, 1e-4);
  EXPECT_EQ(report.sides.value, "as named");
}

TEST(Doctor, ShortClipsAndRoundedTimesAreNotes) {
  const test::TemporaryFolder folder;
  writeClip(walker(20), folder / "a.bvh");
  writeFileAtomically(folder / "b.bvh",
                      test::with(readFile(folder / "a.bvh"), "0.0333333333333", "0.033333"));
  const DoctorReport report = examine(folder / "b.bvh").at(0);
  ASSERT_NE(find(report, "rounded_frame_time"), nullptr);
  EXPECT_EQ(find(report, "rounded_frame_time")->severity, Severity::Note);
  ASSERT_NE(find(report, "short_clip"), nullptr);
  EXPECT_EQ(report.fps, 30.0);
}

TEST(Doctor, AFileThatCannotBeReadIsAReportWithTheReason) {
  const test::TemporaryFolder folder;
  writeFileAtomically(folder / "bad.bvh", "HIERARCHY\nROOT a\n{\nOFFSET 0 0 nan\n");
  const DoctorReport report = examine(folder / "bad.bvh").at(0);
  EXPECT_EQ(report.format, "bvh");
  ASSERT_NE(find(report, "unreadable"), nullptr);
  test::expectContains(find(report, "unreadable")->evidence, "bad.bvh:4");
  EXPECT_NE(find(examine(folder / "missing.bvh").at(0), "unreadable"), nullptr);
}

TEST(Doctor, TheJsonHasTheAgreedKeys) {
  const Json json = toJson(examineClip(walker()));
  for (const char* key : {"path", "format", "fps", "frames", "joints", "up", "unit", "faults"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["faults"][0]["kind"], "foot_skate");
  test::expectContains(toText(examineClip(walker())), "21 joints");
}

}  // namespace
}  // namespace marey::io
