// Files of kinds that people stumbled over: rates, offsets, sizes, poses and people of BVH files
// (tests/fixtures/09 to 17), dialects of Acclaim's (23, 24), and other members of each kind.
#include "unit/io/text_cases.h"

namespace marey::io {
namespace {

using namespace test_cases;

// 09: another frame time than that of the recording.

TEST(WrongRate, AWalkLabelledFiveTimesTooSlowIsDoubted) {
  const fs::path file = fixture("09-wrong-frame-time/walk_120_labelled_24.bvh");
  const Fault* fault = nullptr;
  const std::vector<Fault> doubts = doubtsOf(readClip(file));
  ASSERT_NE(fault = find(doubts, "rate_doubtful"), nullptr);
  expectContains(fault->evidence, "--source-fps");
  EXPECT_TRUE(doubtsOf(readClip(file, {.fps = 120.0})).empty());
  const std::vector<Fault> fast = doubtsOf(readClip(file, {.fps = 600.0}));
  EXPECT_NE(find(fast, "rate_doubtful"), nullptr);
}

TEST(WrongRate, KeyFramesAreNoted) {
  const DoctorReport report = examine(fixture("09-wrong-frame-time/keyframes_1_s.bvh")).at(0);
  EXPECT_EQ(report.fps, 1.0);
  EXPECT_EQ(report.seconds, 21.0);
  ASSERT_NE(find(report.faults, "low_rate"), nullptr);
  EXPECT_EQ(find(report.faults, "low_rate")->severity, Severity::Note);
}

// 10: offsets that are all zero.

TEST(ZeroOffsets, BonesAndUnitComeFromThePoses) {
  const test::TemporaryFolder folder;
  for (const char* name : {"offsets_kept_cm.bvh", "offsets_zero_cm.bvh"}) {
    const Clip clip = readClip(fixture(std::string("10-all-offsets-zero/") + name));
    expectPositions(clip, fixture("10-all-offsets-zero/expected_frames_0_15_30.csv"));
    EXPECT_EQ(clip.source.unit, "cm");
    EXPECT_TRUE(doubtsOf(clip).empty()) << name;
    writeClip(clip, folder / "a.bvh");
    writeClip(clip, folder / "a.gltf");
    const std::string text = readFile(folder / "a.bvh");
    const size_t leg = text.find("OFFSET", text.find("JOINT LeftLeg"));
    double x = 0, y = 0, z = 0;
    ASSERT_EQ(std::sscanf(text.c_str() + leg, "OFFSET %lf %lf %lf", &x, &y, &z), 3);
    EXPECT_NEAR(std::hypot(x, y, z), 44.0, 1e-3) << name;
    const Json scene = readJson(folder / "a.gltf");
    for (const Json& node : scene["nodes"])
      if (node["name"] == "LeftLeg") {
        const auto at = node["translation"].get<std::vector<double>>();
        EXPECT_NEAR(std::hypot(at[0], at[1], at[2]), 0.44, 1e-5) << name;
      }
    EXPECT_LT(largestDistance(readClip(folder / "a.bvh"), clip), 1e-5) << name;
  }
}

// 15: bodies of no person's size.

TEST(ScaledBodies, AnUncertainUnitIsADoubtAndAGivenOneIsNot) {
  const std::string folder = "15-scaled-characters/";
  const auto leg = [](const Clip& clip) {
    const SkeletonRoles roles = rolesOf(*clip.skeleton);
    return (clip.at(0, roles.leftHip + 1) - clip.at(0, roles.leftHip)).norm() +
           (clip.at(0, roles.leftHip + 2) - clip.at(0, roles.leftHip + 1)).norm();
  };
  const Clip person = readClip(fixture(folder + "person.bvh"));
  EXPECT_NEAR(leg(person), 0.88f, 1e-5f);
  EXPECT_TRUE(doubtsOf(person).empty());
  for (const char* name : {"giant_in_cm.bvh", "feet_as_unit.bvh"})
    EXPECT_NE(find(doubtsOf(readClip(fixture(folder + name))), "unit_uncertain"), nullptr) << name;
  const Clip feet = readClip(fixture(folder + "feet_as_unit.bvh"), {.unit = "foot"});
  EXPECT_NEAR(leg(feet), 0.88f, 1e-4f);
  EXPECT_TRUE(doubtsOf(feet).empty());
  EXPECT_NEAR(leg(readClip(fixture(folder + "giant_in_cm.bvh"), {.unit = "cm"})), 1.8128f, 1e-4f);
}

/// The plain walk of 04 with every joint's name changed by a rule.
std::string renamed(const std::function<std::string(const std::string&)>& rule) {
  std::string text = bytesOf("04-naming-habits/plain.bvh");
  for (const char* word : {"ROOT ", "JOINT "})
    for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
      const size_t name = at + std::string(word).size(), end = text.find('\n', name);
      text.replace(name, end - name, rule(text.substr(name, end - name)));
    }
  return text;
}

TEST(ScaledBodies, AnimalsAndHandsHaveNoPersonsUnit) {
  // The same rig, called an animal's by a tail.
  const std::string tail = renamed([](const std::string& n) { return n == "Head" ? "Tail" : n; });
  EXPECT_NE(find(doubtsOf(parseBvh(tail, "dog.bvh")), "unit_uncertain"), nullptr);
  // And one that walks on all fours under a person's names: the trunk lies before the legs.
  Clip person = readClip(fixture("04-naming-habits/plain.bvh"));
  const std::string text = bytesOf("04-naming-habits/plain.bvh");
  const std::string four = with(text, "OFFSET 0 12 0", "OFFSET 0 0 40");
  ASSERT_NE(text, four);
  std::string lying =
      with(with(four, "OFFSET 0 15 0", "OFFSET 0 0 40"), "OFFSET 0 25 0", "OFFSET 0 0 25");
  lying = with(with(lying, "OFFSET 5 22 0", "OFFSET 5 0 22"), "OFFSET -5 22 0", "OFFSET -5 0 22");
  EXPECT_NE(find(doubtsOf(parseBvh(lying, "horse.bvh")), "unit_uncertain"), nullptr);
  const std::string hand = renamed(
      [](const std::string& n) { return "finger_" + std::to_string(std::hash<std::string>()(n)); });
  EXPECT_NE(find(doubtsOf(parseBvh(hand, "hand.bvh")), "unit_uncertain"), nullptr);
}

// 16: a pose to calibrate by in front of the motion.

TEST(CalibrationPose, IsNamedOnceAndNoSpike) {
  const Clip alone = readClip(fixture("16-one-frame-and-pose-files/walk_alone.bvh"));
  const Clip with = readClip(fixture("16-one-frame-and-pose-files/tpose_then_walk.bvh"));
  EXPECT_TRUE(doubtsOf(alone).empty());
  const DoctorReport report = examineClip(with);
  const Fault* fault = find(report.faults, "calibration_pose");
  ASSERT_NE(fault, nullptr);
  expectContains(fault->evidence, "0.21 m");
  expectContains(fault->evidence, "0.033 m");
  EXPECT_EQ(find(report.faults, "spike"), nullptr);
  EXPECT_EQ(find(report.faults, "teleport"), nullptr);
  EXPECT_LT(largestDistance(sliceFrames(with, 1, 92), alone), 1e-5);
}

// 17: several ROOTs.

TEST(TwoRoots, EveryPersonIsAClip) {
  const std::vector<Clip> clips = readClips(fixture("17-two-people-in-one-file/two_roots.bvh"));
  ASSERT_EQ(clips.size(), 2u);
  EXPECT_EQ(clips[0].name, "two_roots_Hips");
  EXPECT_EQ(clips[1].name, "two_roots_B_Hips");
  ASSERT_EQ(clips[0].frameCount(), 31);
  Clip moved = clips[1];
  for (Vec3& p : moved.positions) p.x() -= 2.0f;
  EXPECT_LT(largestDistance(clips[0], moved), 1e-5);
  EXPECT_EQ(rolesOf(*clips[1].skeleton).feet, rolesOf(*clips[0].skeleton).feet);
  EXPECT_TRUE(doubtsOf(clips[1]).empty());
}

TEST(TwoRoots, APropIsLeftOutAndNamed) {
  const Clip clip = readClip(fixture("17-two-people-in-one-file/person_and_prop.bvh"));
  EXPECT_EQ(clip.jointCount(), 21);
  const std::vector<Fault> doubts = doubtsOf(clip);
  const Fault* fault = find(doubts, "left_out");
  ASSERT_NE(fault, nullptr);
  expectContains(fault->evidence, "'Ball'");
}

// 23, 24: units and dialects of ASF and AMC.

Vec3 bone(const Clip& clip, const std::string& joint, int frame = 0) {
  return clip.at(frame, clip.skeleton->find(joint));
}

TEST(AsfUnits, TheSizeOfTheBodyDecidesBetweenWaysToWriteAUnit) {
  const std::pair<const char*, bool> cases[] = {
      {"inch_1", false}, {"length_1_values_in_cm", true}, {"spec_254_values_in_inch", true}};
  for (const auto& [name, doubted] : cases) {
    const Clip clip = readClip(fixture("23-asf-length-units") / name / "p.amc");
    EXPECT_NEAR((bone(clip, "lfemur") - bone(clip, "ltibia")).norm(), 0.4572f, 1e-5f) << name;
    EXPECT_EQ(find(doubtsOf(clip), "unit_uncertain") != nullptr, doubted) << name;
  }
  const Clip given =
      readClip(fixture("23-asf-length-units/length_1_values_in_cm/p.amc"), {.unit = "cm"});
  EXPECT_NEAR((bone(given, "lfemur") - bone(given, "ltibia")).norm(), 0.4572f, 1e-5f);
  EXPECT_TRUE(doubtsOf(given).empty());
}

void expectPlain(const Clip& clip) {
  constexpr float kInch = 0.0254f;
  const std::tuple<int, const char*, Vec3> expected[] = {{0, "lfemur", {5, 36, 3}},
                                                         {0, "ltibia", {5, 18, 3}},
                                                         {0, "head", {2, 56, 3}},
                                                         {1, "lfemur", {2, 36, 0}},
                                                         {1, "ltibia", {-14.914f, 33.894f, 5.785f}},
                                                         {1, "head", {2, 40, 19}}};
  for (const auto& [frame, joint, inches] : expected)
    EXPECT_LT((bone(clip, joint, frame) - inches * kInch).norm(), 1e-3f * kInch) << joint << frame;
}

TEST(AmcDialects, StatedRatesAndLengthChannelsAreRead) {
  const fs::path folder = fixture("24-amc-dialects");
  const Clip plain = readClip(folder / "00_plain/p.amc");
  expectPlain(plain);
  EXPECT_TRUE(hasNote(plain, "states no frame rate"));
  const Clip rate = readClip(folder / "04_samples_per_second_60/p.amc");
  EXPECT_EQ(rate.fps, 60.0);
  EXPECT_FALSE(hasNote(rate, "states no frame rate"));
  expectPlain(readClip(folder / "11_dof_with_length/p.amc"));
  const Clip turned = readClip(folder / "18_root_orientation/p.amc");
  EXPECT_NE(find(examineClip(turned).faults, "root_orientation"), nullptr);
}

TEST(AmcDialects, UnknownSettingsAreNotedAndLengthsThatMeanTwoThingsRefused) {
  const test::TemporaryFolder folder;
  const fs::path plain = fixture("24-amc-dialects/11_dof_with_length");
  fs::copy_file(plain / "p.asf", folder / "p.asf");
  const std::string amc = readFile(plain / "p.amc");
  writeFileAtomically(folder / "p.amc", with(amc, ":DEGREES\n", ":DEGREES\n:SMOOTHED by hand\n"));
  EXPECT_TRUE(hasNote(readClip(folder / "p.amc"), "':SMOOTHED by hand' is not read"));
  writeFileAtomically(folder / "p.amc", with(amc, "ltibia 0 0\n", "ltibia 0 2\n"));
  expectContains(inputErrorOf([&] { readClip(folder / "p.amc"); }), "bone 'ltibia'");
  std::string cr = amc;
  std::replace(cr.begin(), cr.end(), '\n', '\r');
  writeFileAtomically(folder / "p.amc", cr);
  expectPlain(readClip(folder / "p.amc"));
}

}  // namespace
}  // namespace marey::io
