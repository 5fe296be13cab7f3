#include "base/npy_header.h"

#include <algorithm>
#include <cstring>

#include "base/file_kind.h"

namespace marey {
namespace {

constexpr std::string_view kMagic{"\x93NUMPY", 6};
constexpr uint64_t kMostValues = uint64_t{1} << 40;
constexpr size_t kMostItemBytes = size_t{1} << 20;

/// What follows "'key':" in a header, without leading blanks. Either quote is Python's.
std::string_view valueOf(std::string_view header, std::string_view key, const Place& place) {
  for (const char quote : {'\'', '"'}) {
    const std::string wanted = fmt::format("{0}{1}{0}", quote, key);
    size_t at = header.find(wanted);
    if (at != std::string_view::npos) at = header.find_first_not_of(' ', at + wanted.size());
    if (at == std::string_view::npos || header[at] != ':') continue;
    at = header.find_first_not_of(' ', at + 1);
    return at == std::string_view::npos ? std::string_view() : header.substr(at);
  }
  throw InputError(place, fmt::format("'{}' in the NPY header", key), "none");
}

std::vector<int64_t> parseShape(std::string_view value, const Place& place) {
  const size_t end = value.find(')');
  if (value.empty() || value[0] != '(' || end == std::string_view::npos)
    throw InputError(place, "a shape", quotedStart(value, 60));
  const std::string_view shape = value.substr(1, end - 1);
  if (shape.find_first_not_of("0123456789L, ") != std::string_view::npos)
    throw InputError(place, "a shape of whole numbers", quotedStart(shape, 60));
  std::vector<int64_t> out;
  uint64_t count = 1;
  for (size_t i = 0; i < shape.size();) {
    if (shape[i] < '0' || shape[i] > '9') {
      ++i;
      continue;
    }
    uint64_t size = 0;
    for (; i < shape.size() && shape[i] >= '0' && shape[i] <= '9'; ++i) {
      size = size * 10 + static_cast<uint64_t>(shape[i] - '0');
      if (size > kMostValues) throw InputError(place, "a sensible shape", quotedStart(shape, 60));
    }
    if (size > 0 && count > kMostValues / size)
      throw InputError(place, "a sensible shape", quotedStart(shape, 60));
    count *= size;
    out.push_back(static_cast<int64_t>(size));
  }
  return out;
}

/// "'<f4'" and its like; a list of fields is a structure.
void parseType(std::string_view value, NpyHeader& header, const Place& place) {
  if (value.starts_with('[') || value.starts_with('(')) return;
  const size_t end = value.empty() ? std::string_view::npos : value.find(value[0], 1);
  if (value.empty() || (value[0] != '\'' && value[0] != '"') || end == std::string_view::npos)
    throw InputError(place, "a type in the NPY header", quotedStart(value, 60));
  std::string_view type = value.substr(1, end - 1);
  header.bigEndian = type.starts_with('>');
  if (!type.empty() && std::string_view("<>=|").find(type[0]) != std::string_view::npos)
    type.remove_prefix(1);
  if (type.empty()) throw InputError(place, "a type in the NPY header", "an empty one");
  header.kind = type[0] == '?' ? 'b' : type[0];
  size_t bytes = type[0] == '?' ? 1 : 0;
  for (size_t i = 1; i < type.size() && type[i] >= '0' && type[i] <= '9'; ++i) {
    bytes = bytes * 10 + static_cast<size_t>(type[i] - '0');
    if (bytes > kMostItemBytes) throw InputError(place, "a sensible type", quotedStart(type, 60));
  }
  header.itemBytes = header.kind == 'U' ? 4 * bytes : header.kind == 'O' ? 0 : bytes;
}

}  // namespace

uint64_t NpyHeader::count() const {
  uint64_t out = 1;
  for (const int64_t size : shape) out *= static_cast<uint64_t>(size);
  return out;
}

std::string NpyHeader::typeName() const {
  const size_t bits = 8 * itemBytes;
  switch (kind) {
    case 'f':
      return fmt::format("float{}", bits);
    case 'i':
      return fmt::format("int{}", bits);
    case 'u':
      return fmt::format("uint{}", bits);
    case 'b':
      return "bool";
    case 'c':
      return "complex numbers";
    case 'U':
      return "text";
    case 'S':
    case 'a':
      return "text in bytes";
    case 'M':
      return "dates";
    case 'm':
      return "durations";
    case 'O':
      return "objects (a pickle, which is not opened)";
    default:
      return "structures of several fields";
  }
}

NpyHeader parseNpyHeader(std::string_view bytes, const Place& place) {
  if (bytes.substr(0, 6) != kMagic)
    throw InputError(place, "a NumPy array", describeContent(bytes.substr(0, kFileHeadBytes)));
  constexpr auto kCut = "one that is damaged or cut";
  if (bytes.size() < 10) throw InputError(place, "a whole NumPy array", kCut);
  const size_t lengthBytes = static_cast<unsigned char>(bytes[6]) >= 2 ? 4 : 2;
  uint32_t length = 0;
  if (bytes.size() < 8 + lengthBytes) throw InputError(place, "a whole NumPy array", kCut);
  std::memcpy(&length, bytes.data() + 8, lengthBytes);
  NpyHeader out;
  out.dataAt = 8 + lengthBytes + length;
  if (length > (1u << 20) || bytes.size() < out.dataAt)
    throw InputError(place, "a whole NumPy array", kCut);
  const std::string_view text = bytes.substr(8 + lengthBytes, length);
  parseType(valueOf(text, "descr", place), out, place);
  const std::string_view order = valueOf(text, "fortran_order", place);
  out.fortranOrder = order.starts_with("True");
  if (!out.fortranOrder && !order.starts_with("False"))
    throw InputError(place, "'fortran_order' True or False", quotedStart(order, 20));
  out.shape = parseShape(valueOf(text, "shape", place), place);
  return out;
}

}  // namespace marey
