#include "base/atomic_file.h"

#include <fstream>
#include <thread>

#include "unit/base/support.h"
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "base/error.h"

namespace marey {
namespace {

namespace fs = std::filesystem;
using test::messageOf;
using test::slurp;
using test::TempFolder;

/// Writes beyond `bytes` fail, as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &m_old);
    m_handler = ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, m_old.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &m_old);
    ::signal(SIGXFSZ, m_handler);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit m_old{};
  sighandler_t m_handler = nullptr;
};

TEST(AtomicFile, ReplacesTheOldContentAndCreatesFolders) {
  const TempFolder folder;
  writeFileAtomically(folder / "a/b/c.txt", "first");
  writeFileAtomically(folder / "a/b/c.txt", "second");
  EXPECT_EQ(slurp(folder / "a/b/c.txt"), "second");
  EXPECT_EQ(folder.names().size(), 3u);  // a, a/b, a/b/c.txt: nothing left over
}

TEST(AtomicFile, LeavesTheOldFileWhenTheWriterThrows) {
  const TempFolder folder;
  writeFileAtomically(folder / "c.txt", "old");
  const auto write = [](std::ostream& out) {
    out << "half of the new";
    throw InputError("broken");
  };
  EXPECT_THROW(writeFileAtomically(folder / "c.txt", write), InputError);
  EXPECT_EQ(slurp(folder / "c.txt"), "old");
  EXPECT_EQ(folder.names().size(), 1u);
}

TEST(AtomicFile, LeavesTheOldFileWhenTheDiskIsFull) {
  const TempFolder folder;
  writeFileAtomically(folder / "c.txt", "old");
  const std::string large(1 << 20, 'x');
  std::string message;
  {
    const FileSizeLimit limit(1 << 16);
    message = messageOf<FileError>([&] { writeFileAtomically(folder / "c.txt", large); });
  }
  EXPECT_NE(message.find("c.txt: cannot write: File too large"), std::string::npos) << message;
  EXPECT_EQ(slurp(folder / "c.txt"), "old");
  EXPECT_EQ(folder.names().size(), 1u);
}

TEST(AtomicFile, LeavesNoFileWhereThereWasNone) {
  const TempFolder folder;
  const auto write = [](std::ostream&) { throw FileError("nothing to write"); };
  EXPECT_THROW(writeFileAtomically(folder / "new.txt", write), FileError);
  EXPECT_TRUE(folder.names().empty());
}

TEST(AtomicFile, NamesThePathThatCannotBeWritten) {
  const TempFolder folder;
  writeFileAtomically(folder / "file", "x");
  const auto message =
      messageOf<FileError>([&] { writeFileAtomically(folder / "file/below.txt", "x"); });
  EXPECT_NE(message.find((folder / "file").string()), std::string::npos) << message;
  fs::create_directory(folder / "taken");
  EXPECT_THROW(writeFileAtomically(folder / "taken", "x"), FileError);
  EXPECT_TRUE(fs::is_directory(folder / "taken"));
}

TEST(AtomicFile, ShowsReadersTheOldOrTheNewContentOnly) {
  const TempFolder folder;
  const auto path = folder / "c.txt";
  const std::string a(100'000, 'a'), b(100'000, 'b');
  writeFileAtomically(path, a);
  std::jthread writer([&] {
    for (int i = 0; i < 50; ++i) writeFileAtomically(path, i % 2 == 0 ? b : a);
  });
  for (int i = 0; i < 200; ++i) {
    const std::string seen = readFile(path);
    ASSERT_TRUE(seen == a || seen == b) << seen.size();
  }
}

