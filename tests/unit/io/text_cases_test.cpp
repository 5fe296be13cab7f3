// Files of kinds that people stumbled over: names, habits, frame counts and lines of BVH files
// (tests/fixtures/03 to 06), and other members of each kind.
#include "unit/io/text_cases.h"

namespace marey::io {
namespace {

using namespace test_cases;

// 03: joint names with bytes of other encodings.

const std::string kNames = "03-odd-joint-names/";

TEST(OddNames, OldEncodingsDoNotChangeThePositions) {
  const Clip plain = readClip(fixture(kNames + "ascii.bvh"));
  ASSERT_EQ(plain.frameCount(), 61);
  EXPECT_LT((plain.at(0, 0) - Vec3(0.0f, 0.9f, 0.0f)).norm(), 1e-5f);
  EXPECT_LT((plain.at(0, 15) - Vec3(0.09f, 0.08f, 0.35f)).norm(), 1e-5f);
  for (const char* name : {"shift_jis.bvh", "gbk.bvh"}) {
    const Clip odd = readClip(fixture(kNames + name), {.unit = "cm", .up = "y"});
    EXPECT_LT(largestDistance(plain, odd), 1e-5) << name;
    const auto& names = odd.skeleton->names;
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), 21u) << name;
  }
}

TEST(OddNames, FeetMayBeNamedByTheirBytesAndByNamesThatHoldCommas) {
  const Clip odd = readClip(fixture(kNames + "shift_jis.bvh"));
  const auto& names = odd.skeleton->names;
  EXPECT_EQ(jointsByName(*odd.skeleton, names[15] + "," + names[19]), (std::vector<int>{15, 19}));
  Skeleton commas;
  commas.names = {"a", "foot, left", "foot, right", "foot"};
  commas.parents = {-1, 0, 0, 0};
  EXPECT_EQ(jointsByName(commas, "foot, left,foot, right"), (std::vector<int>{1, 2}));
  EXPECT_EQ(jointsByName(commas, "foot,a"), (std::vector<int>{3, 0}));
}

