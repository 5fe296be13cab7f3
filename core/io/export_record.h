// What every exported clip carries: the caller's recipe, what the clip came from, and the units.
#pragma once

#include "io/format.h"

namespace marey::io {

/// The caller's recipe plus "source" (see sourceJson) and "export" (`details`).
Json exportRecord(const Clip& clip, const WriteOptions& options, const Json& details);
/// path, format, unit, metres_per_unit, up, fps, notes of a clip's source.
Json sourceJson(const Clip& clip);
/// "fit_residual_cm" {joint: RMS over frames}, "fit_residual_max_cm" (over joints and frames) and a
/// sentence that says what they are.
Json fitJson(const FitResidual& fit);
/// PATH.recipe.json
std::filesystem::path recipePath(const std::filesystem::path& path);

}  // namespace marey::io
