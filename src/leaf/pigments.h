#ifndef VERDURE_LEAF_PIGMENTS_H_
#define VERDURE_LEAF_PIGMENTS_H_

#include <glm/glm.hpp>

// Colours of leaves by what absorbs light in them (Beer-Lambert, three bands). The amounts are
// relative: 1 of chlorophyll is a dark summer leaf.

namespace verdure {

struct Pigments {
  float chlorophyll = 0, carotenoid = 0, anthocyanin = 0, tannin = 0;
};

inline Pigments mix(const Pigments& a, const Pigments& b, float t) {
  return {glm::mix(a.chlorophyll, b.chlorophyll, t), glm::mix(a.carotenoid, b.carotenoid, t),
          glm::mix(a.anthocyanin, b.anthocyanin, t), glm::mix(a.tannin, b.tannin, t)};
}

/// Optical depth in red, green and blue.
inline glm::vec3 absorbance(const Pigments& p) {
  return p.chlorophyll * glm::vec3(2.45f, 1.45f, 2.5f) +
         p.carotenoid * glm::vec3(0.02f, 0.26f, 2.3f) +
         p.anthocyanin * glm::vec3(0.10f, 5.0f, 3.6f) + p.tannin * glm::vec3(0.75f, 1.25f, 1.75f);
}

/// What is scattered back out of tissue of that absorbance, linear RGB. `path`: how deep light
/// goes, 1 for the upper side; `surface`: what never enters.
inline glm::vec3 reflected(const glm::vec3& depth, float path, float surface) {
  return glm::vec3(0.50f, 0.50f, 0.45f) * glm::exp(-path * depth) + surface;
}

/// Colour of the light that has come through (rho_t): what scattering alone lets through, about a
/// quarter, times this is a summer leaf's transmittance: about its reflectance, but yellower, as
/// leafTransmittance() has it (shared/leaf.h).
inline glm::vec3 transmitted(const glm::vec3& depth, float path) {
  return glm::vec3(1.0f, 1.0f, 0.85f) * glm::exp(-path * glm::vec3(0.45f, 0.36f, 0.62f) * depth);
}

}  // namespace verdure

#endif  // VERDURE_LEAF_PIGMENTS_H_
