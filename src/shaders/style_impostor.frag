#version 460
#extension GL_GOOGLE_include_directive : require
#define kGroundSet 2
#include "frame_set.glsl"
#include "style_layer.glsl"
#include "terms.glsl"
#include "coverage.glsl"
#include "impostor_set.glsl"
#include "impostor.glsl"
#include "sun_visibility.glsl"
// A far tree of a forest: its leaves and its wood are one layer of foliage.

void main() {
  ImpostorKind kind = kinds[job.kind];
  Shown shown = shownThere(kind);
  uint random = scrambled(seat.x ^ 0x5bd1e995u);
  int count = int(floor(shown.covered * 4.0 + pixelThreshold(random)));
  int turned = int(random & 3u), mask = (1 << min(count, 4)) - 1;
  mask = ((mask << turned) | (mask >> (4 - turned))) & 15 & fadeMask(seat) & maskBeforeGround();
  gl_SampleMask[0] = mask;
  if (mask == 0) discard;
  vec3 n = turnedToWorld(shown.normal);
  n = dot(n, n) > 1e-6 ? normalize(n) : vec3(0.0, 1.0, 0.0);
  vec3 v = normalize(frame.eye.xyz - position), surface = position + v * (shown.nearer * scale);
  // Beyond the maps only what the plant's own leaves leave open is known.
  vec3 visible = vec3(1.0);
  if (kShadow && dot(n, frame.to_sun.xyz) > 0.0) {
    vec2 at = abs(cascadePosition(int(frame.to_sun.w) - 1, surface).xy - 0.5);
    float mapped = 1.0 - smoothstep(0.42, 0.48, max(at.x, at.y));
    visible = vec3(smoothstep(0.0, 0.6, shown.light.r));
    if (mapped > 0.0)
      visible = mix(visible, sunVisibility(surface, v, kind.leaf, false), mapped);
  }
  vec3 tint = mix(vec3(1.0), tintOf(seat), shown.light.g);
  writeLayer(surface, n, kAmbientSource == kBaked ? shown.light.r : 1.0, tint * shown.color,
             visible);
}
