#include "model/observation.h"

#include <cmath>

#include "base/error.h"
#include "base/random.h"

namespace marey {

Json toJson(const ObservationNoise& noise) {
  return {{"floor_mm", noise.floorMm()}, {"draws", noise.draws}};
}

ObservationNoise observationNoiseFromJson(const Json& value, const std::string& origin) {
  JsonReader reader(value, origin, "observation.");
  ObservationNoise out;
  const auto floor = reader.required<double>("floor_mm");
  out.draws = reader.required<int>("draws");
  reader.finish();
  if (!(floor > 0.0 && std::isfinite(floor)))
    throwInput(reader.place("floor_mm"), "millimetres above zero", "{}", floor);
  if (out.draws < 2 || out.draws > 1000 || out.draws % 2 != 0)
    throwInput(reader.place("draws"), "an even number from 2 to 1000", "{}", out.draws);
  out.floorM = 1e-3 * floor;
  return out;
}

Matrix observationNoise(const ObservationNoise& noise, int draw, long first, long rows,
                        long width) {
  Matrix out(rows, width);
  for (long t = 0; t < rows; ++t)
    fillNormal({.sample = static_cast<uint32_t>(draw / 2),
                .frame = static_cast<uint32_t>(first + t),
                .stage = RandomStage::Observation},
               {out.row(t).data(), static_cast<size_t>(width)});
  return out * static_cast<float>(draw % 2 == 0 ? noise.floorM : -noise.floorM);
}

}  // namespace marey
