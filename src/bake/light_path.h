#ifndef VERDURE_BAKE_LIGHT_PATH_H_
#define VERDURE_BAKE_LIGHT_PATH_H_

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "base/random.h"
#include "rays/ray_scene.h"
#include "shared/leaf.h"

namespace verdure {

/// Right-handed axes around a unit z axis: Duff et al., "Building an Orthonormal Basis, Revisited",
/// JCGT 2017.
inline glm::mat3 axesAround(const glm::vec3& n) {
  const float sign = std::copysign(1.0f, n.z);
  const float a = -1.0f / (sign + n.z), b = n.x * n.y * a;
  return {glm::vec3(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x),
          glm::vec3(b, sign + n.y * n.y * a, -n.y), n};
}

/// A direction around +z with density cos / pi from a point of the unit square.
inline glm::vec3 cosineDirection(float u, float v) {
  const float r = std::sqrt(u), angle = glm::two_pi<float>() * v;
  return {r * std::cos(angle), r * std::sin(angle), std::sqrt(std::max(0.0f, 1.0f - u))};
}

/// A direction of even density over the sphere.
inline glm::vec3 sphereDirection(float u, float v) {
  const float z = 1.0f - 2.0f * u, angle = glm::two_pi<float>() * v;
  const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
  return {r * std::cos(angle), r * std::sin(angle), z};
}

/// `count` points of the unit square, evenly spread: a Fibonacci lattice, shifted by a random
/// stream (Cranley and Patterson 1976).
class ShiftedLattice {
 public:
  ShiftedLattice(int count, Random& random)
      : step_(1.0f / static_cast<float>(count)), u_(random.uniform()), v_(random.uniform()) {}
  glm::vec2 point(int i) const {
    const double along = static_cast<double>(i) * 0.61803398874989484820 + static_cast<double>(v_);
    return {(static_cast<float>(i) + u_) * step_, static_cast<float>(along - std::floor(along))};
  }

 private:
  float step_, u_, v_;
};

/// Follows light backwards from where a ray starts, by up to `bounces` surfaces, and calls
/// escape(direction, throughput, bounced) where the path leaves the scene: light from `direction`
/// arrives at the start times `throughput`, after `bounced` surfaces. Surfaces reflect diffusely
/// and leaves transmit diffusely; inside of wood it is dark. Whether a path is reflected or
/// transmitted is chosen by their shares, and faint paths end by Russian roulette, both without
/// bias.
template <class Escape>
void followLight(const RayScene& scene, Ray ray, int bounces, bool ground, Random& random,
                 const Escape& escape) {
  glm::vec3 throughput(1.0f);
  for (int bounced = 0; bounced < bounces; ++bounced) {
    const std::optional<RayHit> hit = scene.trace(ray);
    if (!hit) {
      if (!ground || ray.direction.y >= 0.0f) escape(ray.direction, throughput, bounced);
      return;
    }
    const SurfacePoint at = scene.surfaceAt(*hit, ray);
    const bool front = glm::dot(at.normal, ray.direction) < 0.0f;
    if (!at.foliage && !front) return;
    glm::vec3 side = front ? at.normal : -at.normal;
    const glm::vec3 transmittance =
        at.foliage ? shared::leafTransmittance(at.reflectance) : glm::vec3(0.0f);
    const auto sum = [](const glm::vec3& c) { return c.r + c.g + c.b; };
    const float reflected = sum(at.reflectance), transmitted = sum(transmittance);
    if (!(reflected + transmitted > 0.0f)) return;
    const float reflect_share = reflected / (reflected + transmitted);
    if (random.uniform() < reflect_share) {
      throughput *= at.reflectance / reflect_share;
    } else {
      throughput *= transmittance / (1.0f - reflect_share);
      side = -side;
    }
    constexpr float kFaint = 0.25f;
    const float brightest = std::max({throughput.r, throughput.g, throughput.b});
    if (brightest < kFaint) {
      const float survival = brightest / kFaint;
      if (random.uniform() >= survival) return;
      throughput /= survival;
    }
    ray.origin = scene.originOff(at.position, side);
    const float u = random.uniform(), v = random.uniform();
    ray.direction = axesAround(side) * cosineDirection(u, v);
  }
  if ((!ground || ray.direction.y >= 0.0f) && !scene.occluded(ray))
    escape(ray.direction, throughput, bounces);
}

}  // namespace verdure

#endif  // VERDURE_BAKE_LIGHT_PATH_H_
