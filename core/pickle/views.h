// Copies strided tensors out of the storages of a PyTorch checkpoint. Private to its reader.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>

#include "pickle/machine.h"

namespace marey::pickle {

/// storage key -> raw bytes, with what the whole file holds.
struct Storages {
  std::unordered_map<std::string, std::string_view> bytes;
  uint64_t totalBytes = 0;
};

/// Copies views and bounds what that makes of the file: expanded and shared views may unfold to
/// four times its storages and 64 MiB, so that a small file cannot claim the memory of the
/// machine.
class TensorReader {
 public:
  TensorReader(const Storages& storages, std::string origin);

  /// The number of elements. Throws InputError unless the view lies within its storage.
  uint64_t check(const View& view, const std::string& path) const;
  /// A row-major copy. Throws InputError.
  Tensor read(const View& view, const std::string& path);

 private:
  Place place(const std::string& path) const;
  std::string_view storageBytes(const Storage& storage, const std::string& path) const;
  [[noreturn]] void refuseBeyond(const View& view, const std::string& path) const;

  const Storages& m_storages;
  uint64_t m_budget;
  std::string m_origin;
};

}  // namespace marey::pickle
