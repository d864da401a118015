#ifndef VERDURE_SHARED_GLOSS_H_
#define VERDURE_SHARED_GLOSS_H_

#include "portable.h"

// The gloss of leaves and bark: a clear rough surface over their colour. The reference traces it as
// Cook and Torrance's model with GGX facets (reference/gloss.h).

SHARED_BEGIN

/// Reflectance of a facet of refractive index `index` >= 1 that is looked at squarely: 0.04 at 1.5.
SHARED_FUNCTION float facetReflectance(float index) {
  float share = (index - 1.0f) / (index + 1.0f);
  return share * share;
}

/// GGX's alpha of leaves, which are waxy, and of bark, which is dull; exponents of the sun's
/// highlight.
SHARED_FUNCTION float glossWidth(bool foliage) {
  return foliage ? 0.41f : 0.82f;
}
SHARED_FUNCTION float highlightExponent(bool foliage) {
  return foliage ? 12.0f : 8.0f;
}

/// k_s of the sun's highlight (V.R)^n: what the facets reflect at the mirror, looked at squarely,
/// relative to a diffuse white. `width` is GGX's alpha, `facing` facetReflectance().
SHARED_FUNCTION float highlightStrength(float width, float facing) {
  return facing / (4.0f * width * width);
}

/// Share of light from a direction that the gloss reflects, by the cosine with the normal: within
/// 0.0175 of the integral for a width of 0.3 to 1 and refractive indices of 1.2 to 1.65 (a fit to
/// it).
SHARED_FUNCTION float glossReflected(float width, float facing, float cosine) {
  float squarely = facing * (1.05f - 0.775f * width);
  float grazing = 0.058f + 0.0104f / (width * width);
  return squarely + grazing * exp(-(3.1f + 2.1f * width) * cosine);
}

SHARED_END

#endif  // VERDURE_SHARED_GLOSS_H_