bool isUtf8(const std::string& text) {
  for (size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const int more = c < 0x80 ? 0 : c < 0xC2 ? -1 : c < 0xE0 ? 1 : c < 0xF0 ? 2 : c < 0xF5 ? 3 : -1;
    if (more < 0) return false;
    for (int k = 0; k < more; ++k)
      if (++i >= text.size() || (static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) return false;
  }
  return true;
}

/// Two names that differ in bytes that are no UTF-8 only.
std::string withTwins() {
  return with(with(bytesOf(kNames + "ascii.bvh"), "JOINT LeftHand", "JOINT hand\x83{"),
              "JOINT RightHand", "JOINT hand\x84{");
}

TEST(OddNames, WhatIsWrittenIsUtf8AndNoTwoNamesBecomeOne) {
  const test::TemporaryFolder folder;
  const Clip clip = parseBvh(withTwins(), "twins.bvh");
  const auto jointsOfCsv = [&] {
    std::set<std::string> out;
    std::istringstream in(readFile(folder / "a.csv"));
    for (std::string line; std::getline(in, line);) {
      const size_t second = line.find(',', line.find(',') + 1) + 1;
      out.insert(line.substr(second, line.find(',', second) - second));
    }
    return out.size() - 1;  // without the header
  };
  for (const char* name : {"a.csv", "a.gltf"}) {
    writeClip(clip, folder / name);
    EXPECT_TRUE(isUtf8(readFile(folder / name))) << name;
  }
  EXPECT_EQ(jointsOfCsv(), 21u);
  std::set<std::string> nodes;
  const Json scene = readJson(folder / "a.gltf");
  for (const Json& node : scene["nodes"]) nodes.insert(node["name"].get<std::string>());
  EXPECT_EQ(nodes.size(), 22u);  // and the body
  EXPECT_TRUE(isUtf8(jsonText(toJson(examineClip(clip)))));
  writeClip(clip, folder / "a.bvh");
  EXPECT_EQ(readClip(folder / "a.bvh").skeleton->names, clip.skeleton->names);
}

TEST(OddNames, ThePositionsOfAFitAreToldForEveryJoint) {
  const test::TemporaryFolder folder;
  Clip bare = parseBvh(withTwins(), "twins.bvh");
  bare.transforms.reset();
  writeClip(bare, folder / "a.bvh");
  const Json recipe = readJson(folder / "a.bvh.recipe.json");
  EXPECT_EQ(recipe["fit"]["fit_residual_cm"].size(), 21u);
}

TEST(OddNames, ABraceMayStandOnTheLineOfAnyName) {
  const std::string text = withTwins();
  const Clip clip = parseBvh(text, "a.bvh");
  // "hand\x83{" and its brace on one line: glued, and with a blank.
  for (const char* gap : {"", " "}) {
    std::string joined = text;
    const size_t at = joined.find("hand\x83{") + 6;
    joined.replace(at, joined.find('{', at) - at, gap);
    EXPECT_EQ(parseBvh(joined, "a.bvh").skeleton->names, clip.skeleton->names) << gap;
  }
}

// 04: habits of naming.

class Habits : public ::testing::TestWithParam<const char*> {};

TEST_P(Habits, UnitSidesAndFeetAreFound) {
  const Clip plain = readClip(fixture("04-naming-habits/plain.bvh"));
  const Clip clip = readClip(fixture(std::string("04-naming-habits/") + GetParam()));
  EXPECT_LT(largestDistance(plain, clip), 1e-6);
  const SkeletonRoles roles = rolesOf(*clip.skeleton);
  EXPECT_EQ(roles.feet, (std::vector<int>{15, 19}));
  EXPECT_EQ(roles.mirror, rolesOf(*plain.skeleton).mirror);
  EXPECT_EQ((std::vector<int>{roles.hips, roles.leftHip, roles.rightHip, roles.leftShoulder,
                              roles.rightShoulder}),
            (std::vector<int>{0, 13, 17, 6, 10}));
  const DoctorReport report = examineClip(clip);
  EXPECT_EQ(report.unit.value, "cm");
  expectContains(report.unit.evidence, "195 units");
  EXPECT_EQ(report.sides.value, "as named");
  expectContains(report.skeleton, "biped");
  EXPECT_TRUE(doubtsOf(clip).empty());
}

INSTANTIATE_TEST_SUITE_P(All, Habits,
                         ::testing::Values("plain.bvh", "bip_blanks.bvh", "low_and_up_parts.bvh",
                                           "prefix_character1.bvh", "prefix_def_dots.bvh",
                                           "prefix_m_avg.bvh", "suffix_jnt.bvh"),
                         [](const auto& info) {
                           const std::string file = info.param;
                           return file.substr(0, file.find('.'));
                         });

TEST(NamingHabits, WithoutKnownNamesUnitAndUpAreUncertain) {
  std::string text = bytesOf("04-naming-habits/plain.bvh");
  int n = 0;
  for (const char* word : {"ROOT ", "JOINT "})
    for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
      const size_t name = at + std::string(word).size();
      text.replace(name, text.find('\n', name) - name, fmt::format("bone{:02}", n++));
    }
  ASSERT_EQ(n, 21);
  const Clip clip = parseBvh(text, "unknown.bvh");
  const std::vector<Fault> doubts = doubtsOf(clip);
  EXPECT_NE(find(doubts, "unit_uncertain"), nullptr);
  EXPECT_NE(find(doubts, "up_uncertain"), nullptr);
  EXPECT_TRUE(doubtsOf(parseBvh(text, "unknown.bvh", {.unit = "cm", .up = "y"})).empty());
}

// 05: another number of rows than the header says.

const std::string kRows = "05-frame-count/";

