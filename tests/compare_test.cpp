#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "verdure/compare.h"
#include "verdure/error.h"

namespace verdure {
namespace {

Image filled(int width, int height, int r, int g, int b) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    image.rgba[i] = static_cast<std::uint8_t>(r);
    image.rgba[i + 1] = static_cast<std::uint8_t>(g);
    image.rgba[i + 2] = static_cast<std::uint8_t>(b);
    image.rgba[i + 3] = 255;
  }
  return image;
}

Image pattern(int width, int height) {
  Image image = filled(width, height, 0, 0, 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      std::uint8_t* p = image.at(x, y);
      const bool on = (x / 8 + y / 8) % 2 == 0;
      p[0] = on ? 200 : 40;
      p[1] = static_cast<std::uint8_t>(120 + 60 * std::sin(0.2 * x));
      p[2] = on ? 60 : 90;
    }
  return image;
}

Image noisy(const Image& image, int amplitude) {
  Random random(5);
  Image out = image;
  for (std::size_t i = 0; i < out.rgba.size(); ++i)
    if (i % 4 != 3) {
      const int moved = out.rgba[i] + static_cast<int>(random.vary(static_cast<float>(amplitude)));
      out.rgba[i] = static_cast<std::uint8_t>(std::clamp(moved, 0, 255));
    }
  return out;
}

Image blurred(const Image& image, int radius) {
  Image out = image;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) {
        int sum = 0;
        for (int k = -radius; k <= radius; ++k)
          sum += image.at(std::clamp(x + k, 0, image.width - 1), y)[c];
        out.at(x, y)[c] = static_cast<std::uint8_t>(sum / (2 * radius + 1));
      }
  return out;
}

TEST(Flip, IsZeroForTheSameAndSymmetric) {
  const Image image = pattern(64, 48), other = noisy(image, 30);
  EXPECT_EQ(meanFlip(image, image), 0.0);
  EXPECT_GT(meanFlip(image, other), 0.01);
  EXPECT_DOUBLE_EQ(meanFlip(image, other), meanFlip(other, image));
}

TEST(Flip, OfBlackAndWhiteIsNearOne) {
  // Lightness differs by 100. The largest HyAB distance is that of green, CIELab (87.73, -86.18,
  // 83.18), and blue, (32.30, 79.19, -107.86), after Hunt's factor L/100 on a and b: 203.3. Then
  // (100 / 203.3)^0.7 = 0.6086, above the knee of 0.4: 0.95 + (0.6086 - 0.4) / 0.6 * 0.05 = 0.9674.
  EXPECT_NEAR(meanFlip(filled(32, 32, 0, 0, 0), filled(32, 32, 255, 255, 255)), 0.9674, 0.0005);
  EXPECT_NEAR(meanFlip(filled(32, 32, 0, 255, 0), filled(32, 32, 0, 0, 255)), 1.0, 0.001);
}

TEST(Flip, GrowsWithNoiseAndBlur) {
  const Image image = pattern(64, 48);
  double last = 0.0;
  for (const int amplitude : {4, 12, 40, 100}) {
    const double flip = meanFlip(image, noisy(image, amplitude));
    EXPECT_GT(flip, last);
    last = flip;
  }
  last = 0.0;
  for (const int radius : {1, 2, 4}) {
    const double flip = meanFlip(image, blurred(image, radius));
    EXPECT_GT(flip, last);
    last = flip;
  }
}

TEST(Flip, SeesLessFromAfar) {
  // Fine noise vanishes when a degree of vision holds many pixels.
  const Image image = pattern(64, 48), other = noisy(image, 40);
  EXPECT_LT(meanFlip(image, other, 200.0f), meanFlip(image, other, 20.0f));
}

TEST(Flip, RefusesDifferentSizes) {
  EXPECT_THROW(meanFlip(pattern(8, 8), pattern(8, 9)), Error);
  EXPECT_THROW(meanFlip(Image{}, Image{}), Error);
}

}  // namespace
}  // namespace verdure
