#include "base/npy.h"

#include <algorithm>
#include <cstring>

#include "base/npy_header.h"
#include "base/npy_text.h"

namespace marey {
namespace {

/// The values in row-major order and this machine's byte order. `unit`: what is swapped as one.
std::vector<std::byte> rowMajor(std::string_view bytes, const NpyHeader& header, size_t unit) {
  const size_t item = header.itemBytes;
  const auto count = static_cast<size_t>(header.count());
  std::vector<std::byte> out(count * item);
  if (out.empty()) return out;  // no values, or texts without a letter
  const auto rank = header.shape.size();
  if (!header.fortranOrder || rank < 2) {
    std::memcpy(out.data(), bytes.data(), out.size());
  } else {
    std::vector<int64_t> index(rank, 0);
    for (size_t i = 0; i < count; ++i) {
      int64_t from = 0;
      for (size_t d = rank; d-- > 0;) from = from * header.shape[d] + index[d];
      std::memcpy(out.data() + i * item, bytes.data() + static_cast<size_t>(from) * item, item);
      for (size_t d = rank; d-- > 0;) {
        if (++index[d] < header.shape[d]) break;
        index[d] = 0;
      }
    }
  }
  if (header.bigEndian && unit > 1)
    for (size_t at = 0; at + unit <= out.size(); at += unit)
      std::reverse(out.begin() + static_cast<std::ptrdiff_t>(at),
                   out.begin() + static_cast<std::ptrdiff_t>(at + unit));
  return out;
}

template <typename From, typename To>
Tensor widened(const std::vector<std::byte>& bytes, DType type, std::vector<int64_t> shape) {
  Tensor out{.dtype = type, .shape = std::move(shape), .bytes = {}};
  const size_t count = bytes.size() / sizeof(From);
  out.bytes.resize(count * sizeof(To));
  for (size_t i = 0; i < count; ++i) {
    From from;
    std::memcpy(&from, bytes.data() + i * sizeof(From), sizeof(From));
    const To to = static_cast<To>(from);
    std::memcpy(out.bytes.data() + i * sizeof(To), &to, sizeof(To));
  }
  return out;
}

bool anyAbove63Bits(const std::vector<std::byte>& littleEndian) {
  for (size_t at = 7; at < littleEndian.size(); at += 8)
    if ((littleEndian[at] & std::byte{0x80}) != std::byte{0}) return true;
  return false;
}

/// Nothing for types that Tensor cannot hold.
std::optional<Tensor> numbersOf(std::string_view data, const NpyHeader& header,
                                const Place& place) {
  const auto is = [&](char kind, size_t bytes) {
    return header.kind == kind && header.itemBytes == bytes;
  };
  const auto plain = [&](DType type) {
    return Tensor{
        .dtype = type, .shape = header.shape, .bytes = rowMajor(data, header, header.itemBytes)};
  };
  if (is('f', 4)) return plain(DType::F32);
  if (is('f', 8)) return plain(DType::F64);
  if (is('f', 2)) return plain(DType::F16);
  if (is('i', 8)) return plain(DType::I64);
  if (is('i', 4)) return plain(DType::I32);
  if (is('u', 1) || is('b', 1)) return plain(DType::U8);
  if (header.kind != 'i' && header.kind != 'u') return std::nullopt;
  const auto bytes = rowMajor(data, header, header.itemBytes);
  if (is('i', 1)) return widened<int8_t, int32_t>(bytes, DType::I32, header.shape);
  if (is('i', 2)) return widened<int16_t, int32_t>(bytes, DType::I32, header.shape);
  if (is('u', 2)) return widened<uint16_t, int32_t>(bytes, DType::I32, header.shape);
  if (is('u', 4)) return widened<uint32_t, int64_t>(bytes, DType::I64, header.shape);
  if (!is('u', 8)) return std::nullopt;
  if (anyAbove63Bits(bytes))
    throw InputError(place, "whole numbers of up to 63 bits", "a larger uint64");
  return widened<uint64_t, int64_t>(bytes, DType::I64, header.shape);
}

TextArray textOf(std::string_view data, const NpyHeader& header) {
  const auto bytes = rowMajor(data, header, 1);
  TextArray out{.shape = header.shape, .values = {}};
  const auto count = static_cast<size_t>(header.count());
  for (size_t i = 0; i < count; ++i) {
    const std::string_view value(reinterpret_cast<const char*>(bytes.data()) + i * header.itemBytes,
                                 header.itemBytes);
    if (header.kind == 'U') {
      out.values.push_back(utf8FromUtf32(value, header.bigEndian));
    } else {
      const size_t end = value.find_last_not_of('\0');
      out.values.emplace_back(value.substr(0, end == std::string_view::npos ? 0 : end + 1));
    }
  }
  return out;
}

std::string shapeText(const std::vector<int64_t>& shape) {
  return Tensor{.dtype = DType::U8, .shape = shape, .bytes = {}}.shapeText();
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

std::string headerText(const std::string& descr, const std::vector<int64_t>& shape) {
  std::string sizes;
  for (const int64_t size : shape) sizes += std::to_string(size) + ", ";
  if (shape.size() > 1) sizes.resize(sizes.size() - 2);
  std::string header =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", descr, sizes);
  header.resize((header.size() + 10 + 1 + 63) / 64 * 64 - 10 - 1, ' ');
  header += '\n';
  std::string out("\x93NUMPY\x01\0", 8);
  out += static_cast<char>(header.size() & 0xFF);
  out += static_cast<char>(header.size() >> 8);
  return out + header;
}

}  // namespace

std::string NpyArray::summary() const {
  return type + " " + shapeText(shape);
}

NpyArray parseNpyArray(std::string_view bytes, const std::string& origin) {
  const Place place{.path = origin};
  const NpyHeader header = parseNpyHeader(bytes, place);
  NpyArray out{.type = header.typeName(),
               .shape = header.shape,
               .numbers = {},
               .text = {},
               .bytesUsed = bytes.size()};
  const bool text = header.kind == 'U' || header.kind == 'S' || header.kind == 'a';
  const bool number = std::string_view("fiub").find(header.kind) != std::string_view::npos;
  if (!text && !number) return out;
  // A value of no bytes (empty text) could claim any number of values for nothing.
  const uint64_t want = header.count() * std::max<uint64_t>(header.itemBytes, number ? 1 : 0);
  const std::string_view data = bytes.substr(header.dataAt);
  if (want > data.size() || (header.itemBytes == 0 && header.count() > 1'000'000))
    throwInput(place, fmt::format("{} bytes for {}", want, out.summary()),
               "{} (the file is damaged or cut)", data.size());
  out.bytesUsed = header.dataAt + want;
  if (text)
    out.text = textOf(data, header);
  else
    out.numbers = numbersOf(data, header, place);
  return out;
}

Tensor parseNpy(std::string_view bytes, const std::string& origin) {
  NpyArray array = parseNpyArray(bytes, origin);
  if (!array.numbers) throw InputError({.path = origin}, "an array of numbers", array.summary());
  return std::move(*array.numbers);
}

std::string serialiseNpy(const Tensor& tensor) {
  std::string out = headerText(descrOf(tensor.dtype), tensor.shape);
  out.append(reinterpret_cast<const char*>(tensor.bytes.data()), tensor.bytes.size());
  return out;
}

std::string serialiseNpy(const TextArray& text) {
  std::vector<std::u32string> values;
  size_t longest = 1;  // NumPy has no text of length 0
  for (const std::string& value : text.values) {
    values.push_back(utf32FromUtf8(value));
    longest = std::max(longest, values.back().size());
  }
  std::string out = headerText(fmt::format("<U{}", longest), text.shape);
  for (std::u32string& value : values) {
    value.resize(longest, U'\0');
    out.append(reinterpret_cast<const char*>(value.data()), 4 * longest);
  }
  return out;
}

}  // namespace marey
