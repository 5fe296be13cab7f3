// Comma-separated joint positions: a valid clip or an InputError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "base/error.h"
#include "io/clip_io.h"
#include "io/dog_text.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  marey::io::formatOfContent(bytes);
  try {
    marey::validate(marey::io::parseDogText(bytes, "fuzz.txt"));
  } catch (const marey::InputError&) {
  }
  return 0;
}
