#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "base/parallel.h"
#include "base/random.h"
#include "shared/color.h"
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

/// FLIP as Andersson et al. 2020 write it down: whole two-dimensional kernels, in double.
class PlainFlip {
 public:
  using Pixels = std::vector<glm::dvec3>;

  PlainFlip(int width, int height, double pixels_per_degree)
      : width_(width), height_(height), ppd_(pixels_per_degree) {}

  /// Of linear RGB in [0, 1].
  std::vector<double> map(const Pixels& a, const Pixels& b) const {
    const double most = std::pow(hyab(lab({0, 1, 0}), lab({0, 0, 1})), 0.7);
    const Pixels seen_a = seen(a), seen_b = seen(b);
    const auto features_a = features(a), features_b = features(b);
    std::vector<double> out;
    for (std::size_t i = 0; i < a.size(); ++i) {
      double color = std::pow(hyab(seen_a[i], seen_b[i]), 0.7);
      color = color < 0.4 * most ? 0.95 / (0.4 * most) * color
                                 : 0.95 + (color - 0.4 * most) / (0.6 * most) * 0.05;
      const double feature = std::max(std::abs(features_a[i].x - features_b[i].x),
                                      std::abs(features_a[i].y - features_b[i].y));
      out.push_back(std::pow(color, 1.0 - std::sqrt(feature / std::sqrt(2.0))));
    }
    return out;
  }

 private:
  static glm::dvec3 xyz(const glm::dvec3& c) {  // relative to the white
    return glm::dvec3(glm::dot(c, glm::dvec3(10135552., 8788810., 4435075.)) / 24577794.,
                      glm::dot(c, glm::dvec3(2613072., 8788810., 887015.)) / 12288897.,
                      glm::dot(c, glm::dvec3(1425312., 8788810., 70074185.)) / 73733382.) /
           white();
  }
  static glm::dvec3 white() { return {0.950428545, 1.0, 1.088900371}; }
  static glm::dvec3 ycxcz(const glm::dvec3& c) {
    const glm::dvec3 r = xyz(c);
    return {116 * r.y - 16, 500 * (r.x - r.y), 200 * (r.y - r.z)};
  }
  static glm::dvec3 linear(const glm::dvec3& c) {
    const double y = (c.x + 16) / 116;
    const glm::dvec3 r(y + c.y / 500, y, y - c.z / 200);
    // Columns of the matrix are the images of red, green and blue.
    const glm::dmat3 m(xyz({1, 0, 0}), xyz({0, 1, 0}), xyz({0, 0, 1}));
    return glm::clamp(glm::inverse(m) * r, 0.0, 1.0);
  }
  static glm::dvec3 lab(const glm::dvec3& c) {
    const auto f = [](double t) {
      return t > 216. / 24389. ? std::cbrt(t) : t * 841. / 108. + 4. / 29.;
    };
    const glm::dvec3 r = xyz(c);
    const double l = 116 * f(r.y) - 16;
    return {l, 0.01 * l * 500 * (f(r.x) - f(r.y)), 0.01 * l * 200 * (f(r.y) - f(r.z))};
  }
  static double hyab(const glm::dvec3& a, const glm::dvec3& b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
  }

