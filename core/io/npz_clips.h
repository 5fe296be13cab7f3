// Motion in NumPy files: the field's feature arrays, plain joint positions and Marey's own clips.
//
// The field's `clips` (N, T, 66): per frame 21 joints x (x, y, z) in a frame on the floor that
// faces with the body, then its sideways and forward displacement and turn, in CMU's unit, 20 fps.
// World motion: the pose of a frame is placed by the present rotation and offset; then the turn
// R = Ry(-dyaw) R and the offset += R (dx, 0, dz) lead to the next frame (plot_animation of the
// code of Henter et al. 2020, after Holden et al. 2016).
//
// Marey's: `positions` (T, J, 3) float32, metres, Y up; `fps`; `parents` (J); `offsets` (J, 3);
// `end_site_parents` (E), `end_site_offsets` (E, 3); and as text (NumPy's '<U') `format`, `name`,
// `joint_names` (J), `euler_orders` (J), `source` and `recipe` (JSON). `rotations` (T, J, 4) as w,
// x, y, z and `translations` (T, J, 3) where the clip has them. Text may also be UTF-8 bytes, one
// value per line.
//
// Plain positions (T, J, 3) or (N, T, J, 3) without names, in an .npy or as the only such array of
// an .npz: read where the number of joints is that of SMPL (22, 24), SMPL-H (52) or SMPL-X (55)
// and the values are those of such a body; see joint_arrays.h.
#pragma once

#include "base/npy.h"
#include "io/format.h"

namespace marey::io {

int canReadNpz(std::string_view head);
/// Throws InputError naming the array.
std::vector<Clip> clipsFromArrays(const NpzArrays& arrays, const std::string& origin,
                                  const ReadOptions& options = {});
std::vector<Clip> readNpzClips(std::string_view bytes, const std::filesystem::path& path,
                               const ReadOptions& options);

NpzArrays arraysOfClip(const Clip& clip, const Json& recipe);
std::vector<std::filesystem::path> writeNpzClip(const Clip& clip, const std::filesystem::path& path,
                                                const WriteOptions& options);

}  // namespace marey::io
