// NPZ archives and the arrays in them: valid clips or an InputError. Checksums keep a fuzzer out
// of archives, so most inputs are arrays without one: the first byte is 0 for an archive, 2 for a
// single NPY file of joints; else arrays follow, each as a name's number, a length (two bytes, low
// first) and an NPY file.
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "npz_fuzz_names.h"

#include "base/error.h"
#include "base/npy.h"
#include "io/joint_arrays.h"
#include "io/npz_clips.h"

namespace {

marey::NpzArrays arraysIn(std::string_view bytes) {
  marey::NpzArrays out;
  while (bytes.size() >= 3) {
    const auto number = static_cast<unsigned char>(bytes[0]);
    const size_t length = static_cast<unsigned char>(bytes[1]) |
                          static_cast<size_t>(static_cast<unsigned char>(bytes[2])) << 8U;
    bytes.remove_prefix(3);
    const char* name = marey::kFuzzNames[number % marey::kFuzzNames.size()];
    marey::NpyArray array = marey::parseNpyArray(bytes.substr(0, length), "fuzz.npy");
    if (array.numbers)
      out.numbers[name] = std::move(*array.numbers);
    else if (array.text)
      out.texts[name] = std::move(*array.text);
    else
      out.others[name] = array.summary();
    bytes.remove_prefix(std::min(length, bytes.size()));
  }
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    const std::vector<marey::Clip> clips =
        data[0] == 2
            ? marey::io::readNpyClips(bytes, "fuzz.npy", {})
            : marey::io::clipsFromArrays(
                  data[0] == 0 ? marey::parseNpzArrays(bytes, "fuzz.npz") : arraysIn(bytes),
                  "fuzz.npz");
    for (const marey::Clip& clip : clips) marey::validate(clip);
  } catch (const marey::InputError&) {
  }
  return 0;
}