  /// sum of value(x + dx, y + dy) kernel(dx, dy).
  double gather(int x, int y, int reach, const std::function<double(int, int)>& kernel,
                const std::function<double(std::size_t)>& value) const {
    double sum = 0;
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx) {
        const int xx = std::clamp(x + dx, 0, width_ - 1), yy = std::clamp(y + dy, 0, height_ - 1);
        sum += kernel(dx, dy) * value(static_cast<std::size_t>(yy * width_ + xx));
      }
    return sum;
  }

  Pixels seen(const Pixels& image) const {
    constexpr double a1[3] = {1, 1, 34.1}, b1[3] = {0.0047, 0.0053, 0.04};
    constexpr double a2[3] = {0, 0, 13.5}, b2[3] = {1e-5, 1e-5, 0.025};
    const int reach = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * M_PI * M_PI)) * ppd_));
    Pixels out;
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        glm::dvec3 blurred;
        for (int c = 0; c < 3; ++c) {
          const auto kernel = [&](int dx, int dy) {
            const double d2 = (dx * dx + dy * dy) / (ppd_ * ppd_);
            return a1[c] * std::sqrt(M_PI / b1[c]) * std::exp(-M_PI * M_PI * d2 / b1[c]) +
                   a2[c] * std::sqrt(M_PI / b2[c]) * std::exp(-M_PI * M_PI * d2 / b2[c]);
          };
          blurred[c] =
              gather(x, y, reach, kernel, [&](std::size_t i) { return ycxcz(image[i])[c]; }) /
              gather(x, y, reach, kernel, [](std::size_t) { return 1.0; });
        }
        out.push_back(lab(linear(blurred)));
      }
    return out;
  }

  /// x: edges, y: points.
  std::vector<glm::dvec2> features(const Pixels& image) const {
    const double deviation = 0.5 * 0.082 * ppd_;
    const int reach = static_cast<int>(std::ceil(3 * deviation));
    const auto weight = [&](int kind, int along, int across) {
      const double g = std::exp(-(along * along + across * across) / (2 * deviation * deviation));
      return g * (kind == 0 ? -along : along * along / (deviation * deviation) - 1);
    };
    double positive[2] = {}, negative[2] = {};
    for (int kind = 0; kind < 2; ++kind)
      for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx) {
          const double w = weight(kind, dx, dy);
          (w > 0 ? positive : negative)[kind] += std::abs(w);
        }
    std::vector<glm::dvec2> out;
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        glm::dvec2 strength;
        for (int kind = 0; kind < 2; ++kind) {
          double parts[2];
          for (int axis = 0; axis < 2; ++axis)
            parts[axis] = gather(
                x, y, reach,
                [&](int dx, int dy) {
                  const double w = axis == 0 ? weight(kind, dx, dy) : weight(kind, dy, dx);
                  return w / (w > 0 ? positive : negative)[kind];
                },
                [&](std::size_t i) { return (ycxcz(image[i]).x + 16) / 116; });
          strength[kind] = std::hypot(parts[0], parts[1]);
        }
        out.push_back(strength);
      }
    return out;
  }

  int width_, height_;
  double ppd_;
};

PlainFlip::Pixels linearPixels(const Image& image) {
  PlainFlip::Pixels out;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    glm::dvec3 c;
    for (int k = 0; k < 3; ++k) {
      const double s = image.rgba[i + static_cast<std::size_t>(k)] / 255.0;
      c[k] = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    }
    out.push_back(c);
  }
  return out;
}

TEST(Flip, IsThePapersSumOverWholeKernels) {
  const Image a = pattern(37, 19), b = blurred(noisy(a, 50), 1);
  for (const float ppd : {14.0f, 30.0f}) {
    const std::vector<double> plain = PlainFlip(37, 19, ppd).map(linearPixels(a), linearPixels(b));
    const ErrorMap map = flip(a, b, ppd);
    for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_NEAR(map.values[i], plain[i], 2e-4);
  }
}

HdrImage hdrPattern(int width, int height, std::uint32_t seed) {
  HdrImage image(width, height);
  Random random(seed);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.at(x, y) = std::exp2(static_cast<float>(x) / 3.0f - 4.0f) *
                       glm::vec3(random.uniform(0.5f, 1.0f), random.uniform(0.2f, 1.0f),
                                 (y / 4) % 2 == 0 ? 1.0f : 0.1f);
  return image;
}

