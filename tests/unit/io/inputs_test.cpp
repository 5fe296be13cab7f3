#include "io/inputs.h"

#include "unit/io/support.h"

#include "base/atomic_file.h"

namespace marey::io {
namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;

const char* const kBvh = "HIERARCHY\nROOT a\n{\n}\n";

TEST(Inputs, AFolderGivesItsMotionFilesInNameOrder) {
  const test::TemporaryFolder folder;
  for (const char* name : {"b.bvh", "a.BVH", "c.bvh"}) writeFileAtomically(folder / name, kBvh);
  writeFileAtomically(folder / "notes.txt", "hello");
  writeFileAtomically(folder / "b.bvh.recipe.json", "{}");
  EXPECT_EQ(expandInputs({folder.path().string()}),
            (Paths{folder / "a.BVH", folder / "b.bvh", folder / "c.bvh"}));
}

TEST(Inputs, AListGivesItsNamesRelativeToItsOwnFolder) {
  const test::TemporaryFolder folder;
  for (const char* name : {"x.bvh", "y.bvh"}) writeFileAtomically(folder / name, kBvh);
  writeFileAtomically(folder / "list.txt", "# two clips\r\ny.bvh\r\n\n  x.bvh  ");
  EXPECT_EQ(expandInputs({"@" + (folder / "list.txt").string()}),
            (Paths{folder / "y.bvh", folder / "x.bvh"}));
}

TEST(Inputs, FilesStayInTheOrderGiven) {
  const test::TemporaryFolder folder;
  for (const char* name : {"x.bvh", "y.bvh"}) writeFileAtomically(folder / name, kBvh);
  EXPECT_EQ(expandInputs({(folder / "y.bvh").string(), (folder / "x.bvh").string()}),
            (Paths{folder / "y.bvh", folder / "x.bvh"}));
}

TEST(Inputs, EmptyFoldersListsAndMissingFilesAreRefused) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(expandInputs({folder.path().string()}), InputError);
  writeFileAtomically(folder / "empty.txt", "# nothing\n\n");
  EXPECT_THROW(expandInputs({"@" + (folder / "empty.txt").string()}), InputError);
  EXPECT_THROW(expandInputs({}), InputError);
  EXPECT_THROW(expandInputs({(folder / "missing.bvh").string()}), FileError);
  EXPECT_THROW(expandInputs({"@" + (folder / "missing.txt").string()}), FileError);
  writeFileAtomically(folder / "list.txt", "a\n");
  try {
    expandInputs({"@" + (folder / "list.txt").string()});
    FAIL() << "expected an error";
  } catch (const FileError& e) {
    test::expectContains(e.what(), "list.txt:1");
  }
}

}  // namespace
}  // namespace marey::io
