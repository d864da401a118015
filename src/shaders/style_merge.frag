#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/style.h"
// Wood, foliage and ground as they are seen: each layer was drawn as if the other were not there.
layout(set = 0, binding = 0) uniform sampler2D foliage_normal;
layout(set = 0, binding = 1) uniform sampler2D foliage_layer;
layout(set = 0, binding = 2) uniform sampler2D wood_normal;
layout(set = 0, binding = 3) uniform sampler2D wood_layer;
layout(set = 0, binding = 4) uniform sampler2DMS ground_depth;
layout(push_constant) uniform StyleBlock { StyleUniforms style; };
layout(constant_id = 0) const bool kNormals = true;
/// kNormals: unit normals times the ambient coefficient times the covered share, which is the last;
/// else shares of foliage and wood, lightness, and depth, in which the ground takes part.
layout(location = 0) out vec4 out_seen;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 foliage = texelFetch(foliage_layer, at, 0), wood = texelFetch(wood_layer, at, 0);
  // Of what they cover both, the nearer one is seen.
  float wood_first = blurredDepthTest(wood.z * foliage.x, foliage.z * wood.x, 0.01);
  vec2 left = vec2(1.0 - wood_first * wood.x, 1.0 - (1.0 - wood_first) * foliage.x);
  vec2 share = left * vec2(foliage.x, wood.x);
  if (kNormals) {
    vec3 n = left.x * texelFetch(foliage_normal, at, 0).xyz +
             left.y * texelFetch(wood_normal, at, 0).xyz;
    out_seen = vec4(n, share.x + share.y);
    return;
  }
  float ground = 0.0;
  for (int i = 0; i < 4; ++i) ground += 0.25 * texelFetch(ground_depth, at, i).r;
  out_seen = vec4(share, left.x * foliage.y + left.y * wood.y,
                  left.x * foliage.z + left.y * wood.z +
                      max(1.0 - share.x - share.y, 0.0) * ground * style.picture.z);
}
