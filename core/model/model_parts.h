// Small parts that models of several families are made of. No libtorch type appears here.
#pragma once

#include "model/motion_model.h"

namespace marey {

/// The model's standardiser; zeros and ones where it has none.
Standardiser unitsOf(const ModelInfo& info);

/// (value - mean) / std of each of mean.size() dimensions, again and again over `count` values.
void standardise(const float* values, long count, const std::vector<float>& mean,
                 const std::vector<float>& std, float* out);

/// What a configuration says of its models, whatever the family: names, sizes and the
/// hyper-parameters as used.
ModelInfo describedInfo(const std::string& family, const Json& config, int poseDim, int controlDim,
                        Json used);
/// Throws InputError unless a stored model has the sizes of its configuration.
void requireStoredSizes(const ModelInfo& info, int poseDim, int controlDim,
                        const std::string& origin);

/// Throws InputError naming `what`.
void requireShape(const char* what, const Matrix& matrix, long rows, long columns);

}  // namespace marey
