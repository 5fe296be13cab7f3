#include "io/inputs.h"

#include <map>

#include "unit/io/support.h"

#include "base/atomic_file.h"

namespace marey::io {
namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;

const char* const kBvh = "HIERARCHY\nROOT a\n{\n}\n";

Paths filesOf(const std::vector<std::string>& inputs) {
  return findInputs(inputs).paths();
}

TEST(Inputs, AFolderGivesItsMotionFilesInNameOrder) {
  const test::TemporaryFolder folder;
  for (const char* name : {"b.bvh", "a.BVH", "c.bvh"}) writeFileAtomically(folder / name, kBvh);
  writeFileAtomically(folder / "notes.txt", "hello");
  writeFileAtomically(folder / "b.bvh.recipe.json", "{}");
  EXPECT_EQ(filesOf({folder.path().string()}),
            (Paths{folder / "a.BVH", folder / "b.bvh", folder / "c.bvh"}));
}

TEST(Inputs, AListGivesItsNamesRelativeToItsOwnFolder) {
  const test::TemporaryFolder folder;
  for (const char* name : {"x.bvh", "y.bvh"}) writeFileAtomically(folder / name, kBvh);
  writeFileAtomically(folder / "list.txt", "# two clips\r\ny.bvh\r\n\n  x.bvh  ");
  EXPECT_EQ(filesOf({"@" + (folder / "list.txt").string()}),
            (Paths{folder / "y.bvh", folder / "x.bvh"}));
}

TEST(Inputs, FilesStayInTheOrderGiven) {
  const test::TemporaryFolder folder;
  for (const char* name : {"x.bvh", "y.bvh"}) writeFileAtomically(folder / name, kBvh);
  EXPECT_EQ(filesOf({(folder / "y.bvh").string(), (folder / "x.bvh").string()}),
            (Paths{folder / "y.bvh", folder / "x.bvh"}));
}

TEST(Inputs, EmptyFoldersListsAndMissingFilesAreRefused) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(filesOf({folder.path().string()}), InputError);
  writeFileAtomically(folder / "empty.txt", "# nothing\n\n");
  EXPECT_THROW(filesOf({"@" + (folder / "empty.txt").string()}), InputError);
  EXPECT_THROW(filesOf({}), InputError);
  EXPECT_THROW(filesOf({(folder / "missing.bvh").string()}), FileError);
  EXPECT_THROW(filesOf({"@" + (folder / "missing.txt").string()}), FileError);
  writeFileAtomically(folder / "list.txt", "a\n");
  try {
    filesOf({"@" + (folder / "list.txt").string()});
    FAIL() << "expected an error";
  } catch (const FileError& e) {
    test::expectContains(e.what(), "list.txt:1");
  }
}

TEST(Inputs, WhatAFolderHoldsBesidesIsNamedOrCounted) {
  const test::TemporaryFolder folder;
  writeFileAtomically(folder / "b.bvh", kBvh);
  writeFileAtomically(folder / "empty.bvh", "");
  writeFileAtomically(folder / "markers.c3d", std::string("\2P") + std::string(100, '\0'));
  writeFileAtomically(folder / "notes.txt", "hello");
  fs::create_directories(folder / "more");
  writeFileAtomically(folder / "more" / "c.bvh", kBvh);
  fs::create_directories(folder / "pictures");
  fs::create_symlink("b.bvh", folder / "a.bvh");
  fs::create_hard_link(folder / "b.bvh", folder / "c.bvh");
  fs::create_symlink("nothing.bvh", folder / "d.bvh");
  const Inputs found = findInputs({folder.path().string()});
  ASSERT_EQ(found.files.size(), 1u);
  EXPECT_EQ(found.files[0].path, folder / "b.bvh");
  EXPECT_FALSE(found.files[0].named);
  std::map<std::string, std::string> reasons;
  for (const NotRead& one : found.notRead) reasons[one.path.filename().string()] = one.reason;
  EXPECT_EQ(reasons.size(), 5u);
  test::expectContains(reasons["empty.bvh"], "empty");
  test::expectContains(reasons["a.bvh"], "b.bvh");
  test::expectContains(reasons["c.bvh"], "b.bvh");
  test::expectContains(reasons["d.bvh"], "nothing");
  test::expectContains(reasons["more"], "1 motion file");
  EXPECT_EQ(found.otherMotion, (std::map<std::string, int>{{"c3d", 1}}));
  EXPECT_EQ(found.others, (std::map<std::string, int>{{"txt", 1}}));
}

TEST(Inputs, PatternsQuotesAndOtherSeparatorsOfListsAreUnderstood) {
  const test::TemporaryFolder folder;
  fs::create_directories(folder / "data");
  for (const char* name : {"x 1.bvh", "x2.bvh", "y.bvh"})
    writeFileAtomically(folder / "data" / name, kBvh);
  const auto listed = [&](const std::string& line) {
    writeFileAtomically(folder / "list.txt", line);
    return filesOf({"@" + (folder / "list.txt").string()});
  };
  EXPECT_EQ(listed("data/x*.bvh"), (Paths{folder / "data/x 1.bvh", folder / "data/x2.bvh"}));
  EXPECT_EQ(listed("\"data/x 1.bvh\"\n"), (Paths{folder / "data/x 1.bvh"}));
  EXPECT_EQ(listed("data\\y.bvh\r"), (Paths{folder / "data/y.bvh"}));
  EXPECT_EQ(listed("data").size(), 3u);
  EXPECT_EQ(listed("data/y.bvh\ndata/y.bvh").size(), 1u);
  EXPECT_THROW(listed("data/z*.bvh"), InputError);
  for (const char* near : {"data/Y.BVH", "data/y", "y.bvh"}) try {
      listed(near);
      FAIL() << near;
    } catch (const FileError& e) {
      test::expectContains(e.what(), "did you mean data/y.bvh?");
    }
}

}  // namespace
}  // namespace marey::io
