#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "base/parallel.h"
#include "shared/color.h"
#include "verdure/compare.h"
#include "verdure/error.h"

// FLIP, the LDR variant. Section and equation numbers are those of Andersson et al. 2020.

namespace verdure {
namespace {

using Plane = std::vector<glm::vec3>;
using Kernel = std::vector<float>;  ///< odd length, centred

struct Size {
  int width, height;
};

const glm::vec3 kWhite{0.950428545f, 1.0f, 1.088900371f};  // D65, XYZ

glm::vec3 xyzFromLinear(const glm::vec3& c) {
  return {0.41238656f * c.x + 0.35759149f * c.y + 0.18045049f * c.z,
          0.21263682f * c.x + 0.71518298f * c.y + 0.0721802f * c.z,
          0.01933062f * c.x + 0.11919716f * c.y + 0.95037259f * c.z};
}

glm::vec3 linearFromXyz(const glm::vec3& c) {
  return {3.24100326f * c.x - 1.53739899f * c.y - 0.49861587f * c.z,
          -0.96922426f * c.x + 1.87592999f * c.y + 0.04155422f * c.z,
          0.05563942f * c.x - 0.2040112f * c.y + 1.05714897f * c.z};
}

glm::vec3 ycxczFromLinear(const glm::vec3& c) {
  const glm::vec3 r = xyzFromLinear(c) / kWhite;
  return {116.0f * r.y - 16.0f, 500.0f * (r.x - r.y), 200.0f * (r.y - r.z)};
}

glm::vec3 linearFromYcxcz(const glm::vec3& c) {
  const float y = (c.x + 16.0f) / 116.0f;
  return linearFromXyz(glm::vec3(y + c.y / 500.0f, y, y - c.z / 200.0f) * kWhite);
}

/// CIELab with Hunt's effect: colours of dark pixels differ less (4.1.3).
glm::vec3 huntLabFromLinear(const glm::vec3& c) {
  const glm::vec3 r = xyzFromLinear(c) / kWhite;
  const auto f = [](float t) {
    constexpr float d = 6.0f / 29.0f;
    return t > d * d * d ? std::cbrt(t) : t / (3.0f * d * d) + 4.0f / 29.0f;
  };
  const float lightness = 116.0f * f(r.y) - 16.0f;
  return {lightness, 0.01f * lightness * 500.0f * (f(r.x) - f(r.y)),
          0.01f * lightness * 200.0f * (f(r.y) - f(r.z))};
}

float hyab(const glm::vec3& a, const glm::vec3& b) {
  const glm::vec3 d = a - b;
  return std::abs(d.x) + std::hypot(d.y, d.z);
}

/// One channel filtered by a separable kernel; beyond the border the border's pixel repeats.
std::vector<float> filtered(const std::vector<float>& in, const Size& size, const Kernel& across,
                            const Kernel& down) {
  const auto w = static_cast<std::size_t>(size.width);
  const auto pass = [&](const std::vector<float>& source, const Kernel& kernel, bool horizontal) {
    std::vector<float> out(source.size());
    const int radius = static_cast<int>(kernel.size() / 2);
    parallelFor(static_cast<std::size_t>(size.height), 8, [&](std::size_t y) {
      for (int x = 0; x < size.width; ++x) {
        float sum = 0.0f;
        for (int k = -radius; k <= radius; ++k) {
          const int xx = horizontal ? std::clamp(x + k, 0, size.width - 1) : x;
          const int yy = horizontal ? static_cast<int>(y)
                                    : std::clamp(static_cast<int>(y) + k, 0, size.height - 1);
          sum += kernel[static_cast<std::size_t>(k + radius)] *
                 source[static_cast<std::size_t>(yy) * w + static_cast<std::size_t>(xx)];
        }
        out[y * w + static_cast<std::size_t>(x)] = sum;
      }
    });
    return out;
  };
  return pass(pass(in, across, true), down, false);
}

std::vector<float> channel(const Plane& plane, int c) {
  std::vector<float> out(plane.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = plane[i][c];
  return out;
}

/// exp(-pi^2 x^2 / b) at the pixels of a display, not normalised.
Kernel contrastGaussian(float b, int radius, float pixels_per_degree) {
  Kernel kernel;
  for (int k = -radius; k <= radius; ++k) {
    const float x = static_cast<float>(k) / pixels_per_degree;
    kernel.push_back(std::exp(-glm::pi<float>() * glm::pi<float>() * x * x / b));
  }
  return kernel;
}

float sumOf(const Kernel& kernel) {
  float sum = 0.0f;
  for (const float k : kernel) sum += k;
  return sum;
}

/// 4.1.1: blur by the contrast sensitivity of the three channels, then linear RGB in [0, 1].
Plane contrastFiltered(const Plane& ycxcz, const Size& size, float pixels_per_degree) {
  struct Sensitivity {
    float a1, b1, a2, b2;
  };
  constexpr std::array<Sensitivity, 3> kChannels{
      {{1.0f, 0.0047f, 0.0f, 1e-5f}, {1.0f, 0.0053f, 0.0f, 1e-5f}, {34.1f, 0.04f, 13.5f, 0.025f}}};
  const int radius = static_cast<int>(std::ceil(
      3.0f * std::sqrt(0.04f / (2.0f * glm::pi<float>() * glm::pi<float>())) * pixels_per_degree));
  Plane out(ycxcz.size());
  for (int c = 0; c < 3; ++c) {
    const Sensitivity& s = kChannels[static_cast<std::size_t>(c)];
    const std::vector<float> in = channel(ycxcz, c);
    std::array<std::vector<float>, 2> parts;
    std::array<float, 2> weights{};
    for (std::size_t g = 0; g < 2; ++g) {
      const float a = g == 0 ? s.a1 : s.a2, b = g == 0 ? s.b1 : s.b2;
      if (a == 0.0f) continue;
      Kernel kernel = contrastGaussian(b, radius, pixels_per_degree);
      const float sum = sumOf(kernel);
      for (float& k : kernel) k /= sum;
      weights[g] = a * std::sqrt(glm::pi<float>() / b) * sum * sum;
      parts[g] = filtered(in, size, kernel, kernel);
    }
    for (std::size_t i = 0; i < out.size(); ++i) {
      float value = weights[0] * parts[0][i];
      if (!parts[1].empty()) value += weights[1] * parts[1][i];
      out[i][c] = value / (weights[0] + weights[1]);
    }
  }
  for (glm::vec3& c : out) c = glm::clamp(linearFromYcxcz(c), 0.0f, 1.0f);
  return out;
}

/// 4.2: strength of edges and of points in the lightness.
struct Features {
  std::vector<float> edges, points;
};

Features features(const Plane& ycxcz, const Size& size, float pixels_per_degree) {
  const float deviation = 0.5f * 0.082f * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3.0f * deviation));
  Kernel gauss, edge, point;
  for (int k = -radius; k <= radius; ++k) {
    const float x = static_cast<float>(k), s2 = deviation * deviation;
    const float g = std::exp(-x * x / (2.0f * s2));
    gauss.push_back(g);
    edge.push_back(-x * g);
    point.push_back((x * x / s2 - 1.0f) * g);
  }
  const float sum = sumOf(gauss);
  for (float& k : gauss) k /= sum;
  for (Kernel* kernel : {&edge, &point}) {  // positive weights sum to 1, negative ones to -1
    float positive = 0.0f, negative = 0.0f;
    for (const float k : *kernel) (k > 0.0f ? positive : negative) += std::abs(k);
    for (float& k : *kernel) k /= k > 0.0f ? positive : negative;
  }
  std::vector<float> lightness = channel(ycxcz, 0);
  for (float& y : lightness) y = (y + 16.0f) / 116.0f;
  const auto strength = [&](const Kernel& kernel) {
    std::vector<float> across = filtered(lightness, size, kernel, gauss);
    const std::vector<float> down = filtered(lightness, size, gauss, kernel);
    for (std::size_t i = 0; i < across.size(); ++i) across[i] = std::hypot(across[i], down[i]);
    return across;
  };
  return {strength(edge), strength(point)};
}

/// 4.1.4: compresses large colour differences; `most` is the largest one possible.
float colorDifference(float difference, float most) {
  constexpr float pc = 0.4f, pt = 0.95f;
  const float knee = pc * most;
  if (difference < knee) return pt / knee * difference;
  return pt + (difference - knee) / (most - knee) * (1.0f - pt);
}

Plane ycxczOf(const Image& image) {
  Plane plane(image.rgba.size() / 4);
  parallelFor(plane.size(), 4096, [&](std::size_t i) {
    glm::vec3 c;
    for (int k = 0; k < 3; ++k)
      c[k] = shared::linearFromSrgb(
          static_cast<float>(image.rgba[4 * i + static_cast<std::size_t>(k)]) / 255.0f);
    plane[i] = ycxczFromLinear(c);
  });
  return plane;
}

}  // namespace

