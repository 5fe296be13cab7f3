// Values of a NumPy archive as readers want them. Private to the readers of NumPy files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/npy.h"
#include "motion/clip.h"

namespace marey::io {

Place placeOf(const std::string& origin, const std::string& array);
/// Three numbers each.
std::vector<Vec3> vectors(const Tensor& tensor);
/// The rate under any of its usual names. Throws InputError unless it is one positive number.
std::optional<double> rateIn(const NpzArrays& arrays, const std::string& origin);

}  // namespace marey::io
