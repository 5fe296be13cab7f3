#include "base/tensor_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <numeric>

#include "base/atomic_file.h"
#include "base/file_kind.h"
#include "base/hash.h"

namespace marey {
namespace {

static_assert(std::endian::native == std::endian::little, "tensor files are little-endian");

struct TypeInfo {
  DType type;
  const char* name;
  size_t bytes;
};
constexpr std::array<TypeInfo, 6> kTypes{{{DType::F32, "F32", 4},
                                          {DType::F64, "F64", 8},
                                          {DType::F16, "F16", 2},
                                          {DType::I64, "I64", 8},
                                          {DType::I32, "I32", 4},
                                          {DType::U8, "U8", 1}}};

const TypeInfo& info(DType type) {
  return *std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& t) { return t.type == type; });
}

float halfToFloat(uint16_t h) {
  const uint32_t sign = (h & 0x8000u) << 16;
  const uint32_t exponent = (h >> 10) & 0x1Fu;
  const uint32_t mantissa = h & 0x3FFu;
  if (exponent == 0)
    return std::copysign(std::ldexp(static_cast<float>(mantissa), -24), sign ? -1.f : 1.f);
  const uint32_t bits = exponent == 31 ? sign | 0x7F800000u | (mantissa << 13)
                                       : sign | ((exponent + 112) << 23) | (mantissa << 13);
  return std::bit_cast<float>(bits);
}

/// Round to nearest even; overflow becomes infinity.
uint16_t floatToHalf(float value) {
  const uint32_t bits = std::bit_cast<uint32_t>(value);
  const auto sign = static_cast<uint16_t>((bits >> 16) & 0x8000u);
  if (std::isnan(value)) return sign | 0x7E00u;
  const float magnitude = std::fabs(value);
  if (magnitude >= 65520.f) return sign | 0x7C00u;
  if (magnitude < 0x1p-14f)
    return sign | static_cast<uint16_t>(std::nearbyint(std::ldexp(magnitude, 24)));
  const uint32_t rebased = (bits & 0x7FFFFFFFu) - (112u << 23);
  const uint32_t rounded = rebased + 0xFFFu + ((rebased >> 13) & 1u);
  return sign | static_cast<uint16_t>(rounded >> 13);
}

/// A float beyond the range of an integer type has no value there.
template <typename To, typename From>
To cast(From value) {
  if constexpr (std::is_floating_point_v<From> && std::is_integral_v<To>) {
    if (!(value >= static_cast<From>(-0x1p63) && value < static_cast<From>(0x1p63)))
      throw NumericError(fmt::format("expected a whole number of 64 bits, found {}", value));
  }
  return static_cast<To>(value);
}

template <typename From, typename To>
std::vector<To> convert(const Tensor& t) {
  std::vector<To> out(static_cast<size_t>(t.count()));
  for (size_t i = 0; i < out.size(); ++i) {
    From value;
    std::memcpy(&value, t.bytes.data() + i * sizeof(From), sizeof(From));
    out[i] = cast<To>(value);
  }
  return out;
}

template <typename To>
std::vector<To> convertAny(const Tensor& t) {
  switch (t.dtype) {
    case DType::F32:
      return convert<float, To>(t);
    case DType::F64:
      return convert<double, To>(t);
    case DType::I64:
      return convert<int64_t, To>(t);
    case DType::I32:
      return convert<int32_t, To>(t);
    case DType::U8:
      return convert<uint8_t, To>(t);
    case DType::F16:
      break;
  }
  const auto halves = convert<uint16_t, uint16_t>(t);
  std::vector<To> out(halves.size());
  std::transform(halves.begin(), halves.end(), out.begin(),
                 [](uint16_t h) { return cast<To>(halfToFloat(h)); });
  return out;
}

template <typename T>
Tensor fromValues(DType dtype, std::vector<int64_t> shape, const T* values) {
  Tensor out{.dtype = dtype, .shape = std::move(shape), .bytes = {}};
  out.bytes.resize(static_cast<size_t>(out.count()) * sizeof(T));
  if (!out.bytes.empty()) std::memcpy(out.bytes.data(), values, out.bytes.size());
  return out;
}

std::string textOf(const std::vector<int64_t>& shape) {
  std::string out = "(";
  for (size_t i = 0; i < shape.size(); ++i)
    out += (i ? ", " : "") + (shape[i] < 0 ? std::string("any") : std::to_string(shape[i]));
  return out + ")";
}

/// Bytes that lie in memory or in a file: a file of many tensors is never held twice.
struct Source {
  uint64_t size = 0;
  std::function<void(uint64_t offset, std::byte* to, size_t count)> read;
};

Source memorySource(std::string_view bytes) {
  return {bytes.size(), [bytes](uint64_t offset, std::byte* to, size_t count) {
            std::memcpy(to, bytes.data() + offset, count);
          }};
}

