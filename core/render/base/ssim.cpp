#include "render/base/ssim.h"

#include <array>
#include <cmath>

#include "base/error.h"

namespace marey::render {

namespace {
constexpr int window = 11;

std::array<double, window> gaussianWindow() {
  std::array<double, window> weights{};
  double sum = 0.0;
  for (int i = 0; i < window; ++i) {
    const double x = i - 0.5 * (window - 1);
    weights[static_cast<size_t>(i)] = std::exp(-x * x / (2.0 * 1.5 * 1.5));
    sum += weights[static_cast<size_t>(i)];
  }
  for (double& w : weights) w /= sum;
  return weights;
}

struct Plane {
  int width = 0, height = 0;
  std::vector<double> values;
  double at(int x, int y) const { return values[static_cast<size_t>(y) * width + x]; }
};

Plane lumaOf(const Image& image) {
  Plane plane{image.width, image.height, {}};
  plane.values.reserve(image.pixels.size() / 4);
  for (size_t i = 0; i < image.pixels.size(); i += 4) {
    plane.values.push_back(0.299 * image.pixels[i] + 0.587 * image.pixels[i + 1] +
                           0.114 * image.pixels[i + 2]);
  }
  return plane;
}

Plane product(const Plane& a, const Plane& b) {
  Plane result = a;
  for (size_t i = 0; i < result.values.size(); ++i) result.values[i] *= b.values[i];
  return result;
}

/// Weighted means where the window fits: (width - 10) x (height - 10).
Plane windowMeans(const Plane& plane) {
  static const auto weights = gaussianWindow();
  Plane rows{plane.width - window + 1, plane.height, {}};
  rows.values.assign(static_cast<size_t>(rows.width) * rows.height, 0.0);
  for (int y = 0; y < rows.height; ++y) {
    for (int x = 0; x < rows.width; ++x) {
      double& sum = rows.values[static_cast<size_t>(y) * rows.width + x];
      for (int k = 0; k < window; ++k) sum += weights[static_cast<size_t>(k)] * plane.at(x + k, y);
    }
  }
  Plane means{rows.width, plane.height - window + 1, {}};
  means.values.assign(static_cast<size_t>(means.width) * means.height, 0.0);
  for (int y = 0; y < means.height; ++y) {
    for (int x = 0; x < means.width; ++x) {
      double& sum = means.values[static_cast<size_t>(y) * means.width + x];
      for (int k = 0; k < window; ++k) sum += weights[static_cast<size_t>(k)] * rows.at(x, y + k);
    }
  }
  return means;
}
}  // namespace

double ssim(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.width < window || a.height < window) {
    throwInput({.path = "image comparison"}, "two images of the same size, 11x11 or larger",
               "{}x{} and {}x{}", a.width, a.height, b.width, b.height);
  }
  const Plane x = lumaOf(a), y = lumaOf(b);
  const Plane meanX = windowMeans(x), meanY = windowMeans(y);
  const Plane squareX = windowMeans(product(x, x)), squareY = windowMeans(product(y, y));
  const Plane cross = windowMeans(product(x, y));
  constexpr double c1 = (0.01 * 255) * (0.01 * 255), c2 = (0.03 * 255) * (0.03 * 255);
  double sum = 0.0;
  for (size_t i = 0; i < cross.values.size(); ++i) {
    const double mx = meanX.values[i], my = meanY.values[i];
    const double varX = squareX.values[i] - mx * mx, varY = squareY.values[i] - my * my;
    const double covariance = cross.values[i] - mx * my;
    sum += (2 * mx * my + c1) * (2 * covariance + c2) /
           ((mx * mx + my * my + c1) * (varX + varY + c2));
  }
  return sum / static_cast<double>(cross.values.size());
}

}  // namespace marey::render
