#include "base/tensor_metadata.h"

#include <cstdint>
#include <fstream>

namespace marey {

Json readTensorMetadata(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) throw FileError(path.string() + ": cannot open");
  const auto size = static_cast<uint64_t>(in.tellg());
  in.seekg(0);
  uint64_t headerSize = 0;
  in.read(reinterpret_cast<char*>(&headerSize), sizeof headerSize);
  if (!in || headerSize > size - sizeof headerSize)
    throwInput({.path = path.string()}, fmt::format("a tensor file's header within {} bytes", size),
               "none (not a Marey file, or cut)");
  std::string text(headerSize, '\0');
  if (!in.read(text.data(), static_cast<std::streamsize>(headerSize)))
    throw FileError(path.string() + ": cannot read");
  const Json header = parseJson(text, path.string());
  const Json own = header.is_object() ? header.value("__metadata__", Json::object()) : Json();
  if (!own.is_object() || !own.contains("marey") || !own["marey"].is_string())
    return Json::object();
  return parseJson(own["marey"].get<std::string>(), path.string() + ", metadata");
}

}  // namespace marey