Source fileSource(std::istream& in, uint64_t size, const std::string& path) {
  return {size, [&in, path](uint64_t offset, std::byte* to, size_t count) {
            in.seekg(static_cast<std::streamoff>(offset));
            in.read(reinterpret_cast<char*>(to), static_cast<std::streamsize>(count));
            if (!in) throw FileError(fmt::format("{}: cannot read to its end", path));
          }};
}

/// `begin`: where the tensors' data begin in the source.
Tensor parseTensor(const std::string& key, const Json& entry, const Source& source, uint64_t begin,
                   const std::string& origin) {
  const Place place{.path = origin, .item = "tensor '" + key + "'"};
  JsonReader reader(entry, origin, key + ".");
  const auto typeName = reader.required<std::string>("dtype");
  const auto type =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& t) { return typeName == t.name; });
  if (type == kTypes.end())
    throw InputError(place, "a type of F32, F64, F16, I64, I32, U8", typeName);
  Tensor out{
      .dtype = type->type, .shape = reader.required<std::vector<int64_t>>("shape"), .bytes = {}};
  const auto range = reader.required<std::vector<uint64_t>>("data_offsets");
  uint64_t count = 1;
  for (const int64_t size : out.shape) {
    if (size < 0 || (size > 0 && count > (uint64_t{1} << 40) / static_cast<uint64_t>(size)))
      throw InputError(place, "a sensible shape", out.shapeText());
    count *= static_cast<uint64_t>(size);
  }
  if (range.size() != 2 || range[0] > range[1] || range[1] > source.size - begin)
    throw InputError(place, fmt::format("data within {} bytes", source.size - begin),
                     "offsets beyond the file (is it cut?)");
  if (range[1] - range[0] != count * type->bytes)
    throwInput(place, fmt::format("{} bytes", count * type->bytes), "{} bytes",
               range[1] - range[0]);
  out.bytes.resize(range[1] - range[0]);
  if (!out.bytes.empty()) source.read(begin + range[0], out.bytes.data(), out.bytes.size());
  return out;
}

std::string bytesAt(const Source& source, uint64_t offset, size_t count) {
  std::string out(count, '\0');
  if (count > 0) source.read(offset, reinterpret_cast<std::byte*>(out.data()), count);
  return out;
}

/// A zip archive ends with its directory, which a comment of up to 64 KiB may follow.
bool isCutArchive(std::string_view head, const Source& source) {
  if (!head.starts_with("PK\x03\x04")) return false;
  const uint64_t tail = std::min<uint64_t>(source.size, (uint64_t{1} << 16) + 22);
  return bytesAt(source, source.size - tail, tail).find("PK\x05\x06") == std::string::npos;
}

/// Files of another kind get their name, whatever their first eight bytes say of a header.
void requireOwnKind(const Source& source, const std::string& origin) {
  const std::string head = bytesAt(source, 0, std::min<uint64_t>(source.size, kFileHeadBytes));
  const auto kind = fileKind(head);
  if (!kind || kind->id == "marey" || kind->id == "safetensors") return;
  std::string found = kind->text();
  if (isCutArchive(head, source))
    found += " that is damaged or cut (an incomplete download?)";
  else if (kind->id == "torch")
    found += " (marey model import reads it)";
  throw InputError({.path = origin}, "a Marey file", found);
}

TensorFile parse(const Source& source, const std::string& origin) {
  uint64_t headerSize = 0;
  requireOwnKind(source, origin);
  if (source.size < 8) throw InputError({.path = origin}, "a Marey file", "fewer than 8 bytes");
  source.read(0, reinterpret_cast<std::byte*>(&headerSize), 8);
  if (headerSize > source.size - 8)
    throwInput({.path = origin}, fmt::format("a header within {} bytes", source.size - 8),
               "a header of {} bytes (not a Marey file, or cut)", headerSize);
  std::string text(headerSize, '\0');
  if (headerSize > 0) source.read(8, reinterpret_cast<std::byte*>(text.data()), text.size());
  const Json header = parseJson(text, origin);
  if (!header.is_object())
    throw InputError({.path = origin}, "a JSON object as header", header.type_name());
  TensorFile out;
  const uint64_t begin = 8 + headerSize, data = source.size - begin;
  uint64_t described = 0;
  for (const auto& [key, entry] : header.items()) {
    if (key != "__metadata__") {
      Tensor tensor = parseTensor(key, entry, source, begin, origin);
      described += tensor.bytes.size();
      if (described > data) break;  // overlapping: could unfold without bound
      out.tensors.emplace(key, std::move(tensor));
    } else if (entry.is_object() && entry.contains("marey") && entry["marey"].is_string()) {
      out.metadata = parseJson(entry["marey"].get<std::string>(), origin + ", metadata");
    }
  }
  if (described != data)
    throwInput({.path = origin}, fmt::format("tensors that fill {} bytes", data), "{}{}",
               described > data ? "more than " : "", std::min(described, data));
  return out;
}

