#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
// Light on each vertex from its transfer vectors: dot products with the harmonics' weights of the
// sky and, for the bounced part, of the sun. Two coefficients share a word (halves).
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Vectors { uint words[]; };
layout(set = 0, binding = 1, std430) readonly buffer Weights { vec2 weights[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Light { uvec4 light[]; };
layout(push_constant) uniform TransferBlock { TransferUniforms transfer; };

/// One colour channel: `pairs` words from `word` on.
float product(uint word, uint weight, uint pairs) {
  float sum = 0.0;
  for (uint i = 0u; i < pairs; ++i)
    sum += dot(unpackHalf2x16(words[word + i]), weights[weight + i]);
  return sum;
}

/// The three channels of sky and sun together, from `word` on.
vec3 sideLight(uint word) {
  vec3 sum;
  for (uint c = 0u; c < 3u; ++c)
    sum[c] = product(word + c * transfer.pairs, transfer.first_weight + c * transfer.pairs,
                     transfer.pairs);
  word += 3u * transfer.pairs;
  for (uint c = 0u; c < 3u; ++c)
    sum[c] += product(word + c * transfer.bounce_pairs,
                      transfer.first_bounce_weight + c * transfer.bounce_pairs,
                      transfer.bounce_pairs);
  return clamp(sum, vec3(0.0), vec3(65000.0));  // ringing may bring a dark place below 0
}

void main() {
  uint v = gl_GlobalInvocationID.x;
  if (v >= transfer.count) return;
  uint side = 3u * (transfer.pairs + transfer.bounce_pairs);
  uint word = v * side * (transfer.two_sided + 1u);
  vec3 front = sideLight(word);
  vec3 back = transfer.two_sided != 0u ? sideLight(word + side) : front;
  light[transfer.first_vertex + v] =
      uvec4(packHalf2x16(front.rg), packHalf2x16(vec2(front.b, 0.0)), packHalf2x16(back.rg),
            packHalf2x16(vec2(back.b, 0.0)));
}
