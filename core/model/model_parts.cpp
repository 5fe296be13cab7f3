#include "model/model_parts.h"

#include "base/error.h"

namespace marey {

Standardiser unitsOf(const ModelInfo& info) {
  const auto filled = [](const std::vector<float>& values, int size, float fallback) {
    return values.empty() ? std::vector<float>(static_cast<size_t>(size), fallback) : values;
  };
  const Standardiser& s = info.standardiser;
  return {filled(s.poseMean, info.poseDim, 0.f), filled(s.poseStd, info.poseDim, 1.f),
          filled(s.controlMean, info.controlDim, 0.f), filled(s.controlStd, info.controlDim, 1.f)};
}

void standardise(const float* values, long count, const std::vector<float>& mean,
                 const std::vector<float>& std, float* out) {
  const auto width = static_cast<long>(mean.size());
  for (long i = 0; i < count; i += width)
    for (long j = 0; j < width; ++j)
      out[i + j] = (values[i + j] - mean[static_cast<size_t>(j)]) / std[static_cast<size_t>(j)];
}

ModelInfo describedInfo(const std::string& family, const Json& config, int poseDim, int controlDim,
                        Json used) {
  ModelInfo out;
  out.family = family;
  if (config.contains("name") && config["name"].is_string()) out.variant = config["name"];
  out.poseDim = poseDim;
  out.controlDim = controlDim;
  out.config = std::move(used);
  return out;
}

void requireStoredSizes(const ModelInfo& info, int poseDim, int controlDim,
                        const std::string& origin) {
  if (poseDim != info.poseDim || controlDim != info.controlDim)
    throwInput({.path = origin}, "a configuration of the stored dimensions", "{}/{} beside {}/{}",
               poseDim, controlDim, info.poseDim, info.controlDim);
}

void requireShape(const char* what, const Matrix& m, long rows, long columns) {
  if (m.rows() != rows || m.cols() != columns)
    throwInput({.path = what}, fmt::format("{} x {}", rows, columns), "{} x {}", m.rows(),
               m.cols());
}

}  // namespace marey
