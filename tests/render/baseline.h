// Comparison of a picture with the one kept in tests/render/baselines.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "render/base/image.h"

namespace marey::render {

/// Succeeds when baselines/NAME.png is as large, at least `threshold` alike (SSIM) and its colours
/// differ by at most 1 of 255 on average. 0.97 lets another driver or font version round edges
/// differently; a limb or a label that moves by more than a pixel or two falls below. A missing or
/// different baseline fails, and the picture is kept as NAME.png in the working folder, to be
/// looked at and copied.
testing::AssertionResult matchesBaseline(const Image& image, const std::string& name,
                                         double threshold = 0.97);
/// The same with another folder of baselines.
testing::AssertionResult matchesBaselineIn(const std::string& folder, const Image& image,
                                           const std::string& name, double threshold);

}  // namespace marey::render
