#include "base/archive.h"

#include <memory>
#include <string_view>

#include <zip.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_kind.h"

namespace marey {
namespace {

using Zip = std::unique_ptr<zip_t, void (*)(zip_t*)>;
using ZipFile = std::unique_ptr<zip_file_t, int (*)(zip_file_t*)>;

struct ZipErrorText {
  zip_error_t error{};
  ZipErrorText() { zip_error_init(&error); }
  ~ZipErrorText() { zip_error_fini(&error); }
  ZipErrorText(const ZipErrorText&) = delete;
  ZipErrorText& operator=(const ZipErrorText&) = delete;
  std::string text() { return zip_error_strerror(&error); }
};

std::string readEntry(zip_t* archive, zip_uint64_t index, const zip_stat_t& stat,
                      const Place& place) {
  ZipFile file(zip_fopen_index(archive, index, 0), zip_fclose);
  if (!file) throw InputError(place, "a readable entry", zip_strerror(archive));
  std::string content(stat.size, '\0');
  size_t done = 0;
  while (done < content.size()) {
    const auto got = zip_fread(file.get(), content.data() + done, content.size() - done);
    if (got <= 0)
      throwInput(place, fmt::format("{} bytes", stat.size), "{} (damaged archive)", done);
    done += static_cast<size_t>(got);
  }
  // The checksum is compared where the end is read.
  char beyond = 0;
  if (zip_fread(file.get(), &beyond, 1) != 0)
    throw InputError(place, "an undamaged entry", zip_file_strerror(file.get()));
  return content;
}

/// NPZ files and checkpoints are stored or deflated. Deflate shrinks to 1/1032 at best, so an
/// entry that claims more lies about its size.
void checkEntry(const zip_stat_t& stat, size_t allowed, const Place& place) {
  constexpr zip_uint64_t kNeeded =
      ZIP_STAT_NAME | ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_COMP_METHOD;
  if ((stat.valid & kNeeded) != kNeeded) throw InputError(place, "an entry with a size", "none");
  if (stat.comp_method != ZIP_CM_STORE && stat.comp_method != ZIP_CM_DEFLATE)
    throwInput(place, "a stored or deflated entry (as numpy.savez and torch.save write)",
               "compression method {}", stat.comp_method);
  if (stat.size > allowed)
    throwInput(place, fmt::format("at most {} bytes unpacked", allowed), "{}", stat.size);
  if (stat.size / 1032 > stat.comp_size + 1)
    throwInput(place, fmt::format("at most {} bytes", (stat.comp_size + 2) * 1032), "{} (damaged)",
               stat.size);
}

}  // namespace

std::map<std::string, std::string> parseArchive(std::string_view bytes, const std::string& origin,
                                                size_t maxBytes) {
  const bool zip = bytes.starts_with("PK");
  if (!zip) throw InputError({.path = origin}, "a zip archive", describeContent(bytes));
  ZipErrorText error;
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error.error);
  if (source == nullptr) throw InputError({.path = origin}, "a zip archive", error.text());
  Zip archive(zip_open_from_source(source, ZIP_RDONLY | ZIP_CHECKCONS, &error.error), zip_discard);
  if (!archive) {
    zip_source_free(source);
    const int code = zip_error_code_zip(&error.error);
    if (code == ZIP_ER_EXISTS)
      throw InputError({.path = origin}, "a zip archive with every name once", "a name twice");
    // "Not a zip archive" is what libzip says of one whose end is missing.
    throw InputError({.path = origin}, "a whole zip archive",
                     "one that is damaged or cut (an incomplete download?)" +
                         (code == ZIP_ER_NOZIP ? "" : ": " + error.text()));
  }
  std::map<std::string, std::string> out;
  size_t total = 0;
  const zip_int64_t count = zip_get_num_entries(archive.get(), 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    zip_stat_t stat;
    const Place place{.path = origin, .item = fmt::format("entry {}", i)};
    if (zip_stat_index(archive.get(), static_cast<zip_uint64_t>(i), 0, &stat) != 0)
      throw InputError(place, "an entry", zip_strerror(archive.get()));
    checkEntry(stat, maxBytes - total, place);
    total += stat.size;
    out[stat.name] = readEntry(archive.get(), static_cast<zip_uint64_t>(i), stat, place);
  }
  return out;
}

void writeArchive(const std::filesystem::path& path,
                  const std::map<std::string, std::string>& files, bool compress) {
  ZipErrorText error;
  zip_source_t* sink = zip_source_buffer_create(nullptr, 0, 0, &error.error);
  if (sink == nullptr) throw FileError(fmt::format("{}: {}", path.string(), error.text()));
  zip_source_keep(sink);
  const std::unique_ptr<zip_source_t, void (*)(zip_source_t*)> guard(sink, zip_source_free);
  Zip archive(zip_open_from_source(sink, ZIP_TRUNCATE, &error.error), zip_discard);
  if (!archive) throw FileError(fmt::format("{}: {}", path.string(), error.text()));
  for (const auto& [name, content] : files) {
    zip_source_t* source = zip_source_buffer(archive.get(), content.data(), content.size(), 0);
    const zip_int64_t index = zip_file_add(archive.get(), name.c_str(), source, ZIP_FL_ENC_UTF_8);
    if (index < 0) {
      zip_source_free(source);
      throw FileError(fmt::format("{}: {}", path.string(), zip_strerror(archive.get())));
    }
    zip_set_file_compression(archive.get(), static_cast<zip_uint64_t>(index),
                             compress ? ZIP_CM_DEFLATE : ZIP_CM_STORE, 0);
    // A fixed local date (1980-01-01): the same content gives the same file in every time zone.
    zip_file_set_dostime(archive.get(), static_cast<zip_uint64_t>(index), 0, 0x21, 0);
  }
  if (zip_close(archive.get()) != 0)
    throw FileError(fmt::format("{}: {}", path.string(), zip_strerror(archive.get())));
  (void)archive.release();  // closed
  zip_stat_t stat;
  zip_source_stat(sink, &stat);
  std::string bytes(stat.size, '\0');
  zip_source_open(sink);
  zip_source_read(sink, bytes.data(), bytes.size());
  zip_source_close(sink);
  writeFileAtomically(path, bytes);
}

}  // namespace marey
