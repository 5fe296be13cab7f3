// NumPy's NPY arrays and NPZ archives. Object arrays are refused: they hold pickles.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "base/tensor_file.h"

namespace marey {

/// One array; Fortran order is turned into row-major. Throws InputError.
Tensor parseNpy(std::string_view bytes, const std::string& origin);
/// All arrays of an .npz by name (without ".npy"). Entries that are no NPY are refused.
std::map<std::string, Tensor> readNpz(const std::filesystem::path& path);
std::map<std::string, Tensor> parseNpz(std::string_view bytes, const std::string& origin);
std::string serialiseNpy(const Tensor& tensor);
void writeNpz(const std::filesystem::path& path, const std::map<std::string, Tensor>& arrays);

/// Text as a U8 array and back, for names and recipes inside an .npz.
Tensor textTensor(std::string_view text);
std::string tensorText(const Tensor& tensor);

}  // namespace marey
