// Which of the sun's maps a point is looked up in. Serves every map that is drawn with
// frame.shadow_from_world, a layer for each cascade.
#include "shared/cascade.h"

struct CascadeChoice {
  int fine;     // the finest cascade that holds the point and a filter around it
  int coarse;   // what it fades into; the same where it does not
  float share;  // of `fine` in what is seen, in (0, 1]
};

/// x, y in [0, 1] over the cascade's map; z = depth, over 1 behind all that is drawn there.
vec3 cascadePosition(int cascade, vec3 world_position) {
  return (frame.shadow_from_world[cascade] * vec4(world_position, 1.0)).xyz;
}

/// Depth of one metre in a cascade's map.
float depthOfMetre(int cascade) {
  mat4 m = frame.shadow_from_world[cascade];
  return length(vec3(m[0].z, m[1].z, m[2].z));
}

CascadeChoice chooseCascades(vec3 world_position) {
  int last = int(frame.to_sun.w) - 1;
  for (int i = 0; i < last; ++i) {
    vec2 at = (frame.shadow_from_world[i] * vec4(world_position, 1.0)).xy;
    float share = cascadeShare(at, 1.0 / frame.sun_light.w);
    if (share > 0.0) return CascadeChoice(i, share < 1.0 ? i + 1 : i, share);
  }
  return CascadeChoice(last, last, 1.0);
}

/// The texel at (x, y) of a cascade's map, counted from a fixed point of the world, so that what
/// hangs on it does not swim when the map moves.
vec2 cascadeCell(int cascade, vec2 at) {
  return mod(floor(at / frame.sun_light.w) + frame.cascade[cascade].zw, float(kCascadeWrap));
}
