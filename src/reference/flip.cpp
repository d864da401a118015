#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "base/parallel.h"
#include "reference/exposure.h"
#include "reference/separable_filter.h"
#include "shared/color.h"
#include "verdure/compare.h"

// FLIP. Section and equation numbers are those of Andersson et al. 2020.

namespace verdure {
namespace {

using Kernel = std::vector<float>;  ///< odd length, centred
using Plane = Channel<float>;

/// An image of three channels.
struct Planes {
  std::array<Plane, 3> channels;

  Planes(int width, int height) { channels.fill(Plane(width, height)); }
  int width() const { return channels[0].width; }
  int height() const { return channels[0].height; }
  glm::vec3 at(int x, int y) const {
    return {channels[0].row(y)[x], channels[1].row(y)[x], channels[2].row(y)[x]};
  }
  void set(int x, int y, const glm::vec3& value) {
    for (int c = 0; c < 3; ++c) channels[static_cast<std::size_t>(c)].row(y)[x] = value[c];
  }
};

/// body(x, y) for each pixel, rows in parallel.
template <class Body>
void forPixels(int width, int height, const Body& body) {
  parallelFor(static_cast<std::size_t>(height), 8, [&](std::size_t y) {
    for (int x = 0; x < width; ++x) body(x, static_cast<int>(y));
  });
}

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
  return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
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

/// 4.1.1: blur by the contrast sensitivity of the three channels, then linear RGB in [0, 1], and
/// the colours that are compared (4.1.2, 4.1.3).
Planes seenColors(const Planes& ycxcz, float pixels_per_degree) {
  struct Sensitivity {
    float a1, b1, a2, b2;
  };
  constexpr std::array<Sensitivity, 3> kChannels{
      {{1.0f, 0.0047f, 0.0f, 1e-5f}, {1.0f, 0.0053f, 0.0f, 1e-5f}, {34.1f, 0.04f, 13.5f, 0.025f}}};
  const int radius = static_cast<int>(std::ceil(
      3.0f * std::sqrt(0.04f / (2.0f * glm::pi<float>() * glm::pi<float>())) * pixels_per_degree));
  Planes out(ycxcz.width(), ycxcz.height());
  for (std::size_t c = 0; c < 3; ++c) {
    const Sensitivity& s = kChannels[c];
    std::array<Plane, 2> parts;
    std::array<float, 2> weights{};
    for (std::size_t g = 0; g < 2; ++g) {
      const float a = g == 0 ? s.a1 : s.a2, b = g == 0 ? s.b1 : s.b2;
      if (a == 0.0f) continue;
      Kernel kernel = contrastGaussian(b, radius, pixels_per_degree);
      const float sum = sumOf(kernel);
      for (float& k : kernel) k /= sum;
      weights[g] = a * std::sqrt(glm::pi<float>() / b) * sum * sum;
      parts[g] = filtered(ycxcz.channels[c], kernel, kernel);
    }
    out.channels[c] = std::move(parts[0]);
    if (weights[1] == 0.0f) continue;
    const float share = weights[0] / (weights[0] + weights[1]);
    for (std::size_t i = 0; i < out.channels[c].values.size(); ++i)
      out.channels[c].values[i] = glm::mix(parts[1].values[i], out.channels[c].values[i], share);
  }
  forPixels(out.width(), out.height(), [&](int x, int y) {
    out.set(x, y, huntLabFromLinear(glm::clamp(linearFromYcxcz(out.at(x, y)), 0.0f, 1.0f)));
  });
  return out;
}

/// 4.2: strength of edges and of points in the lightness.
struct Features {
  Plane edges, points;
};

Features features(const Planes& ycxcz, float pixels_per_degree) {
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
  Plane lightness = ycxcz.channels[0];
  for (float& y : lightness.values) y = (y + 16.0f) / 116.0f;
  const auto strength = [&](const Kernel& kernel) {
    Plane across = filtered(lightness, kernel, gauss);
    const Plane down = filtered(lightness, gauss, kernel);
    for (std::size_t i = 0; i < across.values.size(); ++i)
      across.values[i] =
          std::sqrt(across.values[i] * across.values[i] + down.values[i] * down.values[i]);
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

/// What a viewer sees of one image.
struct Seen {
  Planes colors;
  Features features;

  Seen(const Planes& ycxcz, float pixels_per_degree)
      : colors(seenColors(ycxcz, pixels_per_degree)),
        features(verdure::features(ycxcz, pixels_per_degree)) {}
};

ErrorMap difference(const Seen& a, const Seen& b) {
  constexpr float kColorExponent = 0.7f;  // the features' is 0.5
  const float most =
      std::pow(hyab(huntLabFromLinear({0, 1, 0}), huntLabFromLinear({0, 0, 1})), kColorExponent);
  ErrorMap map{a.colors.width(), a.colors.height(), {}};
  map.values.resize(static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height));
  forPixels(map.width, map.height, [&](int x, int y) {
    const float color =
        colorDifference(std::pow(hyab(a.colors.at(x, y), b.colors.at(x, y)), kColorExponent), most);
    const auto apart = [x, y](const Plane& p, const Plane& q) {
      return std::abs(p.row(y)[x] - q.row(y)[x]);
    };
    const float feature = std::sqrt(std::max(apart(a.features.edges, b.features.edges),
                                             apart(a.features.points, b.features.points)) /
                                    std::sqrt(2.0f));
    map.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) +
               static_cast<std::size_t>(x)] = std::pow(color, 1.0f - feature);
  });
  return map;
}

Planes ycxczOf(const Image& image) {
  std::array<float, 256> linear;
  for (std::size_t i = 0; i < linear.size(); ++i)
    linear[i] = shared::linearFromSrgb(static_cast<float>(i) / 255.0f);
  Planes planes(image.width, image.height);
  forPixels(image.width, image.height, [&](int x, int y) {
    const std::uint8_t* p = image.at(x, y);
    planes.set(x, y, ycxczFromLinear({linear[p[0]], linear[p[1]], linear[p[2]]}));
  });
  return planes;
}

Planes ycxczOf(const HdrImage& image, float exposure) {
  const float factor = std::exp2(exposure);
  Planes planes(image.width, image.height);
  forPixels(image.width, image.height, [&](int x, int y) {
    planes.set(x, y, ycxczFromLinear(aces(image.at(x, y) * factor)));
  });
  return planes;
}

}  // namespace

