// Small valid checkpoints, for the fuzzer to start from: the legacy stream and the zip container.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/archive.h"
#include "base/atomic_file.h"

namespace marey {

/// Text of fewer than 256 bytes as a pickle holds it.
inline std::string pickledText(const std::string& text) {
  return std::string("X") + static_cast<char>(text.size()) + std::string(3, '\0') + text;
}

inline std::string pickledName(const std::string& module, const std::string& name) {
  return "c" + module + "\n" + name + "\n";
}

/// A tensor (2, 3) over storage "0" of 24 bytes.
inline std::string pickledTensor(const std::string& type = "FloatStorage", char count = 6) {
  return pickledName("torch._utils", "_rebuild_tensor_v2") + "((" + pickledText("storage") +
         pickledName("torch", type) + pickledText("0") + pickledText("cpu") + "K" + count + "tQK" +
         std::string(1, '\0') + "K\x02K\x03\x86K\x03K\x01\x86\x89" +
         pickledName("collections", "OrderedDict") + ")RtR";
}

inline std::string pickledItem(const std::string& key, const std::string& value) {
  return pickledText(key) + value + "s";
}

/// A dictionary with a step count and one tensor (2, 3) of floats, as pickled by PyTorch.
inline std::string pickledCheckpoint() {
  using namespace std::string_literals;
  return "\x80\x02}" + pickledItem("step", "K\x07") + pickledItem("w", pickledTensor()) +
         pickledItem("betas", "](G?\xec\xcc\xcc\xcc\xcc\xcc\xcd\x8a\x02\xff\x7fNe") + ".";
}

/// Training state of many classes around a state dict with prefixes.
inline std::string pickledTraining() {
  using namespace std::string_literals;
  const std::string array =
      pickledName("numpy.core.multiarray", "_reconstruct") + pickledName("numpy", "ndarray") +
      "K\0\x85"s + "C\x01" + "b\x87R(K\x01K\x02\x85" + pickledName("numpy", "dtype") +
      pickledText("f8") + "\x89\x88\x87R(K\x03" + pickledText("<") +
      "NNNJ\xff\xff\xff\xffJ\xff\xff\xff\xffK\0tb\x89"s + "C\x10" + std::string(16, '\x3f') + "tb";
  const std::string space = pickledName("argparse", "Namespace") + ")\x81}" +
                            pickledItem("lr", "G?\xb9\x99\x99\x99\x99\x99\x9a") + "b";
  const std::string path =
      pickledName("pathlib", "PosixPath") + "(" + pickledText("/") + pickledText("tmp") + "tR";
  const std::string losses = pickledName("collections", "defaultdict") +
                             pickledName("__builtin__", "list") + "\x85R" +
                             pickledItem("a",
                                         "](K\x01K\x02"
                                         "e");
  return "\x80\x02}" + pickledItem("state_dict", "}" + pickledItem("model.w", pickledTensor())) +
         pickledItem("optimizer", "}" + pickledItem("w", pickledTensor())) +
         pickledItem("array", array) + pickledItem("args", space) + pickledItem("out", path) +
         pickledItem("losses", losses) +
         pickledItem("device", pickledName("torch", "device") + pickledText("cpu") + "\x85R") +
         pickledItem("dtype", pickledName("torch", "float32")) +
         pickledItem("size", pickledName("torch", "Size") + "(K\x02K\x03t\x85R") + ".";
}

/// A model and its average.
inline std::string pickledPair() {
  return "\x80\x02}" + pickledItem("graph", "}" + pickledItem("module.w", pickledTensor())) +
         pickledItem("ema", "}" + pickledItem("w", pickledTensor("BFloat16Storage", 12))) + ".";
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
  writeArchive(folder / "training", {{"a/data.pkl", pickledTraining()}, {"a/data/0", values}},
               false);
  writeArchive(folder / "pair", {{"a/data.pkl", pickledPair()}, {"a/data/0", values}}, false);
  writeFileAtomically(folder / "bare_training", pickledTraining());
  writeFileAtomically(
      folder / "safetensors",
      "\x3d\0\0\0\0\0\0\0"s +
          "{\"w\":{\"dtype\":\"F32\",\"shape\":[2,3],\"data_offsets\":[0,24]}}    " + values);
  writeArchive(folder / "zip", {{"a/data.pkl", pickledCheckpoint()}, {"a/data/0", values}}, false);
}

}  // namespace marey
