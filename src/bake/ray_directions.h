#ifndef VERDURE_BAKE_RAY_DIRECTIONS_H_
#define VERDURE_BAKE_RAY_DIRECTIONS_H_

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "base/random.h"

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

}  // namespace verdure

#endif  // VERDURE_BAKE_RAY_DIRECTIONS_H_
