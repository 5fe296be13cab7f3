// The header of an NPY array: type, order and shape of what follows. Private to the reader.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace marey {

struct NpyHeader {
  /// NumPy's letter: f, i, u, b numbers, U and S text, O objects, M and m times, c complex; V also
  /// for structures.
  char kind = 'V';
  size_t itemBytes = 0;  ///< of one value; 0 where it is not known (structures, objects)
  bool bigEndian = false;
  bool fortranOrder = false;
  std::vector<int64_t> shape;
  size_t dataAt = 0;  ///< where the values begin in the file

  uint64_t count() const;
  /// "float32", "text", "dates", ...
  std::string typeName() const;
};

/// Throws InputError.
NpyHeader parseNpyHeader(std::string_view bytes, const Place& place);

}  // namespace marey
