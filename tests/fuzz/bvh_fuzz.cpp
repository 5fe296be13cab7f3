// BVH: whatever the bytes, a valid clip or an InputError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "base/error.h"
#include "io/bvh.h"
#include "io/doctor.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    for (const marey::Clip& clip : marey::io::parseBvhClips(bytes, "fuzz.bvh")) {
      marey::validate(clip);
      marey::io::examineClip(clip);
      marey::io::doubtsOf(clip);
    }
  } catch (const marey::InputError&) {
  }
  return 0;
}