TEST(ReadFile, ReadsEveryByteOfFilesAndPipes) {
  const TempFolder folder;
  std::string content(300'000, '\0');
  for (size_t i = 0; i < content.size(); ++i) content[i] = static_cast<char>(i * 7);
  writeFileAtomically(folder / "f", content);
  EXPECT_EQ(readFile(folder / "f"), content);
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::jthread writer([&] { std::ofstream(folder / "pipe", std::ios::binary) << content; });
  EXPECT_EQ(readFile(folder / "pipe"), content);
}

TEST(ReadFile, TellsAboutMissingFilesFoldersAndLimits) {
  const TempFolder folder;
  EXPECT_NE(messageOf<FileError>([&] { readFile(folder / "none"); }).find("No such file"),
            std::string::npos);
  EXPECT_NE(messageOf<FileError>([&] { readFile(folder.path()); }).find("found a folder"),
            std::string::npos);
  writeFileAtomically(folder / "f", "12345");
  EXPECT_EQ(readFile(folder / "f", 5), "12345");
  EXPECT_THROW(readFile(folder / "f", 4), FileError);
  EXPECT_THROW(readFile("/dev/zero", 1 << 20), FileError);
  writeFileAtomically(folder / "empty", "");
  EXPECT_EQ(readFile(folder / "empty"), "");
}

TEST(StagedFolderOfFiles, AppearsOnCommitOnly) {
  const TempFolder folder;
  {
    StagedFolder staged(folder / "out");
    writeFileAtomically(staged.path() / "sub/a.txt", "a");
    EXPECT_FALSE(fs::exists(folder / "out"));
    staged.commit();
    EXPECT_EQ(slurp(folder / "out/sub/a.txt"), "a");
  }
  EXPECT_EQ(folder.names().size(), 3u);
}

TEST(StagedFolderOfFiles, LeavesNothingWithoutACommit) {
  const TempFolder folder;
  {
    const StagedFolder staged(folder / "out");
    writeFileAtomically(staged.path() / "a.txt", "a");
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(StagedFolderOfFiles, ReplacesFilesOfTheSameNameAndKeepsOthers) {
  const TempFolder folder;
  writeFileAtomically(folder / "out/same.txt", "old");
  writeFileAtomically(folder / "out/sub/other.txt", "kept");
  StagedFolder staged(folder.path() / "out/");
  writeFileAtomically(staged.path() / "same.txt", "new");
  writeFileAtomically(staged.path() / "sub/added.txt", "added");
  staged.commit();
  EXPECT_EQ(slurp(folder / "out/same.txt"), "new");
  EXPECT_EQ(slurp(folder / "out/sub/other.txt"), "kept");
  EXPECT_EQ(slurp(folder / "out/sub/added.txt"), "added");
}

TEST(StagedFolderOfFiles, StagesInsideATargetThatIsThere) {
  const TempFolder folder;
  fs::create_directory(folder / "home");
  {
    StagedFolder staged(folder / "home");
    // The parent may be closed to the user, or another file system.
    EXPECT_EQ(staged.path().parent_path(), folder / "home");
    writeFileAtomically(staged.path() / "a.txt", "a");
    staged.commit();
  }
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"home", "home/a.txt"}));
}

TEST(StagedFolderOfFiles, MovesNothingWhereOneFileHasNoPlace) {
  const TempFolder folder;
  writeFileAtomically(folder / "out/a.txt", "old");
  fs::create_directory(folder / "out/b.txt");
  {
    StagedFolder staged(folder / "out");
    writeFileAtomically(staged.path() / "a.txt", "new");
    writeFileAtomically(staged.path() / "b.txt", "new");
    EXPECT_NE(messageOf<FileError>([&] { staged.commit(); }).find("b.txt"), std::string::npos);
  }
  EXPECT_EQ(slurp(folder / "out/a.txt"), "old");
  EXPECT_EQ(folder.names().size(), 3U);
}

TEST(StagedFolderOfFiles, RefusesAFileAsTargetBeforeAnyWork) {
  const TempFolder folder;
  writeFileAtomically(folder / "out", "a file");
  EXPECT_THROW(StagedFolder{folder / "out"}, FileError);
  EXPECT_EQ(slurp(folder / "out"), "a file");
}

}  // namespace
}  // namespace marey
