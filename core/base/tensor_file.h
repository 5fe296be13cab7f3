// The container of Marey's data sets, models and checkpoints: the safetensors layout
// (8-byte little-endian header length, JSON header, raw row-major tensors), readable by
// any safetensors library and by nothing that executes code. Metadata is one JSON object,
// stored as text under "__metadata__" / "marey".
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/json.h"

namespace marey {

enum class DType { F32, F64, F16, I64, I32, U8 };
size_t byteSize(DType type);
const char* name(DType type);

/// A dense row-major array of any rank.
struct Tensor {
  DType dtype = DType::F32;
  std::vector<int64_t> shape;
  std::vector<std::byte> bytes;

  int64_t count() const;
  std::string shapeText() const;  ///< "(2, 3)"

  static Tensor fromFloats(std::vector<int64_t> shape, const float* values);
  static Tensor fromDoubles(std::vector<int64_t> shape, const double* values);
  static Tensor fromInt64(std::vector<int64_t> shape, const int64_t* values);
  /// Values converted to float or double whatever the stored type.
  std::vector<float> toFloats() const;
  std::vector<double> toDoubles() const;
  std::vector<int64_t> toInt64() const;
  /// The same values stored as another floating-point type.
  Tensor as(DType type) const;
};

struct TensorFile {
  std::map<std::string, Tensor> tensors;
  Json metadata = Json::object();

  /// Throws InputError naming `path` when the tensor is missing or shaped otherwise.
  /// -1 in `shape` matches any size.
  const Tensor& get(const std::string& key, const std::vector<int64_t>& shape,
                    const std::string& path) const;
};

/// Throws FileError or InputError (truncated file, bad header, sizes that do not add up).
TensorFile readTensorFile(const std::filesystem::path& path);
TensorFile parseTensorFile(std::string_view bytes, const std::string& origin);
/// Written atomically. Throws FileError.
void writeTensorFile(const std::filesystem::path& path, const TensorFile& file);
std::string serialise(const TensorFile& file);
/// Hash of what `serialise` gives, without holding it.
std::string contentHash(const TensorFile& file);

}  // namespace marey
