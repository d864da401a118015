// The sky behind things; fit for vertex shaders, too. Needs frame_set.glsl and terms.glsl.
#include "shared/sky.h"
#include "shared/sky_formula.h"

/// Luminance of the sky towards a unit direction, frame units, without the sun's disk.
vec3 domeLuminance(vec3 direction) {
  vec3 d = domeDirection(direction);
  if (kFormulaSky) return skyLuminance(d, frame.sky) * frame.eye.w;
  // Level 0: the seam of the azimuths must not look like a long footprint.
  return textureLod(sky_image, domeCoordinates(d), 0.0).rgb;
}

/// What a colour target of half floats may hold.
vec3 storable(vec3 color) {
  return min(color, vec3(65000.0));
}
