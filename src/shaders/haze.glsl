// Haze in front of what is far away, as over the ground. Needs frame_set.glsl and terms.glsl.
#include "dome_light.glsl"

vec3 hazed(vec3 lit, vec3 position) {
  if (kBackground) return lit;
  vec3 way = position - frame.eye.xyz;
  float distance = length(way);
  float haze = hazeShare(distance, frame.ground.z);
  return haze > 0.0 ? mix(lit, domeLuminance(way / distance), haze) : lit;
}
