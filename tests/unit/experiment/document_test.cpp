// The experiment document: what is stored, edits, history, natural motion.
#include <csignal>
#include <cstdlib>
#include <fstream>

#include "fuzz/experiment_seeds.h"
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "experiment/edits.h"
#include "experiment/history.h"
#include "experiment/run.h"
#include "io/clip_io.h"
#include "motion/walker.h"

namespace marey {
namespace {

namespace fs = std::filesystem;

Experiment twoPaths() {
  Experiment out;
  out.natural = {"walker:2,2,1"};
  out.systems = {{"MG", "a.marey", 1.0}, {"MG+", "b.marey", 1.0}};
  out.paths = {{.name = "still", .path = "preset:still"},
               {.name = "drawn",
                .path = {},
                .wayPoints = {{.x = 0, .z = 0, .timeS = {}, .speedMS = {}, .facing = {}},
                              {.x = 0, .z = 2, .timeS = {}, .speedMS = {}, .facing = {}},
                              {.x = 1, .z = 3, .timeS = {}, .speedMS = {}, .facing = {}}},
                .seconds = 0.0}};
  return out;
}

class InFolder : public ::testing::Test {
 protected:
  InFolder() {
    std::string name = (fs::temp_directory_path() / "marey-document-XXXXXX").string();
    m_folder = ::mkdtemp(name.data());
  }
  ~InFolder() override { fs::remove_all(m_folder); }
  fs::path m_folder;
};

TEST(PathSeconds, AnyLengthThatIsSetCanBeReadBack) {
  for (const double wanted : {-1.0, 0.0, 0.05, 0.1, 0.15, 0.2, 7.5}) {
    for (const size_t path : {0U, 1U}) {
      Experiment e = twoPaths();
      setPathSeconds(e, path, wanted);
      EXPECT_EQ(asStored(e), e) << wanted << " s";
      EXPECT_TRUE(e.paths[path].seconds == 0.0 || e.paths[path].seconds >= 0.2) << wanted;
    }
  }
}

TEST(Start, IsTakenFromAClipOnly) {
  Experiment e = twoPaths();
  e.paths[0] = {.name = "clip", .path = "clip:walk.bvh", .startFromClip = true};
  EXPECT_EQ(asStored(e), e);
  EXPECT_TRUE(toJson(e)["paths"][0]["start"] == "clip");
  EXPECT_FALSE(toJson(e)["paths"][1].contains("start"));
  e.paths[0].path = "preset:still";
  EXPECT_THROW(asStored(e), InputError);
  Json document = toJson(twoPaths());
  document["paths"][0]["start"] = "middle";
  EXPECT_THROW(experimentFromJson(document, "test"), InputError);
}

TEST(Facing, IsTheSameAfterSavingAndOpening) {
  for (int i = -1000; i <= 1000; ++i) {
    Experiment e = twoPaths();
    e.paths[1].wayPoints[0].facing = 0.00314159 * i;
    const Experiment once = asStored(e);
    EXPECT_EQ(asStored(once), once) << i;
    EXPECT_NEAR(*once.paths[1].wayPoints[0].facing, 0.00314159 * i, 1e-14);
  }
}

TEST(ChangedPlace, IsTheNarrowestValueThatHoldsAllChanges) {
  const Experiment before = twoPaths();
  Experiment after = before;
  after.seed = 9;
  EXPECT_EQ(changedPlace(before, after), "/seed");
  after.samples = 9;
  EXPECT_EQ(changedPlace(before, after), "");
  after = before;
  after.systems[1].temperature = 0.5;
  EXPECT_EQ(changedPlace(before, after), "/systems/1/temperature");
  after = before;
  after.paths[1].wayPoints[2].x = 5.0;
  EXPECT_EQ(changedPlace(before, after), "/paths/1/waypoints/2");
  after.paths[1].wayPoints[2].z = 5.0;
  EXPECT_EQ(changedPlace(before, after), "/paths/1/waypoints/2");
}

TEST(HistoryOfEdits, MergesOneDragOnly) {
  History<int> history(0);
  history.commit(1, "Move", "/a/1");
  history.amend(2, "Move", "/a/1");
  EXPECT_EQ(history.size(), 2U);
  history.amend(3, "Move", "/a/2");
  EXPECT_EQ(history.size(), 3U) << "another thing was moved";
  history.amend(4, "Move", "/a/2/x");
  EXPECT_EQ(history.size(), 3U) << "a part of the same thing";
  history.amend(5, "Move", "/a/20");
  EXPECT_EQ(history.size(), 4U) << "its name only begins alike";
  history.seal();
  history.amend(6, "Move", "/a/20");
  EXPECT_EQ(history.size(), 5U) << "what was saved was overwritten";
  history.undo();
  history.redo();
  history.amend(7, "Move", "/a/20");
  EXPECT_EQ(history.size(), 6U) << "an edit that was gone back to was overwritten";
}

TEST_F(InFolder, ADocumentReadByARelativeNameKnowsItsWholeFolder) {
  writeExperiment(m_folder / "x.json", twoPaths());
  const fs::path here = fs::current_path();
  fs::current_path(m_folder);
  const Experiment read = readExperiment("x.json");
  fs::current_path(here);
  EXPECT_TRUE(read.folder.is_absolute());
  EXPECT_TRUE(fs::equivalent(read.folder, m_folder));
}

TEST_F(InFolder, AFileThatVanishedCostsOnlyItsOwnClips) {
  Experiment e = twoPaths();
  e.folder = m_folder;
  e.natural = {"walker:2,2,1", "gone.bvh", "walker:1,2,5"};
  std::ofstream(m_folder / "noise.bvh") << "HIERARCHY\nno\n";
  e.natural.emplace_back("noise.bvh");
  Progress progress;
  const NaturalMotion natural = readableNatural(e, progress);
  ASSERT_EQ(natural.clips.size(), 3U);
  EXPECT_EQ(natural.sources,
            (std::vector<std::string>{"walker:2,2,1", "walker:2,2,1", "walker:1,2,5"}));
  ASSERT_EQ(natural.faults.size(), 2U);
  EXPECT_NE(natural.faults[0].find("gone.bvh"), std::string::npos) << natural.faults[0];
  EXPECT_NE(natural.faults[1].find("noise.bvh"), std::string::npos) << natural.faults[1];
  EXPECT_THROW(naturalMotion(e, progress), Error) << "a report would leave clips out silently";
}

TEST_F(InFolder, ABrokenFileInAFolderIsLeftOutAndNamed) {
  Experiment e = twoPaths();
  e.folder = m_folder;
  fs::create_directories(m_folder / "clips");
  io::writeClip(walkerDataSet(1, 2.0, 1, 20.0).front().clip, m_folder / "clips/b.bvh");
  std::ofstream(m_folder / "clips/a.bvh") << "HIERARCHY\nno\n";
  std::ofstream(m_folder / "clips/c.npz") << "no archive";
  e.natural = {"clips"};
  Progress progress;
  for (const NaturalMotion& natural : {naturalMotion(e, progress), readableNatural(e, progress)}) {
    ASSERT_EQ(natural.clips.size(), 1U);
    EXPECT_TRUE(natural.faults.empty()) << natural.faults.front();
    ASSERT_EQ(natural.inputs.size(), 1U);
    EXPECT_EQ(natural.inputs[0].first, "clips");
    EXPECT_EQ(natural.inputs[0].second.missingText(), "2 files not read");
  }
  e.natural = {"clips/a.bvh", "clips/b.bvh"};
  EXPECT_THROW(naturalMotion(e, progress), InputError) << "it was asked for by name";
  EXPECT_EQ(readableNatural(e, progress).faults.size(), 1U);
  fs::remove(m_folder / "clips/b.bvh");
  e.natural = {"clips"};
  EXPECT_THROW(naturalMotion(e, progress), InputError) << "nothing in it can be read";
}

TEST(ViewState, SeedsOfTheFuzzerAreDocuments) {
  const Json rich = richDocument();
  const Experiment document = experimentFromJson(rich, "rich");
  const auto sorted = [](const Json& json) { return nlohmann::json::parse(json.dump()); };
  EXPECT_EQ(sorted(toJson(document)), sorted(rich));
  EXPECT_EQ(document.view.sets[0].leftOut, (std::vector<int>{1, 5}));
}

/// Types, signals and bodies are kept, their files move with the document, and documents without
/// keep the hash that they had.
TEST_F(InFolder, ControlOfPathsIsKeptAndMoves) {
  Experiment e = twoPaths();
  const std::string before = experimentHash(e);
  e.folder = m_folder;
  e.paths[0].control = {.type = "walk",
                        .signals = {{"speech", "speech.npy"}},
                        .leftOut = {"music"},
                        .body = "tall.bvh"};
  e.paths[1].wayPoints[1].type = "run";
  EXPECT_NE(experimentHash(e), before);
  EXPECT_EQ(experimentFromJson(toJson(e), "again").paths, e.paths);
  EXPECT_EQ(motionTypes(e, {}), (std::vector<std::string>{"run", "walk"}));
  moveToFolder(e, m_folder.parent_path());
  EXPECT_EQ(e.paths[0].control.signals["speech"], (m_folder.filename() / "speech.npy").string());
  EXPECT_EQ(e.paths[0].control.body, (m_folder.filename() / "tall.bvh").string());
  for (const char* wrong :
       {R"({"signals": 3})", R"({"signals": {"a": 1}})", R"({"left_out": 1})"}) {
    Json json = toJson(e);
    json["paths"][0].update(Json::parse(wrong));
    EXPECT_THROW(experimentFromJson(json, "wrong"), InputError) << wrong;
  }
}

TEST(Cases, AreKeptWithTheOptionsOfTheirTask) {
  Experiment e = twoPaths();
  e.cases = {{.name = "soon",
              .task = "predict",
              .options = {{"seed_frames", 20}, {"seconds", 1.5}},
              .samples = 3}};
  const Json json = toJson(e);
  EXPECT_EQ(json["cases"][0]["options"]["seed_frames"], Json(20));
  EXPECT_EQ(experimentFromJson(json, "again").cases, e.cases);
  const std::pair<const char*, const char*> wrong[] = {
      {R"({"task": "follow"})", "predict, complete, denoise"},
      {R"({"options": {"seed_frames": 2.5}})", "options.seed_frames"},
      {R"({"options": {"seconds": -1}})", "at least 0"},
      {R"({"options": {"noise": 1}})", "options.noise"},
      {R"({"task": "complete", "options": {"mask": 1}})", "options.mask"},
      {R"({"samples": 0})", "at least 1"}};
  for (const auto& [change, expected] : wrong) {
    Json changed = json;
    changed["cases"][0].update(Json::parse(change));
    try {
      experimentFromJson(changed, "wrong");
      FAIL() << change;
    } catch (const InputError& fault) {
      EXPECT_NE(std::string(fault.what()).find(expected), std::string::npos) << fault.what();
    }
  }
}

TEST(LeftOut, IsStoredAndChangesNoOtherDocument) {
  Experiment e = twoPaths();
  EXPECT_FALSE(toJson(e).contains("natural_left_out")) << "every document would get another hash";
  e.naturalLeftOut = {"b", "a"};
  EXPECT_EQ(asStored(e), e);
  EXPECT_NE(experimentHash(e), experimentHash(twoPaths()));
}

TEST(LeftOut, ClipsOfAnotherSkeletonThanMostAreNamed) {
  std::vector<Clip> clips;
  for (uint64_t seed = 1; seed <= 3; ++seed)
    clips.push_back(walkerDataSet(1, 2.0, seed, 20.0).front().clip);
  for (size_t i = 0; i < clips.size(); ++i)
    clips[i].name = std::string(1, static_cast<char>('a' + i));
  Skeleton odd = *clips[0].skeleton;
  odd.names.back() = "Tail";
  clips[0].skeleton = std::make_shared<const Skeleton>(odd);
  const auto leftOut = keepMainBody(clips);
  ASSERT_EQ(clips.size(), 2U);
  EXPECT_EQ(clips[0].name, "b");
  ASSERT_EQ(leftOut.size(), 1U);
  EXPECT_EQ(leftOut[0].what, "a");
  EXPECT_NE(leftOut[0].why.find("'Tail'"), std::string::npos) << leftOut[0].why;
  const auto named = dropNamed(clips, {"c", "zz"});
  ASSERT_EQ(named.size(), 1U);
  EXPECT_EQ(named[0].what, "c");
  EXPECT_EQ(clips.size(), 1U);
}

TEST(Running, WithoutNaturalMotionIsRefused) {
  Experiment e = twoPaths();
  e.natural.clear();
  Progress progress;
  EXPECT_THROW(runExperiment(e, {}, progress), InputError);
}

/// Runs `work` in another process; its exit status, or minus the signal that ended it.
int inChild(const std::function<void()>& work, int killAfterMs = 0) {
  const pid_t child = ::fork();
  if (child == 0) {
    work();
    std::_Exit(0);
  }
  if (killAfterMs > 0) {
    ::usleep(static_cast<useconds_t>(1000 * killAfterMs));
    ::kill(child, SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

TEST_F(InFolder, AProcessKilledWhileSavingLeavesAWholeDocument) {
  const fs::path file = m_folder / "x.json";
  Experiment e = twoPaths();
  writeExperiment(file, e);
  for (int round = 0; round < 5; ++round) {
    const int end = inChild(
        [&] {
          for (uint64_t seed = 2;; ++seed) {
            e.seed = seed;
            e.notes = std::string(100000 + seed % 7, 'x');
            writeExperiment(file, e);
          }
        },
        20 + 7 * round);
    ASSERT_EQ(end, -SIGKILL);
    EXPECT_NO_THROW(readExperiment(file));
  }
  EXPECT_GT(readExperiment(file).seed, 1U) << "nothing was ever saved";
}

TEST_F(InFolder, AFullDiskIsAnErrorAndLeavesTheOldDocument) {
  const fs::path file = m_folder / "x.json";
  writeExperiment(file, twoPaths());
  constexpr int kRefused = 7;
  const int end = inChild([&] {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{10000, 10000};
    ::setrlimit(RLIMIT_FSIZE, &small);
    Experiment e = twoPaths();
    e.notes = std::string(100000, 'x');
    try {
      writeExperiment(file, e);
    } catch (const FileError&) {
      std::_Exit(kRefused);
    }
  });
  EXPECT_EQ(end, kRefused);
  EXPECT_EQ(readExperiment(file).notes, "");
  EXPECT_EQ(std::distance(fs::directory_iterator(m_folder), fs::directory_iterator()), 1)
      << "a half-written file was left";
}

}  // namespace
}  // namespace marey
