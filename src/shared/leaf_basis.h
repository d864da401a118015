#ifndef VERDURE_SHARED_LEAF_BASIS_H_
#define VERDURE_SHARED_LEAF_BASIS_H_

#include "portable.h"

// Light through a leaf as a function of where the sun is: three coefficients of the Half-Life 2
// basis for each point. Habel, "Real-time Rendering and Animation of Vegetation", 2009, 3.3.8.

SHARED_BEGIN

/// (3.17): the three basis functions sqrt(3 / (2 pi)) H_i.w at unit `w`, z out of the side that is
/// lit, w.z >= 0. Orthonormal over that hemisphere; not clamped.
SHARED_FUNCTION vec3 leafBasis(vec3 w) {
  float scale = 0.69098830f;
  float up = 0.57735027f * w.z;
  float across = -0.40824829f * w.x;
  return scale * vec3(across - 0.70710678f * w.y + up, across + 0.70710678f * w.y + up,
                      0.81649658f * w.x + up);
}

/// The same as a vector: light from `w` is its dot product with w. Its z is out of the lit side.
SHARED_FUNCTION vec3 leafDirection(vec3 h) {
  return vec3(dot(h, leafBasis(vec3(1, 0, 0))), dot(h, leafBasis(vec3(0, 1, 0))),
              dot(h, leafBasis(vec3(0, 0, 1))));
}

/// That of a leaf that lets as much light from all around through, but scatters it evenly.
SHARED_FUNCTION vec3 leafEvenDirection(vec3 h) {
  return vec3(0.0f, 0.0f, 0.39894228f * (h.x + h.y + h.z));
}

/// leafDirection(), which has z out of the lit side, from the frame of the side that is looked at
/// (right and up in its maps, out of it): light that arrives from a direction w is dot(it, w), for
/// w beyond the leaf, and not below 0.
SHARED_FUNCTION vec3 leafThrough(mat3 seen_side, vec3 q) {
  return seen_side * vec3(q.x, q.y, -q.z);
}

/// (3.23) without colours: what of the sun's light leaves a point with coefficients `h`. `to_sun`:
/// unit, in the frame of the side that is looked at (x right, y up in its maps, z out of it), the
/// sun behind: to_sun.z <= 0. Single coefficients may be negative, light may not.
SHARED_FUNCTION float leafTransport(vec3 h, vec3 to_sun) {
  vec3 w = vec3(to_sun.x, to_sun.y, -to_sun.z);
  return max(dot(h, leafBasis(w)), 0.0f);
}

/// (3.23): light of colour `translucency` (rho_t) of a sun of `sun` above a plane that faces it.
SHARED_FUNCTION vec3 leafTranslucence(vec3 sun, vec3 translucency, vec3 h, vec3 to_sun) {
  return sun * translucency * leafTransport(h, to_sun);
}

/// (3.24), to compare: the same for a leaf that scatters light evenly, whatever lies on it.
/// `total`: share of the light that gets through.
SHARED_FUNCTION vec3 leafDiffuseTranslucence(vec3 sun, vec3 translucency, float total,
                                             vec3 to_sun) {
  return sun * translucency * (total * max(-to_sun.z, 0.0f));
}

SHARED_END

#endif  // VERDURE_SHARED_LEAF_BASIS_H_
