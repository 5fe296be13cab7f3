// glTF 2.0 (Khronos Group; ISO/IEC 12113:2022): an animated skeleton that Blender, game engines
// and web viewers open, with a plain body so that it can be seen.
#pragma once

#include "io/format.h"

namespace marey::io {

/// A node per joint (at rest: the skeleton's offsets, no rotation), a skin of the bones of
/// boneMesh, and one animation: rotations of every joint, translations of the root and of joints
/// whose place in their parent changes; linear between frames, seconds from 0. Metres and Y up, as
/// the format has it. The recipe is asset.extras.recipe. Written atomically. Throws UsageError for
/// another unit or axis, InputError for a clip without rotations or too large for the format.
/// This one is text with its buffer inside.
std::vector<std::filesystem::path> writeGltf(const Clip& clip, const std::filesystem::path& path,
                                             const WriteOptions& options);
/// The same as one binary file.
std::vector<std::filesystem::path> writeGlb(const Clip& clip, const std::filesystem::path& path,
                                            const WriteOptions& options);

}  // namespace marey::io
