// NumPy's NPY arrays and NPZ archives. Numbers of any type and byte order and text are read.
// Arrays of objects hold pickles: they are named and never opened.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/tensor_file.h"

namespace marey {

/// Text of any rank, row-major, UTF-8; one value where the shape is empty.
struct TextArray {
  std::vector<int64_t> shape;
  std::vector<std::string> values;

  static TextArray one(std::string text) { return {{}, {std::move(text)}}; }
  static TextArray list(std::vector<std::string> texts) {
    const auto count = static_cast<int64_t>(texts.size());
    return {{count}, std::move(texts)};
  }
};

/// What one array holds: numbers, text, or neither (objects, dates, structures, complex numbers).
struct NpyArray {
  std::string type;  ///< for people: "float32", "text", "objects (a pickle, which is not opened)"
  std::vector<int64_t> shape;
  std::optional<Tensor> numbers;  ///< row-major; integers of types that Tensor lacks are widened
  std::optional<TextArray> text;
  size_t bytesUsed = 0;  ///< where the array ends in the file

  std::string summary() const;  ///< "float32 (121, 22, 3)"
};

/// Throws InputError for what is no NPY file, for a cut one, and for numbers beyond 64 bits.
NpyArray parseNpyArray(std::string_view bytes, const std::string& origin);
/// One array of numbers. Throws InputError.
Tensor parseNpy(std::string_view bytes, const std::string& origin);

/// An .npz by name of array (without ".npy", and without a folder that all of them lie in).
struct NpzArrays {
  std::map<std::string, Tensor> numbers;
  std::map<std::string, TextArray> texts;
  std::map<std::string, std::string> others;  ///< what else is there: "objects ... (1)"

  bool contains(const std::string& name) const;
  std::string listing() const;  ///< "author text (), clips float32 (2, 80, 66)"; "none"
};

/// Throws InputError for a damaged archive or array, and for one without any array.
NpzArrays parseNpzArrays(std::string_view bytes, const std::string& origin);
NpzArrays readNpzArrays(const std::filesystem::path& path);
/// The arrays of numbers alone.
std::map<std::string, Tensor> readNpz(const std::filesystem::path& path);

std::string serialiseNpy(const Tensor& tensor);
/// NumPy's text ('<U'), which it reads without allow_pickle. Bytes that are no UTF-8 are written
/// as "\xNN".
std::string serialiseNpy(const TextArray& text);
/// `others` are left out.
void writeNpz(const std::filesystem::path& path, const NpzArrays& arrays);

}  // namespace marey
