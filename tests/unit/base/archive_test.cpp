#include "base/archive.h"

#include <cstring>

#include "unit/base/support.h"
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "base/error.h"

namespace marey {
namespace {

using test::messageOf;
using test::slurp;
using test::TempFolder;
using Files = std::map<std::string, std::string>;

std::string archiveOf(const Files& files, bool compress) {
  const TempFolder folder;
  writeArchive(folder / "a.zip", files, compress);
  return slurp(folder / "a.zip");
}

const Files kFiles{{"empty", ""},
                   {"folder/b.bin", std::string("\0\x01\xff", 3)},
                   {"c.txt", std::string(5000, 'c')}};

TEST(Archive, ReturnsWhatWasWrittenStoredAndDeflated) {
  EXPECT_EQ(parseArchive(archiveOf(kFiles, true), "a.zip"), kFiles);
  EXPECT_EQ(parseArchive(archiveOf(kFiles, false), "a.zip"), kFiles);
  EXPECT_LT(archiveOf(kFiles, true).size(), archiveOf(kFiles, false).size());
}

TEST(Archive, IsReadByAndFromPython) {
  MAREY_NEED_PYTHON("zipfile");
  const TempFolder folder;
  writeArchive(folder / "ours.zip", kFiles);
  ASSERT_TRUE(test::runPython(folder.path(), R"(
import zipfile
with zipfile.ZipFile('ours.zip') as z:
    assert z.testzip() is None
    assert z.read('folder/b.bin') == b'\0\x01\xff'
    assert z.getinfo('c.txt').date_time == (1980, 1, 1, 0, 0, 0)
with zipfile.ZipFile('theirs.zip', 'w', zipfile.ZIP_DEFLATED) as z:
    z.writestr('x', b'y' * 100000)
with zipfile.ZipFile('lzma.zip', 'w', zipfile.ZIP_LZMA) as z:
    z.writestr('x', b'y' * 100000)
)")) << slurp(folder / "python.log");
  EXPECT_EQ(parseArchive(slurp(folder / "theirs.zip"), "theirs.zip"),
            (Files{{"x", std::string(100'000, 'y')}}));
  EXPECT_THROW(parseArchive(slurp(folder / "lzma.zip"), "lzma.zip"), InputError);
}

TEST(Archive, OfTheSameContentIsTheSameInEveryTimeZone) {
  const std::string here = archiveOf(kFiles, true);
  const char* old = std::getenv("TZ");
  const std::string kept = old == nullptr ? "" : old;
  ::setenv("TZ", "America/New_York", 1);
  ::tzset();
  const std::string there = archiveOf(kFiles, true);
  if (old == nullptr)
    ::unsetenv("TZ");
  else
    ::setenv("TZ", kept.c_str(), 1);
  ::tzset();
  EXPECT_EQ(here, there);
}

TEST(Archive, CutAtAnyLengthIsRefused) {
  const std::string bytes = archiveOf({{"a", "12345"}, {"b", "678"}}, false);
  for (size_t length = 0; length < bytes.size(); ++length)
    EXPECT_THROW(parseArchive(bytes.substr(0, length), "a.zip"), InputError) << length;
}

TEST(Archive, WithAChangedByteInAnEntryIsRefused) {
  std::string bytes = archiveOf({{"a", std::string(64, 'a')}}, false);
  bytes[bytes.find("aaaa") + 9] = 'b';
  EXPECT_THROW(parseArchive(bytes, "a.zip"), InputError);
}

TEST(Archive, BeyondTheLimitIsRefusedBeforeItIsUnpacked) {
  const std::string bytes =
      archiveOf({{"a", std::string(600, 'a')}, {"b", std::string(600, 'b')}}, true);
  EXPECT_NO_THROW(parseArchive(bytes, "a.zip", 1200));
  const auto message = messageOf<InputError>([&] { parseArchive(bytes, "a.zip", 1199); });
  EXPECT_NE(message.find("a.zip, entry 1: expected at most 599 bytes"), std::string::npos)
      << message;
}

TEST(Archive, ThatClaimsMoreThanDeflateCanHoldIsRefused) {
  std::string bytes = archiveOf({{"a", std::string(1000, 'a')}}, true);
  // The unpacked size stands at offset 22 of the local and 24 of the central header.
  const uint32_t claimed = 3'000'000'000u;
  std::memcpy(bytes.data() + bytes.find("PK\x03\x04") + 22, &claimed, 4);
  std::memcpy(bytes.data() + bytes.find("PK\x01\x02") + 24, &claimed, 4);
  EXPECT_THROW(parseArchive(bytes, "a.zip"), InputError);
}

TEST(Archive, ThatIsNoneNamesTheFile) {
  const auto message = messageOf<InputError>([] { parseArchive("hello", "walk.npz"); });
  EXPECT_TRUE(message.starts_with("walk.npz: expected a zip archive")) << message;
}

}  // namespace
}  // namespace marey
