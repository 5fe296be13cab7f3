// Motion files in and out, whatever their format.
#pragma once

#include "io/format.h"

namespace marey::io {

/// Every clip of a file, in metres and Y up; the format is found by content, not by name. The
/// labels that lie beside the file of one clip are read with it (annotation_files.h). Throws
/// FileError or InputError (with line or frame).
std::vector<Clip> readClips(const std::filesystem::path& path, const ReadOptions& options = {});
/// The only clip of a file. Throws InputError when the file holds several.
Clip readClip(const std::filesystem::path& path, const ReadOptions& options = {});

/// The format that can read these first bytes of a file, or null.
const ClipFormat* formatOfContent(std::string_view head);
/// The format of that name. Throws UsageError naming the formats there are.
const ClipFormat& formatByName(const std::string& name);
/// Whether a file has the extension and the first bytes of a motion format.
bool isMotionFile(const std::filesystem::path& path);
/// Whether the name has the extension of a format that is read.
bool hasReadableExtension(const std::filesystem::path& path);
/// Whether an extension (lower case, without its dot) or the id of a FileKind is that of a motion
/// format that is not read: "c3d", "fbx", "trc", ...
bool isUnreadMotion(std::string_view format);
/// First bytes of a file, as formatOfContent wants them. Throws FileError.
std::string readHead(const std::filesystem::path& path);

/// Writes a clip in options.format, else the format of the path's extension. Formats that hold
/// rotations get them from fitSkeleton where the clip has none; the recipe then holds the residual
/// under "fit" (see fitJson).
/// Throws UsageError (unknown format or extension), InputError or FileError.
WrittenClip writeClip(const Clip& clip, const std::filesystem::path& path,
                      const WriteOptions& options = {});

}  // namespace marey::io
