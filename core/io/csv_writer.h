// Joint positions as comma-separated values for statistics programs: UTF-8, decimal points, a
// header row; units and recipe in PATH.recipe.json.
#pragma once

#include "io/format.h"

namespace marey::io {

/// One row per frame and joint: frame,time_s,joint,x_m,y_m,z_m (frames from 0; the columns are
/// named after another unit where options say so).
std::vector<std::filesystem::path> writeCsvLong(const Clip& clip, const std::filesystem::path& path,
                                                const WriteOptions& options);
/// One row per frame: time,Hips_Xposition,Hips_Yposition,Hips_Zposition,...
std::vector<std::filesystem::path> writeCsvWide(const Clip& clip, const std::filesystem::path& path,
                                                const WriteOptions& options);

}  // namespace marey::io
