#include "render/baseline.h"

#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>

#include "render/base/ssim.h"

namespace marey::render {

namespace {
/// SSIM looks at brightness alone; this sees a wrong colour of the same brightness.
double meanColourDifference(const Image& a, const Image& b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.pixels.size(); ++i) sum += std::abs(a.pixels[i] - b.pixels[i]);
  return sum / static_cast<double>(a.pixels.size());
}

testing::AssertionResult failure(const Image& image, const std::string& name,
                                 const std::string& why) {
  const std::filesystem::path kept = std::filesystem::current_path() / (name + ".png");
  writePng(kept, image);
  return testing::AssertionFailure() << why << "; the picture is in " << kept.string();
}
}  // namespace

testing::AssertionResult matchesBaselineIn(const std::string& folder, const Image& image,
                                           const std::string& name, double threshold) {
  const std::filesystem::path file = std::filesystem::path(folder) / (name + ".png");
  if (!std::filesystem::exists(file)) return failure(image, name, "no baseline " + file.string());
  const Image baseline = readPng(file);
  if (baseline.width != image.width || baseline.height != image.height) {
    return failure(image, name, "another size than " + file.string());
  }
  const double likeness = ssim(image, baseline);
  const double difference = meanColourDifference(image, baseline);
  constexpr double mostDifference = 1.0;  // of 255
  if (difference > mostDifference) {
    return failure(image, name,
                   fmt::format("colours differ by {:.2f} of 255 on average from {}", difference,
                               file.string()));
  }
  if (likeness >= threshold) return testing::AssertionSuccess();
  return failure(
      image, name,
      fmt::format("SSIM {:.4f} with {}, wanted {:.2f}", likeness, file.string(), threshold));
}

testing::AssertionResult matchesBaseline(const Image& image, const std::string& name,
                                         double threshold) {
  return matchesBaselineIn(MAREY_SOURCE_DIR "/tests/render/baselines", image, name, threshold);
}

}  // namespace marey::render
