#ifndef VERDURE_SHARED_GLOSS_H_
#define VERDURE_SHARED_GLOSS_H_

#include "portable.h"

// The gloss of leaves and bark: a clear rough surface over their colour. The reference traces it as
// Cook and Torrance's model with GGX facets (reference/gloss.h).

SHARED_BEGIN

/// Reflectance of a facet that is looked at squarely: a refractive index of 1.5.
SHARED_FUNCTION float facetReflectance() {
  return 0.04f;
}

/// k_s of the sun's highlight (V.R)^n: what the facets reflect at the mirror, looked at squarely,
/// relative to a diffuse white. `width` is GGX's alpha.
SHARED_FUNCTION float highlightStrength(float width) {
  return facetReflectance() / (4.0f * width * width);
}

/// Share of light from a direction that the gloss reflects, by the cosine with the normal: within
/// 0.016 of the integral for a width of 0.3 to 1 (a fit to it).
SHARED_FUNCTION float glossReflected(float width, float cosine) {
  float squarely = 0.042f - 0.031f * width;
  float grazing = 0.058f + 0.0104f / (width * width);
  return squarely + grazing * exp(-(3.1f + 2.1f * width) * cosine);
}

SHARED_END

#endif  // VERDURE_SHARED_GLOSS_H_
