#ifndef VERDURE_PLANT_STEM_GROWTH_H_
#define VERDURE_PLANT_STEM_GROWTH_H_

#include <algorithm>
#include <cmath>
#include <vector>

#include "plant/weber_penn.h"

// What weber_penn.cpp (children and leaves) and stem_growth.cpp (one stem) share.

namespace verdure::growth {

inline constexpr float kPi = 3.14159265358979f;
inline const glm::vec3 kUp(0, 1, 0);
inline float radiansOf(float degrees) {
  return degrees * (kPi / 180.0f);
}

inline glm::quat aboutX(float angle) {
  return glm::angleAxis(angle, glm::vec3(1, 0, 0));
}
inline glm::quat aboutY(float angle) {
  return glm::angleAxis(angle, glm::vec3(0, 1, 0));
}
inline glm::quat aboutZ(float angle) {
  return glm::angleAxis(angle, glm::vec3(0, 0, 1));
}
inline glm::vec3 alongOf(const glm::quat& frame) {
  return frame * glm::vec3(0, 0, 1);
}

inline float declination(const glm::vec3& direction) {
  return std::acos(std::clamp(direction.y, -1.0f, 1.0f));
}

/// Radii stay above this, m, so that no ring of a stem's mesh shrinks to a point.
inline constexpr float kThinnest = 1e-5f;

/// A stem before it grows.
struct Bud {
  std::uint32_t parent = kNone;
  int level = 0;
  float offset = 0, parent_length = 1;
  glm::vec3 position{0.0f};
  glm::quat frame{};
  float length = 0, length_share = 1, radius = 0;
  std::uint64_t stream = 0;
};

/// What all stems of one tree share.
struct Tree {
  const TreeParameters& p;
  float height = 0;  ///< scale_tree of the paper
  float z_scale = 1;
  float trunk_scale = 1;
  float trunk_length = 0;
  float base_length = 0;

  float radiusAt(const Stem& stem, float along) const {
    const float z = std::clamp(along / stem.length, 0.0f, 1.0f);
    float r = taperedRadius(p.at(stem.level).taper, z, stem.radius, stem.length);
    if (stem.level == 0) r *= trunk_scale * flareFactor(p.flare, z);
    return std::max(r, kThinnest);
  }
  /// Length of a stem at the foot that carries no children, m.
  float bareLength(const Stem& stem) const { return stem.level == 0 ? base_length : 0.0f; }
};

/// Grows a stem with its clones, pruned; the stem itself comes first. Parents are indices into the
/// result, kNone for the stem itself. Empty if pruning leaves nothing.
std::vector<Stem> growGroup(const Tree& tree, const Bud& bud);

}  // namespace verdure::growth

#endif  // VERDURE_PLANT_STEM_GROWTH_H_
