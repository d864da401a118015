#include "reference/gloss.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "base/parallel.h"
#include "shared/cook_torrance.h"

namespace verdure {
namespace {

/// Any two axes beside a normal.
glm::mat3 axesOf(const glm::vec3& n) {
  const glm::vec3 x =
      glm::normalize(glm::cross(std::abs(n.y) < 0.7f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0), n));
  return {x, glm::cross(n, x), n};
}

float distribution(float cosine, float width) {
  const float a2 = width * width, s = cosine * cosine * (a2 - 1.0f) + 1.0f;
  return a2 / (glm::pi<float>() * s * s);
}

/// Smith's Lambda.
float hidden(float cosine, float width) {
  const float c2 = cosine * cosine;
  return 0.5f * (std::sqrt(1.0f + width * width * (1.0f - c2) / c2) - 1.0f);
}

float fresnel(float facing, float cosine) {
  const float m = std::clamp(1.0f - cosine, 0.0f, 1.0f), m2 = m * m;
  return facing + (1.0f - facing) * m2 * m2 * m;
}

/// A facet's normal, by two numbers in [0, 1).
glm::vec3 beckmannFacet(float roughness, float u, float v) {
  const float slope2 = -roughness * roughness * std::log(1.0f - u);
  const float z = 1.0f / std::sqrt(1.0f + slope2), ring = z * std::sqrt(slope2);
  const float turn = v * glm::two_pi<float>();
  return {ring * std::cos(turn), ring * std::sin(turn), z};
}

}  // namespace

/// What is reflected towards `out`, z along the normal.
float Gloss::integrated(const glm::vec3& out) const {
  constexpr int kAcross = 64;
  const glm::vec3 normal(0.0f, 0.0f, 1.0f);
  double sum = 0.0;
  if (facets_ == Facets::kBeckmann) {  // by the facets, because smooth surfaces have narrow lobes
    for (int a = 0; a < kAcross * 2; ++a)
      for (int b = 0; b < kAcross; ++b) {
        const glm::vec3 facet =
            beckmannFacet(width_, (static_cast<float>(a) + 0.5f) / (kAcross * 2),
                          (static_cast<float>(b) + 0.5f) / kAcross);
        const glm::vec3 in = 2.0f * glm::dot(out, facet) * facet - out;
        const float chance = density(normal, out, in);
        if (chance > 0.0f && in.z > 0.0f) sum += double{value(normal, out, in) / chance};
      }
    return static_cast<float>(sum / (kAcross * 2.0 * kAcross));
  }
  // Over one half of the hemisphere, even in solid angle; the other is its mirror image.
  for (int a = 0; a < kAcross * 4; ++a)
    for (int b = 0; b < kAcross; ++b) {
      const float z = (static_cast<float>(a) + 0.5f) / (kAcross * 4);
      const float turn = (static_cast<float>(b) + 0.5f) / kAcross * glm::pi<float>();
      const float ring = std::sqrt(1.0f - z * z);
      sum += double{value(normal, out, {ring * std::cos(turn), ring * std::sin(turn), z})};
    }
  return static_cast<float>(sum * glm::two_pi<double>() / (kAcross * 4.0 * kAcross));
}

Gloss::Gloss(Facets facets, float facing, float width, float strength)
    : facets_(facets), facing_(facing), width_(width), strength_(strength) {
  parallelFor(kCosines, 1, [&](std::size_t i) {
    const float cosine = (static_cast<float>(i) + 0.5f) / kCosines;
    reflected_[i] = integrated({std::sqrt(1.0f - cosine * cosine), 0.0f, cosine});
  });
  double mean = 0.0;
  constexpr int kSteps = 1024;
  for (int i = 0; i < kSteps; ++i) {
    const float cosine = (static_cast<float>(i) + 0.5f) / kSteps;
    mean += double{2.0f * cosine * reflected(cosine)} / kSteps;
  }
  mean_passed_ = static_cast<float>(1.0 - mean);
}

float Gloss::value(const glm::vec3& normal, const glm::vec3& out, const glm::vec3& in) const {
  const float o = glm::dot(normal, out), i = glm::dot(normal, in);
  if (!(o > 0.0f && i > 0.0f)) return 0.0f;
  if (facets_ == Facets::kBeckmann)
    return shared::cookTorrance(normal, in, out, width_, facing_) / glm::pi<float>();
  const glm::vec3 half = glm::normalize(out + in);
  const float seen = 1.0f / (1.0f + hidden(o, width_) + hidden(i, width_));
  return strength_ * distribution(glm::dot(normal, half), width_) * seen *
         fresnel(facing_, glm::dot(out, half)) / (4.0f * o);
}

float Gloss::density(const glm::vec3& normal, const glm::vec3& out, const glm::vec3& in) const {
  const float o = glm::dot(normal, out);
  const glm::vec3 half = glm::normalize(out + in);
  const float facet = glm::dot(normal, half);
  if (!(o > 0.0f && facet > 0.0f)) return 0.0f;
  if (facets_ == Facets::kBeckmann)
    return shared::facetDensity(width_, facet) * facet /
           (4.0f * std::max(glm::dot(out, half), 1e-6f));
  return distribution(facet, width_) / (1.0f + hidden(o, width_)) / (4.0f * o);
}

glm::vec3 Gloss::sample(const glm::vec3& normal, const glm::vec3& out, Random& random) const {
  const glm::mat3 axes = axesOf(normal);
  const glm::vec3 local = glm::transpose(axes) * out;
  if (facets_ == Facets::kBeckmann) {
    const float u = random.uniform();
    const glm::vec3 facet = beckmannFacet(width_, u, random.uniform());
    return axes * (2.0f * glm::dot(local, facet) * facet - local);
  }
  // Stretched, the facets are a hemisphere; a point of the disc that `out` sees of it.
  const glm::vec3 v = glm::normalize(glm::vec3(width_ * local.x, width_ * local.y, local.z));
  const float radius = std::sqrt(random.uniform());
  const float turn = random.uniform(0.0f, glm::two_pi<float>());
  const glm::vec3 x =
      v.z < 0.9999f ? glm::normalize(glm::cross(glm::vec3(0, 0, 1), v)) : glm::vec3(1, 0, 0);
  const glm::vec3 y = glm::cross(v, x);
  const float p = radius * std::cos(turn), s = 0.5f * (1.0f + v.z);
  const float q =
      (1.0f - s) * std::sqrt(std::max(1.0f - p * p, 0.0f)) + s * radius * std::sin(turn);
  const glm::vec3 h = p * x + q * y + std::sqrt(std::max(1.0f - p * p - q * q, 0.0f)) * v;
  const glm::vec3 facet =
      glm::normalize(glm::vec3(width_ * h.x, width_ * h.y, std::max(h.z, 1e-6f)));
  return axes * (2.0f * glm::dot(local, facet) * facet - local);
}

float Gloss::reflected(float cosine) const {
  const float at = std::clamp(cosine, 0.0f, 1.0f) * kCosines - 0.5f;
  const auto i = static_cast<std::size_t>(std::clamp(at, 0.0f, kCosines - 2.0f));
  const float share = at - static_cast<float>(i);  // beyond the ends: the line goes on
  return std::clamp(reflected_[i] + share * (reflected_[i + 1] - reflected_[i]), 0.0f, 1.0f);
}

}  // namespace verdure
