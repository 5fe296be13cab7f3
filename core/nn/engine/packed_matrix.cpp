#include "nn/engine/packed_matrix.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace marey::nn {
namespace {

constexpr size_t kCacheLine = 64, kLargePage = size_t{2} << 20;

/// Large pages spare the processor most look-ups of addresses. Whole ones within the storage only:
/// no memory is added.
void askForLargePages([[maybe_unused]] void* memory, [[maybe_unused]] size_t bytes) {
#ifdef __linux__
  if (bytes >= kLargePage) madvise(memory, bytes / kLargePage * kLargePage, MADV_HUGEPAGE);
#endif
}

uint16_t toBf16(float value) {
  const auto bits = std::bit_cast<uint32_t>(value);
  return static_cast<uint16_t>((bits + 0x7FFFu + ((bits >> 16) & 1u)) >> 16);
}

float fromBf16(uint16_t value) {
  return std::bit_cast<float>(uint32_t{value} << 16);
}

/// Place of a column within a row of 32 bf16 values: column j shares a word with column 16 + j.
long bf16Place(long column) {
  return 2 * (column % kLanes) + column / kLanes;
}

size_t rowBytes(Precision precision) {
  return (precision == Precision::Float32 ? sizeof(float) : sizeof(uint16_t)) * kPanel;
}

}  // namespace

// ---- AlignedFloats

AlignedFloats::AlignedFloats(size_t count) : m_size((count + kLanes - 1) / kLanes * kLanes) {
  if (m_size == 0) return;
  const size_t bytes = m_size * sizeof(float);
  void* memory = nullptr;
  if (posix_memalign(&memory, bytes >= kLargePage ? kLargePage : kCacheLine, bytes) != 0)
    throw std::bad_alloc();
  askForLargePages(memory, bytes);
  std::memset(memory, 0, bytes);
  m_values.reset(static_cast<float*>(memory));
}

void AlignedFloats::reserve(long count) {
  if (static_cast<long>(m_size) < count) *this = AlignedFloats(static_cast<size_t>(count));
}

AlignedFloats::AlignedFloats(const AlignedFloats& other) : AlignedFloats(other.m_size) {
  if (m_size > 0) std::memcpy(data(), other.data(), m_size * sizeof(float));
}

AlignedFloats& AlignedFloats::operator=(const AlignedFloats& other) {
  if (this != &other) *this = AlignedFloats(other);
  return *this;
}

void AlignedFloats::Free::operator()(float* p) const {
  std::free(p);
}

// ---- PackedMatrix

PackedMatrix::PackedMatrix(long inputs, long columns, Precision precision)
    : m_inputs(inputs),
      m_panels((columns + kPanel - 1) / kPanel),
      m_precision(precision),
      m_storage(static_cast<size_t>(m_panels * inputs) * rowBytes(precision) / sizeof(float)) {}

const std::byte* PackedMatrix::panel(long index, long input) const {
  return reinterpret_cast<const std::byte*>(m_storage.data()) +
         static_cast<size_t>(index * m_inputs + input) * rowBytes(m_precision);
}

void PackedMatrix::set(long column, long first, std::span<const float> weights) {
  auto* row = const_cast<std::byte*>(panel(column / kPanel, first));
  const long at = column % kPanel;
  for (const float weight : weights) {
    if (m_precision == Precision::Float32)
      reinterpret_cast<float*>(row)[at] = weight;
    else
      reinterpret_cast<uint16_t*>(row)[bf16Place(at)] = toBf16(weight);
    row += rowBytes(m_precision);
  }
}

void PackedMatrix::get(long column, long first, std::span<float> weights) const {
  const std::byte* row = panel(column / kPanel, first);
  const long at = column % kPanel;
  for (float& weight : weights) {
    weight = m_precision == Precision::Float32
                 ? reinterpret_cast<const float*>(row)[at]
                 : fromBf16(reinterpret_cast<const uint16_t*>(row)[bf16Place(at)]);
    row += rowBytes(m_precision);
  }
}

void PackedMatrix::multiply(const Product& p) const {
  const Kernels& k = kernels();
  const auto product = m_precision == Precision::Float32 ? k.product : k.productBf16;
  for (long i = p.begin; i < p.end; i += 2) {
    const long column = (i - p.begin) * kPanel;
    const int panels = i + 1 < p.end ? 2 : 1;
    product({.inputs = p.inputs.data(),
             .runs = static_cast<int>(p.inputs.size()),
             .panel = panel(i, p.first),
             .panels = panels,
             .panelBytes = m_inputs * static_cast<long>(rowBytes(m_precision)),
             .next = panel(std::min(i + panels, m_panels - 1), p.first),
             .start = p.start + column,
             .startStride = p.startStride,
             .out = p.out + column,
             .outStride = p.outStride,
             .rows = p.rows});
  }
}

}  // namespace marey::nn
