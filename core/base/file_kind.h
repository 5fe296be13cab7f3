// What a file is by its first bytes, whatever its name says: for messages about files that are not
// what was wanted (a Git LFS pointer, a web page saved in place of a download, another format).
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace marey {

/// How many bytes of a file are enough to know it.
inline constexpr size_t kFileHeadBytes = 4096;

struct FileKind {
  std::string id;      ///< short, for lists and counts: "git-lfs", "c3d", "hdf5"
  std::string name;    ///< "a Git LFS pointer in place of the file"
  std::string advice;  ///< what to do about it: "fetch the file with 'git lfs pull'"; may be empty

  /// "NAME (ADVICE)"
  std::string text() const;
};

/// Nothing for content that is not recognised, which may still be text. `head` is the file or its
/// first kFileHeadBytes; an empty one is an empty file.
std::optional<FileKind> fileKind(std::string_view head);

/// For "found ..." in messages: what fileKind says, else "a text that begins with '...'" or "a
/// file that begins with '...'". Printable, one line.
std::string describeContent(std::string_view head);
/// Whether the bytes are those of a text (UTF-8 or another 8-bit encoding, no control characters).
bool looksLikeText(std::string_view head);
/// At most `most` characters of a content in quotes, '?' for what is not printable ASCII.
std::string quotedStart(std::string_view content, size_t most = 40);

}  // namespace marey
