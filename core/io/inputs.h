// Which files the words of a command or a document mean.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace marey::io {

/// Files of inputs that may be files, folders (their files of a readable motion format, in name
/// order) or @LIST (one name per line, relative to the list's folder; # starts a comment).
/// Relative inputs start at `folder`. Throws InputError when a list or folder holds none,
/// FileError when one is missing.
std::vector<std::filesystem::path> expandInputs(const std::vector<std::string>& inputs,
                                                const std::filesystem::path& folder = {});

}  // namespace marey::io