TEST(FrameCount, OneRowMoreOrLessOrNoCountIsReadAndNoted) {
  const Clip right = readClip(fixture(kRows + "right.bvh"));
  EXPECT_EQ(right.frameCount(), 31);
  EXPECT_TRUE(doubtsOf(right).empty());
  const std::tuple<const char*, int, const char*> cases[] = {
      {"one_row_more.bvh", 32, "the header says 31 frames, the file has 32"},
      {"last_row_cut.bvh", 30, "the last row has 60 of 66 numbers"},
      {"count_missing.bvh", 31, "the header has no line 'Frames:': 31"}};
  for (const auto& [name, frames, note] : cases) {
    const Clip clip = readClip(fixture(kRows + name));
    EXPECT_EQ(clip.frameCount(), frames) << name;
    EXPECT_TRUE(hasNote(clip, note)) << name;
    EXPECT_NE(find(examineClip(clip).faults, "frame_count"), nullptr) << name;
    const int same = std::min(frames, 31);
    EXPECT_EQ(sliceFrames(clip, 0, same).positions, sliceFrames(right, 0, same).positions) << name;
  }
}

TEST(FrameCount, MoreThanOneRowOffIsRefusedUnlessWholeRowsAreAskedFor) {
  const std::string right = bytesOf(kRows + "right.bvh");
  for (const char* told : {"29", "33", "300"}) {
    const std::string text = with(right, "Frames: 31", std::string("Frames: ") + told);
    const std::string message = inputErrorOf([&] { parseBvh(text, "a.bvh"); });
    for (const char* part : {told, "after 31", "--whole-rows", "a.bvh:"})
      expectContains(message, part);
    EXPECT_EQ(parseBvh(text, "a.bvh", {.wholeRows = true}).frameCount(), 31) << told;
  }
}

TEST(FrameCount, ANumberMissingInTheMiddleIsNamedWhateverTheCountSays) {
  std::string text = bytesOf(kRows + "right.bvh");
  const size_t row = text.find('\n', text.find('\n', text.find("Frame Time")) + 1) + 1;
  text.erase(row, text.find(' ', row) + 1 - row);
  const std::string message = inputErrorOf([&] { parseBvh(text, "a.bvh", {.wholeRows = true}); });
  expectContains(message, "frame 2");
  expectContains(message, "expected 66 numbers, found 65");
}

TEST(FrameCount, AMissingFrameTimeNeedsARate) {
  const std::string right = bytesOf(kRows + "right.bvh");
  const size_t at = right.find("Frame Time");
  const std::string text = right.substr(0, at) + right.substr(right.find('\n', at) + 1);
  expectContains(inputErrorOf([&] { parseBvh(text, "a.bvh"); }), "--source-fps");
  EXPECT_EQ(parseBvh(text, "a.bvh", {.fps = 30.0}).fps, 30.0);
}

// 06: lines broken elsewhere.

const std::string kLines = "06-lines-broken/";

TEST(BrokenLines, NothingTiesARowToALine) {
  for (const char* name :
       {"channels_over_two_lines.bvh", "motion_on_frames_line.bvh", "rows_wrapped_at_16.bvh"}) {
    const Clip clip = readClip(fixture(kLines + name));
    EXPECT_EQ(clip.frameCount(), 31) << name;
    EXPECT_EQ(clip.fps, 30.0) << name;
    expectPositions(clip, fixture(kLines + "expected_frames_0_15_30.csv"));
  }
  EXPECT_TRUE(hasNote(readClip(fixture(kLines + "rows_wrapped_at_16.bvh")), "several lines"));
}

std::string withoutLineEnds(std::string text, size_t from) {
  std::replace(text.begin() + static_cast<long>(from), text.end(), '\n', ' ');
  return text;
}

TEST(BrokenLines, EverythingMayStandOnOneLineAndWordsOnLinesOfTheirOwn) {
  const std::string text = bytesOf(kLines + "motion_on_frames_line.bvh");
  const Clip clip = parseBvh(text, "a.bvh");
  const std::string one = withoutLineEnds(text, 0);
  EXPECT_EQ(parseBvh(one, "a.bvh").positions, clip.positions);
  EXPECT_EQ(parseBvh(withoutLineEnds(text, text.find("MOTION")), "a.bvh").positions,
            clip.positions);
  std::string words = text;
  std::replace(words.begin(), words.end(), ' ', '\n');
  words = with(with(words, "End\nSite", "End Site"), "Frame\nTime:\n", "Frame Time:\n");
  EXPECT_EQ(parseBvh(words, "a.bvh").positions, clip.positions);
}

