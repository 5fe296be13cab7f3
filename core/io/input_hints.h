// What somebody meant by the name of a file that is not there.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace marey::io {

/// A name as another system writes it: in quotes, or with backslashes between folders. Nothing
/// unless the file is there.
std::optional<std::filesystem::path> otherSpelling(const std::filesystem::path& folder,
                                                   const std::string& name);
/// " (did you mean OTHER?)" for a file of the same name with an extension or in other letters, in
/// the name's folder, in `folder`, below it or beside it; else empty. OTHER is relative to
/// `folder`.
std::string nearestName(const std::filesystem::path& folder, const std::string& name);

}  // namespace marey::io
