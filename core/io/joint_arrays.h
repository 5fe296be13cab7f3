// Joint positions in a NumPy array that names no joint: (frames, joints, 3), or (clips, frames,
// joints, 3). Read where the number of joints is that of SMPL (22 or 24), SMPL-H (52) or SMPL-X
// (55), whose order is then taken, and where the bones of the legs and arms keep their lengths and
// are the same on both sides, as positions have it and rotations have not. Unit and up axis are
// guessed from the body; 20 frames per second, the habit of these files, unless a rate is given.
#pragma once

#include <optional>

#include "base/npy.h"
#include "io/format.h"

namespace marey::io {

int canReadNpy(std::string_view head);
std::vector<Clip> readNpyClips(std::string_view bytes, const std::filesystem::path& path,
                               const ReadOptions& options);

/// Whether an array may hold them, by its shape.
bool hasShapeOfJoints(const Tensor& tensor);
/// Throws InputError, naming the clip's number where there are several.
std::vector<Clip> jointClips(const Tensor& tensor, const std::string& origin,
                             std::optional<double> fps, const ReadOptions& options);
/// What an array of this shape may be: "joint positions of 21 joints that are not named".
std::string meaningOfShape(const std::vector<int64_t>& shape);

/// The keys of an NPZ that is read, for messages.
inline constexpr const char* kReadKeys =
    "positions (frames, joints, 3), fps, parents, offsets and joint_names of a clip, or clips "
    "(clips, frames, 66) of features";

}  // namespace marey::io
