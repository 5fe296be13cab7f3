#include "io/npz_values.h"

#include <cmath>

namespace marey::io {

Place placeOf(const std::string& origin, const std::string& array) {
  return {.path = origin, .item = "array '" + array + "'"};
}

std::vector<Vec3> vectors(const Tensor& tensor) {
  const std::vector<float> values = tensor.toFloats();
  std::vector<Vec3> out(values.size() / 3);
  for (size_t i = 0; i < out.size(); ++i)
    out[i] = Vec3(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
  return out;
}

std::optional<double> rateIn(const NpzArrays& arrays, const std::string& origin) {
  for (const char* name : {"fps", "mocap_framerate", "mocap_frame_rate", "frame_rate"}) {
    const auto found = arrays.numbers.find(name);
    if (found == arrays.numbers.end()) {
      if (!arrays.contains(name)) continue;
      throw InputError(placeOf(origin, name), "one positive number", "no number");
    }
    const Tensor& fps = found->second;
    const std::vector<double> values = fps.count() == 1 ? fps.toDoubles() : std::vector<double>{};
    if (values.empty() || !(values[0] > 0.0) || !std::isfinite(values[0]))
      throw InputError(placeOf(origin, name), "one positive number",
                       values.empty() ? fps.shapeText() : fmt::format("{}", values[0]));
    return values[0];
  }
  return std::nullopt;
}

}  // namespace marey::io
