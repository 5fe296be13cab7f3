// What a tensor file says of itself, without its tensors, which may take hundreds of megabytes.
#pragma once

#include <filesystem>

#include "base/json.h"

namespace marey {

/// TensorFile::metadata of a file. Throws FileError or InputError.
Json readTensorMetadata(const std::filesystem::path& path);

}  // namespace marey
