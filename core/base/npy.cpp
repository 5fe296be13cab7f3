#include "base/npy.h"

#include <cstring>

#include "base/archive.h"
#include "base/atomic_file.h"

namespace marey {
namespace {

constexpr std::string_view kMagic{"\x93NUMPY", 6};

struct Header {
  std::string descr;
  bool fortran = false;
  std::vector<int64_t> shape;
};

/// What follows "'key':" in a header, without leading blanks.
std::string_view valueOf(std::string_view header, std::string_view key, const Place& place) {
  const std::string wanted = fmt::format("'{}'", key);
  size_t at = header.find(wanted);
  if (at != std::string_view::npos) at = header.find_first_not_of(' ', at + wanted.size());
  if (at == std::string_view::npos || header[at] != ':')
    throw InputError(place, wanted + " in the NPY header", "none");
  at = header.find_first_not_of(' ', at + 1);
  return at == std::string_view::npos ? std::string_view() : header.substr(at);
}

/// The text between two characters at the start of `value`.
std::string between(std::string_view value, char open, char close, const char* what,
                    const Place& place) {
  const size_t end = value.find(close, 1);
  if (value.empty() || value[0] != open || end == std::string_view::npos)
    throw InputError(place, what, fmt::format("'{}'", value.substr(0, 60)));
  return std::string(value.substr(1, end - 1));
}

Header parseHeader(std::string_view text, const Place& place) {
  Header out;
  out.descr = between(valueOf(text, "descr", place), '\'', '\'', "a plain number type", place);
  const std::string_view order = valueOf(text, "fortran_order", place);
  out.fortran = order.starts_with("True");
  if (!out.fortran && !order.starts_with("False"))
    throw InputError(place, "'fortran_order' True or False", "another value");
  const std::string shape = between(valueOf(text, "shape", place), '(', ')', "a shape", place);
  if (shape.find_first_not_of("0123456789L, ") != std::string::npos)
    throw InputError(place, "a shape of whole numbers", shape.substr(0, 60));
  uint64_t count = 1;
  for (size_t i = 0; i < shape.size();) {
    if (shape[i] < '0' || shape[i] > '9') {
      ++i;
      continue;
    }
    uint64_t value = 0;
    for (; i < shape.size() && shape[i] >= '0' && shape[i] <= '9'; ++i) {
      value = value * 10 + static_cast<uint64_t>(shape[i] - '0');
      if (value > (uint64_t{1} << 40))
        throw InputError(place, "a sensible shape", shape.substr(0, 60));
    }
    if (value > 0 && count > (uint64_t{1} << 40) / value)
      throw InputError(place, "a sensible shape", shape.substr(0, 60));
    count *= value;
    out.shape.push_back(static_cast<int64_t>(value));
  }
  return out;
}

DType dtypeOf(const std::string& descr, const Place& place) {
  if (descr == "<f4") return DType::F32;
  if (descr == "<f8") return DType::F64;
  if (descr == "<f2") return DType::F16;
  if (descr == "<i8") return DType::I64;
  if (descr == "<i4") return DType::I32;
  if (descr == "|u1" || descr == "|b1") return DType::U8;
  throw InputError(place, "a little-endian number type (f2, f4, f8, i4, i8, u1)",
                   "'" + descr + "'");
}

const char* descrOf(DType type) {
  switch (type) {
    case DType::F32:
      return "<f4";
    case DType::F64:
      return "<f8";
    case DType::F16:
      return "<f2";
    case DType::I64:
      return "<i8";
    case DType::I32:
      return "<i4";
    case DType::U8:
      break;
  }
  return "|u1";
}

void toRowMajor(Tensor& tensor) {
  const size_t item = byteSize(tensor.dtype);
  const auto rank = tensor.shape.size();
  std::vector<std::byte> out(tensor.bytes.size());
  std::vector<int64_t> index(rank, 0);
  for (int64_t i = 0; i < tensor.count(); ++i) {
    int64_t from = 0;
    for (size_t d = rank; d-- > 0;) from = from * tensor.shape[d] + index[d];
    std::memcpy(out.data() + static_cast<size_t>(i) * item,
                tensor.bytes.data() + static_cast<size_t>(from) * item, item);
    for (size_t d = rank; d-- > 0;) {
      if (++index[d] < tensor.shape[d]) break;
      index[d] = 0;
    }
  }
  tensor.bytes = std::move(out);
}

}  // namespace

Tensor parseNpy(std::string_view bytes, const std::string& origin) {
  const Place place{.path = origin};
  if (bytes.size() < 10 || bytes.substr(0, 6) != kMagic)
    throw InputError(place, "an NPY array", "other content");
  const int major = static_cast<unsigned char>(bytes[6]);
  const size_t lengthBytes = major >= 2 ? 4 : 2;
  if (bytes.size() < 8 + lengthBytes) throw InputError(place, "an NPY header", "a cut file");
  uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 8, lengthBytes);
  const size_t start = 8 + lengthBytes + length;
  if (length > (1u << 20) || bytes.size() < start)
    throw InputError(place, "an NPY header", "a cut file");
  const Header header = parseHeader(bytes.substr(8 + lengthBytes, length), place);
  Tensor out{.dtype = dtypeOf(header.descr, place), .shape = header.shape, .bytes = {}};
  const size_t want = static_cast<size_t>(out.count()) * byteSize(out.dtype);
  if (bytes.size() - start < want)
    throwInput(place, fmt::format("{} bytes for shape {}", want, out.shapeText()), "{}",
               bytes.size() - start);
  out.bytes.resize(want);
  if (want > 0) std::memcpy(out.bytes.data(), bytes.data() + start, want);
  if (header.fortran && out.shape.size() > 1) toRowMajor(out);
  return out;
}

