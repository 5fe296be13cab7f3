// PyTorch checkpoints: whatever the bytes, a checkpoint or an InputError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "base/error.h"
#include "nn/torch_pickle.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    marey::parseTorchCheckpoint(bytes, "fuzz.pt");
  } catch (const marey::InputError&) {
  }
  return 0;
}
