// PyTorch checkpoints and safetensors: whatever the bytes, one state dict or an InputError.
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

#include "pickle/state_dicts.h"

#include "base/error.h"

namespace {

/// Weights of the network are those of the seeds: "w", "w.0", "module.w", ...
size_t ownName(std::string_view key) {
  for (size_t at = key.find('w'); at != std::string_view::npos; at = key.find('w', at + 1))
    if (at == 0 || key[at - 1] == '.') return at;
  return std::string_view::npos;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    marey::TorchCheckpoint checkpoint =
        marey::parseTorchCheckpoint(bytes, "fuzz.pt", marey::stateDictFilter(ownName));
    marey::chooseStateDict(std::move(checkpoint), ownName, "w", "", "fuzz.pt");
  } catch (const marey::InputError&) {
  }
  return 0;
}