TEST(BrokenLines, WithoutLinesANumberTooFewIsRefused) {
  std::string text = bytesOf(kLines + "motion_on_frames_line.bvh");
  text = withoutLineEnds(text, text.find("MOTION"));
  while (text.back() == ' ') text.pop_back();
  text.resize(text.rfind(' '));
  expectContains(inputErrorOf([&] { parseBvh(text, "a.bvh"); }), "2046 in 31 rows, found 2045");
  EXPECT_THROW(parseBvh(text, "a.bvh", {.wholeRows = true}), InputError);
  // Wrapped rows too: what is missing shifts all that follows.
  std::string wrapped = bytesOf(kLines + "rows_wrapped_at_16.bvh");
  const size_t row = wrapped.find('\n', wrapped.find("Frame Time")) + 1;
  wrapped.erase(row, wrapped.find(' ', row) + 1 - row);
  EXPECT_THROW(parseBvh(wrapped, "a.bvh"), InputError);
}

TEST(BrokenLines, EncodingsLineEndsRemarksAndPaddingAreNoted) {
  const std::string text = bytesOf(kLines + "motion_on_frames_line.bvh");
  const Clip clip = parseBvh(text, "a.bvh");
  const auto utf16 = [&text](bool big, bool mark) {
    std::string out = !mark ? "" : big ? "\xFE\xFF" : "\xFF\xFE";
    for (const char c : text) {
      if (big) out += '\0';
      out += c;
      if (!big) out += '\0';
    }
    return out;
  };
  std::string cr = text;
  std::replace(cr.begin(), cr.end(), '\n', '\r');
  const std::pair<std::string, const char*> odd[] = {
      {cr, "CR alone"},
      {utf16(false, true), "UTF-16"},
      {utf16(true, true), "UTF-16"},
      {utf16(false, false), "UTF-16"},
      {text + std::string(512, '\0'), "padding"},
      {text + "\x1A", "padding"},
      {with(text, "ROOT", std::string(1, '\0') + "ROOT"), "NUL"},
      {"# made by hand\n// twice\n" + text, "2 remarks"},
      {with(text, "\nFrame Time", "\n# the rate\nFrame Time"), "1 remarks"},
      {"exported by a program\n" + text, "before HIERARCHY"},
      {text + "end of capture\n", "text after the last row"}};
  for (const auto& [bytes, note] : odd) {
    ASSERT_GT(canReadBvh(std::string_view(bytes).substr(0, 4096)), 0) << note;
    const Clip read = parseBvh(bytes, "a.bvh");
    EXPECT_EQ(read.positions, clip.positions) << note;
    EXPECT_TRUE(hasNote(read, note)) << note;
  }
  EXPECT_EQ(parseBvh("\xEF\xBB\xBF" + text, "a.bvh").positions, clip.positions);
  EXPECT_GT(canReadBvh("\xEF\xBB\xBF" + text), 0);
}

TEST(BrokenLines, LineNumbersOfErrorsStayRight) {
  const std::string text =
      with(bytesOf(kLines + "motion_on_frames_line.bvh"), "CHANNELS 3", "CHANNELS x");
  const auto line =
      1 + std::count(text.begin(), text.begin() + static_cast<long>(text.find("CHANNELS x")), '\n');
  std::string cr = text, crlf;
  std::replace(cr.begin(), cr.end(), '\n', '\r');
  for (const char c : text) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  for (const std::string& one : {text, cr, crlf})
    expectContains(inputErrorOf([&] { parseBvh(one, "a.bvh"); }), fmt::format("a.bvh:{}", line));
}

TEST(BrokenLines, FilesPutTogetherGiveEveryClipAndASecondMotionIsRefused) {
  const std::string text = bytesOf(kLines + "motion_on_frames_line.bvh");
  const std::vector<Clip> both = parseBvhClips(text + text, "a.bvh");
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0].positions, both[1].positions);
  EXPECT_NE(both[0].name, both[1].name);
  expectContains(
      inputErrorOf([&] { parseBvhClips(text + text.substr(text.find("MOTION")), "a.bvh"); }),
      "split the file");
}

}  // namespace
}  // namespace marey::io
