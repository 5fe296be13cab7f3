// Matrices for products of one row in double precision: exact enough for what a nearly singular
// density magnifies, and the same bits on every set of kernels. No libtorch type appears here.
#pragma once

#include <span>

#include "nn/engine/packed_matrix.h"

namespace marey::nn {

/// [inputs] -> [columns]; float weights, sums in double, in the order of the inputs.
class RowMatrix {
 public:
  RowMatrix() = default;
  /// `weights` [inputs, columns], row-major.
  RowMatrix(long inputs, long columns, std::span<const float> weights);
  /// From `weights` [columns, inputs], as they are for matrices that multiply from the left.
  static RowMatrix transposed(long inputs, long columns, std::span<const float> weights);

  long inputs() const { return m_inputs; }
  long columns() const { return m_columns; }
  /// Length of what `addTo` writes: the columns, filled up with zeros.
  long paddedColumns() const { return m_padded; }
  /// out[j] += sum over k of x[k] * weights[k][j]; `x` [inputs], `out` [paddedColumns].
  void addTo(std::span<const double> x, std::span<double> out) const;

 private:
  RowMatrix(long inputs, long columns);

  long m_inputs = 0, m_columns = 0, m_padded = 0;
  AlignedFloats m_weights;
};

}  // namespace marey::nn
