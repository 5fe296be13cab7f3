// Small valid checkpoints, for the fuzzer to start from: the legacy stream and the zip container.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/archive.h"
#include "base/atomic_file.h"

namespace marey {

/// A dictionary with a step count and one tensor (2, 3) of floats, as pickled by PyTorch.
inline std::string pickledCheckpoint() {
  using namespace std::string_literals;
  return "\x80\x02}q\x00(X\x04\x00\x00\x00stepK\x07X\x01\x00\x00\x00w"
         "ctorch._utils\n_rebuild_tensor_v2\n((X\x07\x00\x00\x00storagectorch\nFloatStorage\n"
         "X\x01\x00\x00\x00"
         "0X\x03\x00\x00\x00"
         "cpuK\x06tQK\x00K\x02K\x03\x86K\x03K\x01\x86\x89"
         "ccollections\nOrderedDict\n)RtRX\x05\x00\x00\x00"
         "betas](G?\xec\xcc\xcc\xcc\xcc\xcc\xcd\x8a\x02\xff\x7fNeu."s;
}

inline void writePickleSeeds(const std::filesystem::path& folder) {
  using namespace std::string_literals;
  const std::string values(24, '\x3f');
  writeFileAtomically(folder / "legacy",
                      "\x80\x02\x8a\x0a\x6c\xfc\x9c\x46\xf9\x20\x6a\xa8\x50\x19."
                      "\x80\x02M\xe9\x03."
                      "\x80\x02}X\x0d\x00\x00\x00little_endian\x88s."s +
                          pickledCheckpoint() +
                          "\x80\x02]X\x01\x00\x00\x00"
                          "0a.\x06\x00\x00\x00\x00\x00\x00\x00"s +
                          values);
  writeArchive(folder / "zip", {{"a/data.pkl", pickledCheckpoint()}, {"a/data/0", values}}, false);
}

}  // namespace marey