double meanFlip(const Image& a, const Image& b, float pixels_per_degree) {
  if (a.width != b.width || a.height != b.height || a.empty())
    throw Error("compare", "the images have different sizes or no pixels",
                "compare pictures of one size");
  constexpr float kColorExponent = 0.7f, kFeatureExponent = 0.5f;
  const Size size{a.width, a.height};
  const Plane seen_a = ycxczOf(a), seen_b = ycxczOf(b);
  const Plane smooth_a = contrastFiltered(seen_a, size, pixels_per_degree);
  const Plane smooth_b = contrastFiltered(seen_b, size, pixels_per_degree);
  const Features features_a = features(seen_a, size, pixels_per_degree);
  const Features features_b = features(seen_b, size, pixels_per_degree);
  const float most =
      std::pow(hyab(huntLabFromLinear({0, 1, 0}), huntLabFromLinear({0, 0, 1})), kColorExponent);
  double sum = 0.0;
  for (std::size_t i = 0; i < seen_a.size(); ++i) {
    const float color = colorDifference(
        std::pow(hyab(huntLabFromLinear(smooth_a[i]), huntLabFromLinear(smooth_b[i])),
                 kColorExponent),
        most);
    const float feature = std::pow(std::max(std::abs(features_a.edges[i] - features_b.edges[i]),
                                            std::abs(features_a.points[i] - features_b.points[i])) /
                                       std::sqrt(2.0f),
                                   kFeatureExponent);
    sum += static_cast<double>(std::pow(color, 1.0f - feature));
  }
  return sum / static_cast<double>(seen_a.size());
}

}  // namespace verdure
