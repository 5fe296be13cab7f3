// The stored tensors of a base, read into what the engine's bases keep. Internal to them.
#pragma once

#include <string>
#include <vector>

#include "base/tensor_file.h"
#include "nn/engine/row_matrix.h"

namespace marey::moglow {

class BaseTensors {
 public:
  /// Those stored as "weights/NAME...".
  BaseTensors(const TensorFile& file, const std::string& name)
      : m_file(file), m_prefix("weights/" + name + ".") {}

  std::vector<double> numbers(const std::string& name) const { return at(name).toDoubles(); }
  double number(const std::string& name) const { return numbers(name).front(); }
  /// [inputs, columns] as stored.
  nn::RowMatrix matrix(const std::string& name) const {
    const Tensor& tensor = at(name);
    return {tensor.shape[0], tensor.shape[1], tensor.toFloats()};
  }
  /// [columns, inputs] as stored.
  nn::RowMatrix transposed(const std::string& name) const {
    const Tensor& tensor = at(name);
    return nn::RowMatrix::transposed(tensor.shape[1], tensor.shape[0], tensor.toFloats());
  }
  /// One matrix per regime: [regimes, inputs, columns], or [regimes, columns, inputs].
  std::vector<nn::RowMatrix> matrices(const std::string& name, bool transposed) const {
    const Tensor& tensor = at(name);
    const auto values = tensor.toFloats();
    const long rows = tensor.shape[1], columns = tensor.shape[2];
    const auto size = static_cast<size_t>(rows * columns);
    std::vector<nn::RowMatrix> out;
    for (size_t i = 0; i < static_cast<size_t>(tensor.shape[0]); ++i) {
      const std::span own(values.data() + i * size, size);
      out.push_back(transposed ? nn::RowMatrix::transposed(columns, rows, own)
                               : nn::RowMatrix(rows, columns, own));
    }
    return out;
  }

 private:
  const Tensor& at(const std::string& name) const { return m_file.tensors.at(m_prefix + name); }

  const TensorFile& m_file;
  std::string m_prefix;
};

}  // namespace marey::moglow
