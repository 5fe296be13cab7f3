#include "nn/engine/row_matrix.h"

#include <algorithm>

namespace marey::nn {

RowMatrix::RowMatrix(long inputs, long columns)
    : m_inputs(inputs),
      m_columns(columns),
      m_padded((columns + kRowColumns - 1) / kRowColumns * kRowColumns),
      m_weights(static_cast<size_t>(inputs * m_padded)) {}

RowMatrix::RowMatrix(long inputs, long columns, std::span<const float> weights)
    : RowMatrix(inputs, columns) {
  for (long k = 0; k < inputs; ++k)
    std::copy_n(weights.data() + k * columns, columns, m_weights.data() + k * m_padded);
}

RowMatrix RowMatrix::transposed(long inputs, long columns, std::span<const float> weights) {
  RowMatrix out(inputs, columns);
  for (long k = 0; k < inputs; ++k)
    for (long j = 0; j < columns; ++j)
      out.m_weights.data()[k * out.m_padded + j] = weights[static_cast<size_t>(j * inputs + k)];
  return out;
}

void RowMatrix::addTo(std::span<const double> x, std::span<double> out) const {
  kernels().rowProduct({.x = x.data(),
                        .inputs = m_inputs,
                        .weights = m_weights.data(),
                        .columns = m_padded,
                        .out = out.data()});
}

}  // namespace marey::nn