/// What comes before the tensors.
std::string headOf(const TensorFile& file) {
  Json header = Json::object();
  header["__metadata__"] = {{"format", "marey"}, {"marey", jsonText(file.metadata)}};
  uint64_t offset = 0;
  for (const auto& [key, tensor] : file.tensors) {
    header[key] = {{"dtype", name(tensor.dtype)},
                   {"shape", tensor.shape},
                   {"data_offsets", {offset, offset + tensor.bytes.size()}}};
    offset += tensor.bytes.size();
  }
  std::string text = jsonText(header);
  text.resize((text.size() + 7) / 8 * 8, ' ');
  const uint64_t size = text.size();
  return std::string(reinterpret_cast<const char*>(&size), 8) + text;
}

std::string_view viewOf(const Tensor& tensor) {
  return {reinterpret_cast<const char*>(tensor.bytes.data()), tensor.bytes.size()};
}

}  // namespace

size_t byteSize(DType type) {
  return info(type).bytes;
}
const char* name(DType type) {
  return info(type).name;
}

int64_t Tensor::count() const {
  return std::accumulate(shape.begin(), shape.end(), int64_t{1}, std::multiplies<>());
}
std::string Tensor::shapeText() const {
  return textOf(shape);
}
Tensor Tensor::fromFloats(std::vector<int64_t> shape, const float* v) {
  return fromValues(DType::F32, std::move(shape), v);
}
Tensor Tensor::fromDoubles(std::vector<int64_t> shape, const double* v) {
  return fromValues(DType::F64, std::move(shape), v);
}
Tensor Tensor::fromInt64(std::vector<int64_t> shape, const int64_t* v) {
  return fromValues(DType::I64, std::move(shape), v);
}
std::vector<float> Tensor::toFloats() const {
  return convertAny<float>(*this);
}
std::vector<double> Tensor::toDoubles() const {
  return convertAny<double>(*this);
}
std::vector<int64_t> Tensor::toInt64() const {
  return convertAny<int64_t>(*this);
}

Tensor Tensor::as(DType type) const {
  if (type == dtype) return *this;
  const auto values = toFloats();
  if (type == DType::F32) return fromFloats(shape, values.data());
  if (type == DType::F64) return fromDoubles(shape, toDoubles().data());
  if (type != DType::F16) throw Error("Tensor::as converts to floating-point types only");
  std::vector<uint16_t> halves(values.size());
  std::transform(values.begin(), values.end(), halves.begin(), floatToHalf);
  return fromValues(DType::F16, shape, halves.data());
}

const Tensor& TensorFile::get(const std::string& key, const std::vector<int64_t>& shape,
                              const std::string& path) const {
  const Place place{.path = path, .item = "tensor '" + key + "'"};
  const auto found = tensors.find(key);
  if (found == tensors.end()) throw InputError(place, "shape " + textOf(shape), "no such tensor");
  const auto& actual = found->second.shape;
  const bool same = std::equal(shape.begin(), shape.end(), actual.begin(), actual.end(),
                               [](int64_t want, int64_t have) { return want < 0 || want == have; });
  if (!same) throw InputError(place, "shape " + textOf(shape), found->second.shapeText());
  return found->second;
}

TensorFile parseTensorFile(std::string_view bytes, const std::string& origin) {
  return parse(memorySource(bytes), origin);
}

TensorFile readTensorFile(const std::filesystem::path& path) {
  std::error_code ec;
  const uint64_t size =
      std::filesystem::is_regular_file(path, ec) ? std::filesystem::file_size(path, ec) : 0;
  std::ifstream in;
  if (size > 0 && !ec) in.open(path, std::ios::binary);
  // Pipes have no size; what cannot be read gets its message there.
  if (!in.is_open()) return parseTensorFile(readFile(path), path.string());
  return parse(fileSource(in, size, path.string()), path.string());
}

std::string serialise(const TensorFile& file) {
  std::string out = headOf(file);
  for (const auto& [key, tensor] : file.tensors) out += viewOf(tensor);
  return out;
}

std::string contentHash(const TensorFile& file) {
  const std::string head = headOf(file);
  std::vector<std::string_view> parts{head};
  for (const auto& [key, tensor] : file.tensors) parts.push_back(viewOf(tensor));
  return contentHash(parts);
}

void writeTensorFile(const std::filesystem::path& path, const TensorFile& file) {
  writeFileAtomically(path, [&](std::ostream& out) {
    out << headOf(file);
    for (const auto& [key, tensor] : file.tensors) out << viewOf(tensor);
  });
}

}  // namespace marey
