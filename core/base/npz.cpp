// NPZ archives: NPY arrays in a zip archive.
#include <algorithm>

#include "base/archive.h"
#include "base/atomic_file.h"
#include "base/file_kind.h"
#include "base/npy.h"

namespace marey {
namespace {

constexpr std::string_view kSuffix = ".npy";

/// The folder that every array lies in, with its '/', or nothing.
std::string commonFolder(const std::map<std::string, std::string>& files) {
  std::string out;
  bool first = true;
  for (const auto& [name, content] : files) {
    if (!name.ends_with(kSuffix)) continue;
    const size_t slash = name.rfind('/');
    const std::string folder = slash == std::string::npos ? "" : name.substr(0, slash + 1);
    if (!first && folder != out) return {};
    out = folder;
    first = false;
  }
  return out;
}

const char* typeName(DType type) {
  switch (type) {
    case DType::F32:
      return "float32";
    case DType::F64:
      return "float64";
    case DType::F16:
      return "float16";
    case DType::I64:
      return "int64";
    case DType::I32:
      return "int32";
    case DType::U8:
      break;
  }
  return "uint8";
}

}  // namespace

bool NpzArrays::contains(const std::string& name) const {
  return numbers.contains(name) || texts.contains(name) || others.contains(name);
}

std::string NpzArrays::listing() const {
  std::map<std::string, std::string> all = others;
  const auto shape = [](const std::vector<int64_t>& sizes) {
    return Tensor{.dtype = DType::U8, .shape = sizes, .bytes = {}}.shapeText();
  };
  for (const auto& [key, tensor] : numbers)
    all[key] = fmt::format("{} {}", typeName(tensor.dtype), tensor.shapeText());
  for (const auto& [key, text] : texts) all[key] = "text " + shape(text.shape);
  std::string out;
  for (const auto& [key, what] : all)
    if (out.size() < 400) out += fmt::format("{}'{}' {}", out.empty() ? "" : ", ", key, what);
  return out.empty() ? "none" : out;
}

NpzArrays parseNpzArrays(std::string_view bytes, const std::string& origin) {
  const auto files = parseArchive(bytes, origin);
  const std::string folder = commonFolder(files);
  NpzArrays out;
  for (const auto& [name, content] : files) {
    if (name.empty() || name.back() == '/') continue;
    const std::string key = name.starts_with(folder) ? name.substr(folder.size()) : name;
    if (!key.ends_with(kSuffix)) {
      out.others.emplace(key, describeContent(content));
      continue;
    }
    const std::string array = key.substr(0, key.size() - kSuffix.size());
    NpyArray read = parseNpyArray(content, fmt::format("{}, array '{}'", origin, array));
    if (read.numbers)
      out.numbers.emplace(array, std::move(*read.numbers));
    else if (read.text)
      out.texts.emplace(array, std::move(*read.text));
    else
      out.others.emplace(array, read.summary());
  }
  const bool any = std::any_of(files.begin(), files.end(),
                               [](const auto& file) { return file.first.ends_with(kSuffix); });
  if (!any && !files.empty())
    throw InputError({.path = origin}, "an NPZ archive of arrays",
                     describeContent(bytes.substr(0, kFileHeadBytes)));
  return out;
}

NpzArrays readNpzArrays(const std::filesystem::path& path) {
  return parseNpzArrays(readFile(path), path.string());
}

std::map<std::string, Tensor> readNpz(const std::filesystem::path& path) {
  return readNpzArrays(path).numbers;
}

void writeNpz(const std::filesystem::path& path, const NpzArrays& arrays) {
  std::map<std::string, std::string> files;
  for (const auto& [key, tensor] : arrays.numbers)
    files[key + std::string(kSuffix)] = serialiseNpy(tensor);
  for (const auto& [key, text] : arrays.texts)
    files[key + std::string(kSuffix)] = serialiseNpy(text);
  writeArchive(path, files);
}

}  // namespace marey
