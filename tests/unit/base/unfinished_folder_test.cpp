#include "base/unfinished_folder.h"

#include <fstream>

#include "unit/base/support.h"
#include <gtest/gtest.h>

#include "base/error.h"

namespace marey {
namespace {

namespace fs = std::filesystem;
using test::messageOf;
using test::slurp;
using test::TempFolder;

UnfinishedFolder::Run run(int seed, const std::string& command = "first") {
  return {.identity = {{"seed", seed}}, .notes = {{"command", command}}, .parts = 3};
}

void put(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

/// A run with a file of part 1, as one that was killed leaves it: in the midst of another file.
void breakRun(const fs::path& target) {
  const auto folder = UnfinishedFolder::open(target, run(1), false);
  put(folder.place() / "b.bvh", "b");
  folder.record(1, {{"file", "b.bvh"}});
  put(folder.place() / "c.bvh.partial-77-0", "half");
}

TEST(AnUnfinishedFolder, AppearsOnCommitOnlyAndLeavesNothingOfTheRun) {
  const TempFolder folder;
  const auto out = UnfinishedFolder::open(folder / "out", run(1), false);
  put(out.place() / "a.bvh", "a");
  EXPECT_FALSE(fs::exists(folder / "out"));
  out.commit({"a.bvh"});
  EXPECT_EQ(folder.names().size(), 2u);
  EXPECT_EQ(slurp(folder / "out" / "a.bvh"), "a");
}

TEST(AnUnfinishedFolder, JoinsATargetThatIsThereAndKeepsItsOtherFiles) {
  const TempFolder folder;
  put(folder / "out" / "old.bvh", "old");
  put(folder / "out" / "a.bvh", "old");
  const auto out = UnfinishedFolder::open(folder / "out/", run(1), false);
  put(out.place() / "a.bvh", "new");
  out.commit({"a.bvh"});
  EXPECT_EQ(slurp(folder / "out" / "old.bvh"), "old");
  EXPECT_EQ(slurp(folder / "out" / "a.bvh"), "new");
  EXPECT_EQ(folder.names().size(), 3u);
}

TEST(AnUnfinishedFolder, IsRefusedUnlessItIsToBeResumed) {
  const TempFolder folder;
  breakRun(folder / "out");
  const std::string text =
      messageOf<InputError>([&] { UnfinishedFolder::open(folder / "out", run(1), false); });
  EXPECT_NE(text.find("out.partial"), std::string::npos) << text;
  EXPECT_NE(text.find("parts 0, 2 of 3"), std::string::npos) << text;
  EXPECT_NE(text.find("--resume"), std::string::npos) << text;
  EXPECT_TRUE(fs::exists(folder / "out.partial" / "b.bvh"));
}

TEST(AnUnfinishedFolder, GoesOnWithWhatLacksAndTheNotesOfTheFirstStart) {
  const TempFolder folder;
  breakRun(folder / "out");
  const auto out = UnfinishedFolder::open(folder / "out", run(1, "second"), true);
  EXPECT_EQ(out.missing(), (std::vector<size_t>{0, 2}));
  EXPECT_EQ(out.run().notes["command"], "first");
  EXPECT_EQ(out.recordOf(1)["file"], "b.bvh");
  EXPECT_FALSE(fs::exists(out.place() / "c.bvh.partial-77-0"));
}

TEST(AnUnfinishedFolder, OfAnotherRunIsNotResumed) {
  const TempFolder folder;
  breakRun(folder / "out");
  const std::string text =
      messageOf<InputError>([&] { UnfinishedFolder::open(folder / "out", run(9), true); });
  EXPECT_NE(text.find("'seed': expected 9"), std::string::npos) << text;
  EXPECT_NE(text.find("found 1"), std::string::npos) << text;
  EXPECT_THROW(UnfinishedFolder::open(folder / "other", run(1), true), InputError);
}

TEST(AnUnfinishedFolder, GoesOnWithACommitThatWasBroken) {
  const TempFolder folder;
  put(folder / "out" / "old.bvh", "old");
  const auto out = UnfinishedFolder::open(folder / "out", run(1), false);
  put(out.place() / "b.bvh", "b");
  put(folder / "out" / "a.bvh", "a");  // moved before the commit was broken
  out.commit({"a.bvh", "b.bvh"});
  EXPECT_EQ(slurp(folder / "out" / "a.bvh"), "a");
  EXPECT_EQ(slurp(folder / "out" / "b.bvh"), "b");
}

TEST(AnUnfinishedFolder, MovesNothingWhereAFileHasNoPlace) {
  const TempFolder folder;
  fs::create_directories(folder / "out" / "b.bvh");
  const auto out = UnfinishedFolder::open(folder / "out", run(1), false);
  put(out.place() / "a.bvh", "a");
  put(out.place() / "b.bvh", "b");
  EXPECT_THROW(out.commit({"a.bvh", "b.bvh"}), FileError);
  EXPECT_FALSE(fs::exists(folder / "out" / "a.bvh"));
}

TEST(AnUnfinishedFolder, IsRemovedAfterAFailureOnlyWhereNoPartIsFinished) {
  const TempFolder folder;
  EXPECT_EQ(UnfinishedFolder::open(folder / "none", run(1), false).abandon(), 0u);
  EXPECT_FALSE(fs::exists(folder / "none.partial"));
  breakRun(folder / "out");
  EXPECT_EQ(UnfinishedFolder::open(folder / "out", run(1), true).abandon(), 1u);
  EXPECT_TRUE(fs::exists(folder / "out.partial" / "b.bvh"));
}

TEST(RangesText, JoinsNumbersThatFollowEachOther) {
  EXPECT_EQ(rangesText({}), "");
  EXPECT_EQ(rangesText({0, 1, 2, 5, 7, 8}), "0..2, 5, 7..8");
}

}  // namespace
}  // namespace marey
