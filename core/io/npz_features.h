// The field's `clips` (N, T, 66); see npz_clips.h. Private to the reader of NPZ archives.
#pragma once

#include "io/format.h"
#include "io/npz_values.h"

namespace marey::io {

/// Throws InputError naming clip, frame and joint.
std::vector<Clip> featureClips(const NpzArrays& arrays, const std::string& origin,
                               const ReadOptions& options);

}  // namespace marey::io
