// Weights in the order in which the kernels read them. No libtorch type appears here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "nn/engine/kernels/kernels.h"

namespace marey::nn {

/// How weights are kept; sums are float32 either way. BFloat16 halves what is read from memory,
/// which is what bounds small batches; weights keep 8 significant bits.
enum class Precision { Float32, BFloat16 };

/// Zeroed floats whose first one lies at a cache line.
class AlignedFloats {
 public:
  AlignedFloats() = default;
  explicit AlignedFloats(size_t count);
  AlignedFloats(const AlignedFloats& other);
  AlignedFloats& operator=(const AlignedFloats& other);
  AlignedFloats(AlignedFloats&& other) noexcept = default;
  AlignedFloats& operator=(AlignedFloats&& other) noexcept = default;

  float* data() { return m_values.get(); }
  const float* data() const { return m_values.get(); }
  size_t size() const { return m_size; }
  /// Makes room for at least so many; where that takes new memory, all values are zero.
  void reserve(long count);

 private:
  struct Free {
    void operator()(float* p) const;
  };
  std::unique_ptr<float[], Free> m_values;
  size_t m_size = 0;
};

/// [inputs] -> [columns], padded with zeros to whole panels of 32 columns. A panel holds one row of
/// 32 weights per input, so that a product reads it from its first byte to its last.
class PackedMatrix {
 public:
  PackedMatrix() = default;
  PackedMatrix(long inputs, long columns, Precision precision);

  /// Weights of one column from input `first` on. BFloat16 rounds to nearest, ties to even.
  void set(long column, long first, std::span<const float> weights);
  /// What `set` stored.
  void get(long column, long first, std::span<float> weights) const;

  long inputs() const { return m_inputs; }
  long panels() const { return m_panels; }
  Precision precision() const { return m_precision; }
  size_t bytes() const { return m_storage.size() * sizeof(float); }

  /// out[r][..] = start + the products of `inputs` with the weights from input `first` on, for
  /// the panels [begin, end); column 32 * begin goes to out[r][0], and start likewise.
  struct Product {
    std::span<const Inputs> inputs;
    long first = 0;
    long begin = 0, end = 0;
    const float* start = nullptr;
    long startStride = 0;
    float* out = nullptr;
    long outStride = 0;
    long rows = 0;
  };
  void multiply(const Product& product) const;

 private:
  const std::byte* panel(long index, long input) const;

  long m_inputs = 0, m_panels = 0;
  Precision m_precision = Precision::Float32;
  AlignedFloats m_storage;
};

}  // namespace marey::nn
