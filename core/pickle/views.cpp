#include "pickle/views.h"

#include <cstring>

#include "pickle/utf8.h"

namespace marey::pickle {
namespace {

constexpr uint64_t kSpareBytes = uint64_t{64} << 20;
constexpr uint64_t kMaxUnfolding = 4;

std::string shapeText(const std::vector<int64_t>& sizes) {
  return Tensor{.dtype = DType::F32, .shape = sizes, .bytes = {}}.shapeText();
}

bool isContiguous(const View& view) {
  int64_t expected = 1;
  for (size_t d = view.shape.size(); d-- > 0;) {
    if (view.shape[d] != 1 && view.strides[d] != expected) return false;
    expected *= view.shape[d];
  }
  return true;
}

void copyStrided(const View& view, std::string_view from, size_t item, std::vector<std::byte>& to) {
  std::vector<int64_t> index(view.shape.size(), 0);
  uint64_t position = view.offset;
  for (size_t at = 0; at < to.size(); at += item) {
    std::memcpy(to.data() + at, from.data() + position * item, item);
    for (size_t d = view.shape.size(); d-- > 0;) {
      position += static_cast<uint64_t>(view.strides[d]);
      if (++index[d] < view.shape[d]) break;
      position -= static_cast<uint64_t>(view.shape[d]) * static_cast<uint64_t>(view.strides[d]);
      index[d] = 0;
    }
  }
}

/// Values of 8 or 16 bits in 32: bfloat16 is the upper half of a float.
std::vector<std::byte> widened(const std::vector<std::byte>& values, Element::Form form) {
  const size_t item = form == Element::Form::Int8 ? 1 : 2;
  std::vector<std::byte> out(values.size() / item * 4);
  for (size_t i = 0; i < values.size() / item; ++i) {
    uint32_t bits = 0;
    std::memcpy(&bits, values.data() + i * item, item);
    if (form == Element::Form::BFloat16) bits <<= 16U;
    if (form == Element::Form::Int8)
      bits = static_cast<uint32_t>(static_cast<int32_t>(static_cast<int8_t>(bits)));
    if (form == Element::Form::Int16)
      bits = static_cast<uint32_t>(static_cast<int32_t>(static_cast<int16_t>(bits)));
    std::memcpy(out.data() + i * 4, &bits, 4);
  }
  return out;
}

}  // namespace

TensorReader::TensorReader(const Storages& storages, std::string origin)
    : m_storages(storages),
      m_budget(kSpareBytes + kMaxUnfolding * storages.totalBytes),
      m_origin(std::move(origin)) {}

Place TensorReader::place(const std::string& path) const {
  return {.path = m_origin, .item = "tensor '" + path + "'"};
}

void TensorReader::refuseBeyond(const View& view, const std::string& path) const {
  throwInput(place(path), fmt::format("values within its storage of {}", view.storage->count),
             "offset {}, shape {}, strides {}", view.offset, shapeText(view.shape),
             shapeText(view.strides));
}

std::string_view TensorReader::storageBytes(const Storage& storage, const std::string& path) const {
  const auto found = m_storages.bytes.find(storage.key);
  if (found == m_storages.bytes.end())
    throwInput(place(path), "its storage", "no storage '{}'", printable(storage.key));
  const uint64_t size = found->second.size();
  if (storage.count > size || storage.count * storage.element.bytes() != size)
    throwInput(
        place(path),
        fmt::format("{} values of {} in its storage", storage.count, name(storage.element.dtype)),
        "{} bytes", size);
  return found->second;
}

uint64_t TensorReader::check(const View& view, const std::string& path) const {
  storageBytes(*view.storage, path);
  constexpr uint64_t kMaxCount = uint64_t{1} << 40;
  if (view.shape.size() > 64)
    throwInput(place(path), "at most 64 dimensions", "{}", view.shape.size());
  uint64_t count = 1;
  for (const int64_t size : view.shape) {
    const auto extent = static_cast<uint64_t>(size);
    if (extent > kMaxCount || (extent > 0 && count > kMaxCount / extent))
      throw InputError(place(path), "a sensible shape", shapeText(view.shape));
    count *= extent;
  }
  if (count == 0) return 0;
  const uint64_t available = view.storage->count;
  if (view.offset >= available) refuseBeyond(view, path);
  uint64_t last = view.offset;
  for (size_t d = 0; d < view.shape.size(); ++d) {
    const auto steps = static_cast<uint64_t>(view.shape[d] - 1);
    const auto stride = static_cast<uint64_t>(view.strides[d]);
    if (steps > 0 && stride > (available - 1 - last) / steps) refuseBeyond(view, path);
    last += steps * stride;
  }
  return count;
}

Tensor TensorReader::read(const View& view, const std::string& path) {
  const uint64_t count = check(view, path);
  const Element element = view.storage->element;
  const size_t item = element.bytes();
  if (count > m_budget / byteSize(element.dtype))
    throw InputError(place(path), "tensors in proportion to the file",
                     "a shape that unfolds " + shapeText(view.shape));
  m_budget -= count * byteSize(element.dtype);
  Tensor out{.dtype = element.dtype, .shape = view.shape, .bytes = {}};
  out.bytes.resize(count * item);
  const std::string_view bytes = storageBytes(*view.storage, path);
  if (count > 0 && isContiguous(view))
    std::memcpy(out.bytes.data(), bytes.data() + view.offset * item, count * item);
  else
    copyStrided(view, bytes, item, out.bytes);
  if (element.form != Element::Form::Plain) out.bytes = widened(out.bytes, element.form);
  return out;
}

}  // namespace marey::pickle