TEST(HdrFlip, IsTheLargestFlipOverTheExposures) {
  const HdrImage a = hdrPattern(25, 17, 1), b = hdrPattern(25, 17, 2);
  const HdrFlip result = hdrFlip(a, b, 14.0f);
  const auto aces = [](double x) {
    x *= 0.6;
    return std::min(1.0, x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14));
  };
  std::vector<double> y;
  for (const glm::vec3& c : a.rgb) y.push_back(0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z);
  std::sort(y.begin(), y.end());
  EXPECT_NEAR(aces(y.back() * std::exp2(result.start_exposure)), 0.85, 1e-5);
  EXPECT_NEAR(aces(y[y.size() / 2] * std::exp2(result.stop_exposure)), 0.85, 1e-5);
  EXPECT_EQ(result.exposures, std::ceil(std::log2(y.back() / y[y.size() / 2])));
  std::vector<double> most(y.size());
  for (int i = 0; i < result.exposures; ++i) {
    const double share = static_cast<double>(i) / (result.exposures - 1);
    const double exposure =
        glm::mix(double{result.start_exposure}, double{result.stop_exposure}, share);
    const auto shown = [&](const HdrImage& image) {
      PlainFlip::Pixels out;
      for (const glm::vec3& c : image.rgb) {
        const glm::dvec3 x = glm::dvec3(c) * std::exp2(exposure);
        out.emplace_back(aces(x.x), aces(x.y), aces(x.z));
      }
      return out;
    };
    const std::vector<double> map = PlainFlip(25, 17, 14.0).map(shown(a), shown(b));
    for (std::size_t p = 0; p < map.size(); ++p) most[p] = std::max(most[p], map[p]);
  }
  for (std::size_t p = 0; p < most.size(); ++p) EXPECT_NEAR(result.map.values[p], most[p], 4e-4);
}

TEST(HdrFlip, KnowsNoUnit) {
  // Exposures follow the reference: kcd/m^2 or cd/m^2 are the same.
  const HdrImage a = hdrPattern(25, 17, 1), b = hdrPattern(25, 17, 2);
  HdrImage a1000 = a, b1000 = b;
  for (glm::vec3& c : a1000.rgb) c *= 1024.0f;
  for (glm::vec3& c : b1000.rgb) c *= 1024.0f;
  EXPECT_NEAR(hdrFlip(a, b).map.mean(), hdrFlip(a1000, b1000).map.mean(), 1e-5);
  EXPECT_EQ(hdrFlip(a, a).map.mean(), 0.0);
}

TEST(HdrFlip, TakesBlackAndBlindingImages) {
  HdrImage black(12, 12), sun(12, 12);
  EXPECT_EQ(hdrFlip(black, black).map.mean(), 0.0);
  sun.at(3, 3) = glm::vec3(1e30f);
  for (const auto& [a, b] : {std::pair(&black, &sun), std::pair(&sun, &black)}) {
    const HdrFlip flip = hdrFlip(*a, *b);
    for (const float v : flip.map.values) {
      EXPECT_GE(v, 0.0f);
      EXPECT_LE(v, 1.0f + 1e-5f);
    }
    EXPECT_GT(flip.map.mean(), 0.0);
  }
}

TEST(Psnr, OfAConstantOffsetIsItsClosedForm) {
  for (const int offset : {1, 5, 200})
    EXPECT_NEAR(psnr(filled(9, 7, 20, 30, 40), filled(9, 7, 20 + offset, 30 + offset, 40 + offset)),
                20.0 * std::log10(255.0 / offset), 1e-9);
  // Only one channel: a third of the error.
  EXPECT_NEAR(psnr(filled(9, 7, 20, 30, 40), filled(9, 7, 20, 40, 40)),
              10.0 * std::log10(255.0 * 255.0 * 3.0 / 100.0), 1e-9);
  EXPECT_EQ(psnr(filled(9, 7, 1, 2, 3), filled(9, 7, 1, 2, 3)),
            std::numeric_limits<double>::infinity());
  HdrImage a(8, 8), b(8, 8);
  std::fill(a.rgb.begin(), a.rgb.end(), glm::vec3(2.0f, 8.0f, 1.0f));
  std::fill(b.rgb.begin(), b.rgb.end(), glm::vec3(2.5f, 8.5f, 1.5f));
  EXPECT_NEAR(psnr(a, b), 20.0 * std::log10(16.0), 1e-9);
  EXPECT_NEAR(psnr(a, b, 5.0f), 20.0, 1e-9);
  EXPECT_THROW(psnr(a, b, 0.0f), Error);
}

