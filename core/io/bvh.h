// Biovision hierarchies: text with a tree of joints, channels in any order per joint, degrees,
// and a row of numbers per frame. The format states no unit.
#pragma once

#include "io/format.h"

namespace marey::io {

int canReadBvh(std::string_view head);
/// A clip for every ROOT that is a body (one with at most a quarter of the joints of the largest is
/// a prop: left out and noted), named after the file and, where there are several, the root. Files
/// that were put together give the clips of each. `origin` names the bytes in errors.
///
/// Nothing is tied to lines, but see readBvhMotion. Position channels replace the joint's offset;
/// rotation channels turn in the order listed. What is read though it is not quite as the format
/// has it is noted: line ends and encodings (PlainText), remarks, text before and after, frame
/// counts, frame times rounded in the file (snapped to the common rate they stand for), repeated
/// joint names (numbered), joints whose offsets are zero. Throws InputError with the line.
std::vector<Clip> parseBvhClips(std::string_view bytes, const std::string& origin,
                                const ReadOptions& options = {});
/// The only clip. Throws InputError, also where there are several.
Clip parseBvh(std::string_view bytes, const std::string& origin, const ReadOptions& options = {});
std::vector<Clip> readBvh(std::string_view bytes, const std::filesystem::path& path,
                          const ReadOptions& options);

/// Degrees, centimetres unless options.unit says otherwise. Rotations are unwrapped. The
/// recipe goes to PATH.recipe.json. Throws InputError (also for a clip without rotations, which
/// writeClip fits) or FileError.
std::vector<std::filesystem::path> writeBvh(const Clip& clip, const std::filesystem::path& path,
                                            const WriteOptions& options);

/// The rate that a written frame time stands for: 1 / time where that is whole, else the common
/// rate whose frame time, rounded or cut to the digits written, is the text. `text` is a positive
/// number (checked by the caller).
struct SnappedRate {
  double fps = 0.0;
  bool snapped = false;
};
SnappedRate rateOfFrameTime(std::string_view text);

}  // namespace marey::io