std::map<std::string, Tensor> parseNpz(std::string_view bytes, const std::string& origin) {
  std::map<std::string, Tensor> out;
  for (const auto& [name, content] : parseArchive(bytes, origin)) {
    if (name.empty() || name.back() == '/') continue;
    const std::string key = name.ends_with(".npy") ? name.substr(0, name.size() - 4) : name;
    out.emplace(key, parseNpy(content, fmt::format("{}, array '{}'", origin, key)));
  }
  return out;
}

std::map<std::string, Tensor> readNpz(const std::filesystem::path& path) {
  return parseNpz(readFile(path), path.string());
}

std::string serialiseNpy(const Tensor& tensor) {
  std::string shape;
  for (const int64_t size : tensor.shape) shape += std::to_string(size) + ", ";
  if (tensor.shape.size() > 1) shape.resize(shape.size() - 2);
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}",
                                   descrOf(tensor.dtype), shape);
  header.resize((header.size() + 10 + 1 + 63) / 64 * 64 - 10 - 1, ' ');
  header += '\n';
  std::string out(kMagic);
  out += '\x01';
  out += '\0';
  out += static_cast<char>(header.size() & 0xFF);
  out += static_cast<char>(header.size() >> 8);
  out += header;
  out.append(reinterpret_cast<const char*>(tensor.bytes.data()), tensor.bytes.size());
  return out;
}

void writeNpz(const std::filesystem::path& path, const std::map<std::string, Tensor>& arrays) {
  std::map<std::string, std::string> files;
  for (const auto& [key, tensor] : arrays) files[key + ".npy"] = serialiseNpy(tensor);
  writeArchive(path, files);
}

Tensor textTensor(std::string_view text) {
  Tensor out{.dtype = DType::U8, .shape = {static_cast<int64_t>(text.size())}, .bytes = {}};
  out.bytes.resize(text.size());
  if (!text.empty()) std::memcpy(out.bytes.data(), text.data(), text.size());
  return out;
}

std::string tensorText(const Tensor& tensor) {
  return {reinterpret_cast<const char*>(tensor.bytes.data()), tensor.bytes.size()};
}

}  // namespace marey
