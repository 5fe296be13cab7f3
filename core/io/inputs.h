// Which files the words of a command or a document mean, and which of those that lie there are
// none.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/json.h"

namespace marey::io {

/// A file to read.
struct InputFile {
  std::filesystem::path path;
  bool named = true;  ///< by a word or a list, else found in a folder or by a pattern
};

/// A file, folder or link that is not read.
struct NotRead {
  std::filesystem::path path;
  std::string reason;
};

struct Inputs {
  std::vector<InputFile> files;
  std::vector<NotRead> notRead;
  /// Files of other formats in folders, counted by extension: motion formats that are not read, and
  /// all others.
  std::map<std::string, int> otherMotion, others;

  std::vector<std::filesystem::path> paths() const;
  /// One sentence for everything that is not read.
  std::vector<std::string> remarks() const;
  /// Adds "not_read" [{path, reason}] and "other_files" {extension: count} where there are any.
  void addTo(Json& result) const;
};

/// Files of inputs that may be files, folders (their files with the extension or content of a
/// motion format, in name order), patterns (* and ? in the file's name) or @LIST (such inputs, one
/// per line of any encoding, relative to the list's folder; # starts a comment). Relative inputs
/// start at `folder`. What a folder holds besides, a second name of the same file, and links to
/// nothing are not read and named. Throws InputError when an input gives no file, FileError (with
/// the list's line and the nearest name) when one is missing.
Inputs findInputs(const std::vector<std::string>& inputs, const std::filesystem::path& folder = {});

}  // namespace marey::io
