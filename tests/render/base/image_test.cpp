#include "render/base/image.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "render/base/ssim.h"

namespace marey::render {
namespace {

Image pattern(int width, int height, bool noisy) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int value = (x * 7 + y * 13 + (noisy ? (x * y) % 17 : 0)) % 256;
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = static_cast<uint8_t>(value);
    }
  }
  return image;
}

TEST(Image, APngComesBackAsItWas) {
  Image image = pattern(37, 19, true);
  image.at(3, 4)[0] = 200;
  image.at(5, 6)[3] = 17;
  const Image back = decodePng(encodePng(image), "memory");
  EXPECT_EQ(back.width, 37);
  EXPECT_EQ(back.height, 19);
  EXPECT_EQ(back.pixels, image.pixels);
}

TEST(Image, APngCarriesItsRecipeAlsoWithLettersBeyondAscii) {
  const std::string plain = encodePng(Image(4, 4), {{"seed", "7"}, {"model", "abc"}});
  EXPECT_EQ(pngRecipe(plain, "memory"), R"({"seed":"7","model":"abc"})");
  const std::string accents = encodePng(Image(4, 4), {{"name", "Étienne-Jules"}});
  EXPECT_EQ(pngRecipe(accents, "memory"), R"({"name":"Étienne-Jules"})");
  EXPECT_EQ(pngRecipe(encodePng(Image(4, 4)), "memory"), "");
}

TEST(Image, ADamagedPngIsRefusedByName) {
  const std::string bytes = encodePng(pattern(30, 30, true));
  for (const size_t length : {size_t{0}, size_t{5}, size_t{40}, bytes.size() / 2}) {
    try {
      decodePng(std::string_view(bytes).substr(0, length), "half.png");
      FAIL() << "read from " << length << " bytes";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("half.png"), std::string::npos);
    }
  }
}

TEST(Image, Base64FollowsTheExamplesOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(Ssim, EqualPicturesScoreOne) {
  EXPECT_DOUBLE_EQ(ssim(pattern(40, 32, true), pattern(40, 32, true)), 1.0);
}

// numpy: the same two patterns, means by scipy.signal.convolve2d(mode='valid') with the normalised
// 11x11 Gaussian of sigma 1.5, then equation 13 with C1 = 2.55^2, C2 = 7.65^2, averaged.
TEST(Ssim, AgreesWithAComputationInNumpy) {
  EXPECT_NEAR(ssim(pattern(40, 32, false), pattern(40, 32, true)), 0.8266707257744572, 2e-4);
}

TEST(Ssim, BlackAgainstWhiteScoresNearZero) {
  // (2 * 255 * 0 + C1) / (255^2 + 0 + C1) with C1 = 6.5025: luminance alone, no structure.
  EXPECT_NEAR(ssim(Image(20, 20, {0, 0, 0, 1}), Image(20, 20)), 6.5025 / (65025.0 + 6.5025), 1e-6);
}

TEST(Ssim, AMovedPictureScoresBelowTheThresholdOfBaselines) {
  Image a(60, 60), b(60, 60);
  for (int y = 10; y < 50; ++y) {
    for (int x = 28; x < 32; ++x) {
      for (int c = 0; c < 3; ++c) a.at(x, y)[c] = b.at(x + 4, y)[c] = 30;
    }
  }
  EXPECT_LT(ssim(a, b), 0.9);
}

TEST(Ssim, OtherSizesAreRefused) {
  EXPECT_THROW(ssim(Image(20, 20), Image(20, 21)), InputError);
  EXPECT_THROW(ssim(Image(10, 20), Image(10, 20)), InputError);
}

TEST(Colours, OnlyNearBlackIsLiftedFromADarkBackground) {
  EXPECT_GT(onDark(naturalColour()).r, 0.8);
  EXPECT_EQ(onDark(withOpacity(naturalColour(), 0.3)).a, 0.3);
  for (const double share : {0.0, 0.5, 1.0})
    EXPECT_EQ(onDark(scaleColour(share)), scaleColour(share))
        << "it would no longer mean its value";
  for (int system = 0; system < 12; ++system) EXPECT_EQ(onDark(colourOf(system)), colourOf(system));
}

}  // namespace
}  // namespace marey::render
