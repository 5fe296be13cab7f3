// ASF and AMC in one input, parted by a zero byte: a valid clip or an InputError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "base/error.h"
#include "io/asf_amc.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const size_t part = bytes.find('\0');
  try {
    const auto asf = marey::io::parseAsf(bytes.substr(0, part), "fuzz.asf");
    const std::string_view amc = part == bytes.npos ? std::string_view() : bytes.substr(part + 1);
    marey::validate(marey::io::parseAmc(amc, "fuzz.amc", asf));
  } catch (const marey::InputError&) {
  }
  return 0;
}
