// Experiment documents: whatever the bytes, a document that is written and read back the same, or
// an Error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "experiment/document.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const auto document =
        marey::experimentFromJson(marey::parseJson(text, "fuzz.json"), "fuzz.json");
    const std::string written = marey::jsonText(marey::toJson(document));
    const auto back = marey::experimentFromJson(marey::parseJson(written, "back"), "back");
    if (marey::jsonText(marey::toJson(back)) != written) std::abort();
    marey::experimentHash(document);
  } catch (const marey::Error&) {
  }
  return 0;
}