TEST(Ssim, OfEvenImagesIsItsLuminanceTerm) {
  const double c1 = 2.55 * 2.55;
  EXPECT_NEAR(ssim(filled(20, 15, 50, 50, 50), filled(20, 15, 100, 100, 100)),
              (2 * 50 * 100 + c1) / (50 * 50 + 100 * 100 + c1), 1e-9);
  const Image image = pattern(40, 30);
  EXPECT_NEAR(ssim(image, image), 1.0, 1e-12);
  EXPECT_DOUBLE_EQ(ssim(image, noisy(image, 30)), ssim(noisy(image, 30), image));
  EXPECT_THROW(ssim(filled(10, 20, 0, 0, 0), filled(10, 20, 0, 0, 0)), Error);
}

TEST(Ssim, IsTheMeanOverWindows) {
  const Image a = pattern(31, 22), b = noisy(a, 60);
  const auto luma = [](const Image& image, int x, int y) {
    const std::uint8_t* p = image.at(x, y);
    return 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2];
  };
  double total = 0;
  int windows = 0;
  for (int y = 5; y < 22 - 5; ++y)
    for (int x = 5; x < 31 - 5; ++x, ++windows) {
      double weights = 0, ma = 0, mb = 0, va = 0, vb = 0, covariance = 0;
      for (int pass = 0; pass < 2; ++pass) {
        for (int dy = -5; dy <= 5; ++dy)
          for (int dx = -5; dx <= 5; ++dx) {
            const double w = std::exp(-(dx * dx + dy * dy) / (2 * 1.5 * 1.5));
            const double la = luma(a, x + dx, y + dy), lb = luma(b, x + dx, y + dy);
            if (pass == 0) {
              weights += w;
              ma += w * la;
              mb += w * lb;
            } else {
              va += w / weights * (la - ma) * (la - ma);
              vb += w / weights * (lb - mb) * (lb - mb);
              covariance += w / weights * (la - ma) * (lb - mb);
            }
          }
        if (pass == 0) {
          ma /= weights;
          mb /= weights;
        }
      }
      const double c1 = 2.55 * 2.55, c2 = 7.65 * 7.65;
      total +=
          (2 * ma * mb + c1) * (2 * covariance + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2));
    }
  EXPECT_NEAR(ssim(a, b), total / windows, 1e-9);
}

TEST(Ssim, OfHdrImagesSeesStructureNotScale) {
  const HdrImage a = hdrPattern(25, 17, 1), b = hdrPattern(25, 17, 2);
  EXPECT_NEAR(ssim(a, a), 1.0, 1e-12);
  EXPECT_LT(ssim(a, b), 0.999);
  HdrImage a8 = a, b8 = b;
  for (glm::vec3& c : a8.rgb) c *= 8.0f;
  for (glm::vec3& c : b8.rgb) c *= 8.0f;
  EXPECT_NEAR(ssim(a8, b8), ssim(a, b), 1e-5);
}

TEST(Compare, IsTheSameForAnyNumberOfThreads) {
  const Image a = pattern(300, 211), b = noisy(a, 20);
  setThreadCount(1);
  const std::array<double, 3> one = {meanFlip(a, b), psnr(a, b), ssim(a, b)};
  setThreadCount(0);
  EXPECT_EQ(one, (std::array<double, 3>{meanFlip(a, b), psnr(a, b), ssim(a, b)}));
}

TEST(Heatmap, RunsFromBlackToPaleYellow) {
  ErrorMap map{3, 1, {0.0f, 0.5f, 1.0f}};
  const Image image = heatmap(map);
  EXPECT_EQ(image.at(0, 0)[0], 0);
  EXPECT_EQ(image.at(0, 0)[2], 4);
  EXPECT_EQ(image.at(2, 0)[0], 0xfc);
  EXPECT_EQ(image.at(2, 0)[1], 0xfd);
  EXPECT_NEAR(image.at(1, 0)[0], 0xb6, 2);  // matplotlib's magma(0.5) is #b73779
  EXPECT_NEAR(image.at(1, 0)[1], 0x37, 2);
  EXPECT_NEAR(image.at(1, 0)[2], 0x79, 2);
}

}  // namespace
}  // namespace verdure