ErrorMap flip(const Image& a, const Image& b, float pixels_per_degree) {
  checkComparable(a, b);
  return difference(Seen(ycxczOf(a), pixels_per_degree), Seen(ycxczOf(b), pixels_per_degree));
}

double meanFlip(const Image& a, const Image& b, float pixels_per_degree) {
  return flip(a, b, pixels_per_degree).mean();
}

HdrFlip hdrFlip(const HdrImage& reference, const HdrImage& test, float pixels_per_degree) {
  checkComparable(reference, test);
  constexpr float kTone = 0.85f;
  const LuminanceRange range = luminanceRange(reference);
  HdrFlip result;
  if (range.most > 0.0f) {
    result.start_exposure = std::log2(acesInverse(kTone) / range.most);
    result.stop_exposure = std::log2(acesInverse(kTone) / range.median);
  }
  const float stops = result.stop_exposure - result.start_exposure;
  result.exposures = std::max(2, static_cast<int>(std::ceil(stops)));
  for (int i = 0; i < result.exposures; ++i) {
    const float exposure = result.start_exposure +
                           stops * static_cast<float>(i) / static_cast<float>(result.exposures - 1);
    ErrorMap map = difference(Seen(ycxczOf(reference, exposure), pixels_per_degree),
                              Seen(ycxczOf(test, exposure), pixels_per_degree));
    if (i == 0) {
      result.map = std::move(map);
      continue;
    }
    for (std::size_t p = 0; p < map.values.size(); ++p)
      result.map.values[p] = std::max(result.map.values[p], map.values[p]);
  }
  return result;
}

}  // namespace verdure
