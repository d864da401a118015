#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/foliage_shadow.h"
// Mean depth of all that hides the sun in a block of texels of one cascade's maps: depth times
// share of the block, and that share. The ground looks for its half-shadow's width here.
layout(set = 0, binding = 0) uniform sampler2DArray foliage_map;
layout(set = 0, binding = 1) uniform sampler2DArray shadow_depth;
layout(push_constant) uniform CascadeBlock { int cascade; };
layout(location = 0) out vec2 out_blocker;

void main() {
  vec2 texel = 1.0 / vec2(textureSize(shadow_depth, 0).xy);
  vec2 corner = floor(gl_FragCoord.xy) * float(blockerBlock()) * texel;
  vec2 sum = vec2(0.0);
  // A quarter of all squares of four texels, two in each row and column of squares: nothing thin
  // that lies along them slips through.
  for (int row = 0; row < blockerBlock() / 2; ++row)
    for (int column = 2 * (row & 1) + ((row >> 1) & 1); column < blockerBlock() / 2; column += 4) {
      vec3 at = vec3(corner + (2.0 * vec2(column, row) + 1.0) * texel, float(cascade));
      LeafLayers leaves = leafLayers(textureLod(foliage_map, at, 0.0));
      sum += leaves.covered * vec2(0.5 * (leaves.near + leaves.far), 1.0);
      vec4 depth = textureGather(shadow_depth, at);
      vec4 wood = 0.25 * vec4(lessThan(depth, vec4(1.0)));
      sum += vec2(dot(wood, depth), dot(wood, vec4(1.0)));
    }
  out_blocker = sum * (16.0 / float(blockerBlock() * blockerBlock()));
}
