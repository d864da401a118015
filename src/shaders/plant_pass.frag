#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "shared/cook_torrance.h"
#include "shared/gloss.h"
#include "shared/illumination.h"
#include "shared/leaf.h"
#include "shared/leaf_basis.h"
#include "shared/leaf_visibility.h"
#include "shared/normal_map.h"
#include "shared/sh.h"
#include "shared/tone.h"
#include "terms.glsl"
#include "coverage.glsl"
#include "leaf_maps.glsl"
#include "sun_visibility.glsl"
#include "haze.glsl"

layout(set = 1, binding = 0) uniform sampler2D base_color;
layout(set = 1, binding = 1) uniform sampler2D normal_map;
layout(set = 1, binding = 2) uniform sampler2D thickness_map;
layout(push_constant) uniform DrawBlock { DrawUniforms draw; };

// Centroid: where a covered sample lies. At the edge of a small leaf the pixel's centre is outside,
// where the texture is transparent and extrapolated light is anything, even negative.
layout(location = 0) in vec3 position;
layout(location = 1) centroid in vec4 in_normal;
layout(location = 2) in vec2 uv;
layout(location = 3) centroid in vec2 covered_uv;
// Irradiance / pi on the side of the vertex normal and on the other, from transfer vectors.
layout(location = 4) centroid in vec3 front_light;
layout(location = 5) centroid in vec3 back_light;
/// Of the triangle: that of its first corner.
layout(location = 6) flat in uint seed;
layout(location = 7) centroid in vec2 visibility_of_sides;
layout(location = 8) flat in uint mirrored;
layout(location = 9) flat in uvec2 seat;  // instance.glsl
layout(location = 0) out vec4 out_color;

const bool kLeafHasMaps = kLeafModel != kLeafColor;

/// Mean luminance of sky and ground that a wide gloss mirrors towards r. What stands around takes
/// the share of it that it takes of the light `near` on the surface.
vec3 mirroredLight(vec3 r, vec3 n, vec3 near, float k_a) {
  if (kAmbientSource == kConstant) return frame.open_sky.rgb;
  vec3 open = shIrradiance(r, frame.open_light);
  if (kAmbientSource == kSky) return open;
  if (kAmbientSource == kBaked) return open * k_a;
  float unshadowed = luminanceOf(shIrradiance(n, frame.open_light));
  return open * (unshadowed > 0.0 ? min(luminanceOf(near) / unshadowed, 1.0) : 0.0);
}

/// (6): the outgoing distance is random, but always the same for a texel of the leaf; where texels
/// are smaller than pixels, its mean.
float scatteredInLeaf(vec3 k_t, vec2 uv_x, vec2 uv_y) {
  float s_i = draw.matt.w > 0.0 ? draw.matt.w : leafOpticalDepth(k_t);
  if (kThicknessMap) s_i *= textureGrad(thickness_map, uv, uv_x, uv_y).g;
  vec2 size = vec2(textureSize(base_color, 0));
  float footprint = max(length(uv_x * size), length(uv_y * size));
  ivec2 texel = ivec2(floor(uv * size));
  uint random = scrambled(uint(texel.x) + scrambled(uint(texel.y)));
  float s_o = s_i * float(random >> 8u) * exp2(-24.0);
  float detail = size.x > 1.0 ? clamp(2.0 - 2.0 * footprint, 0.0, 1.0) : 0.0;
  return mix(meanScatteredLight(s_i), scatteredLight(s_i, s_o), detail);
}

void main() {
  // Derivatives come first: behind the discard below they are not defined.
  vec3 p_x = dFdx(position), p_y = dFdy(position);
  vec2 uv_x = dFdx(uv), uv_y = dFdy(uv);
  vec4 texel = vec4(1.0);
  // Derivatives from the centres, which lie in one plane.
  if (kTextures || kAlphaTest)
    texel = textureGrad(base_color, covered_uv, uv_x, uv_y);
  int mask = kAlphaTest ? coverageMask(texel.a, draw.surface.x, seed) : 15;
  if (kForest) mask &= fadeMask(seat);
  gl_SampleMask[0] = mask;
  if ((kAlphaTest || kForest) && mask == 0) discard;
  bool front = gl_FrontFacing == (mirrored == 0u);  // of the leaf
  if (kLeafHasMaps && !front)
    texel.rgb = textureGrad(leaf_colors, vec3(covered_uv, 0.0), uv_x, uv_y).rgb;
  vec3 color = kTextures ? texel.rgb * draw.color.rgb : draw.matt.rgb;
  vec3 tint = kForest && kFoliage ? tintOf(seat) : vec3(1.0);
  color *= tint;

  // Opposite normals of neighbouring vertices cancel somewhere between them.
  vec3 n = dot(in_normal.xyz, in_normal.xyz) > 1e-12 ? normalize(in_normal.xyz) : vec3(0, 1, 0);
  if (kFlipNormal && !gl_FrontFacing) n = -n;
  mat3 side = textureFrame(n, p_x, p_y, uv_x, uv_y);  // that is seen
  if (kLeafHasMaps && !front)
    n = mappedNormal(side, textureGrad(leaf_vectors, vec3(uv, 0.0), uv_x, uv_y).xyz,
                     draw.surface.y);
  else if (kNormalMap && kTextures)
    n = mappedNormal(side, textureGrad(normal_map, uv, uv_x, uv_y).xyz, draw.surface.y);
  vec3 l = frame.to_sun.xyz;
  vec3 v = normalize(frame.eye.xyz - position);

  // Light through the leaf: its colour and, as a vector, where it comes from.
  vec3 k_t = leafTransmittance(color);
  if (kStatedTransmission) {
    float share = statedShare(draw.transmission.w, covered_uv, uv_x, uv_y);
    k_t = share * statedColor(draw.transmission.rgb, covered_uv, uv_x, uv_y) * tint;
    color *= 1.0 - share;
  }
  vec3 through = vec3(0.0);
  float even = 1.0;
  if (kLeafHasMaps && kTransmission) {
    float layer = front ? 1.0 : 2.0;
    vec3 h = lightCoefficients(layer, draw.leaf_light, uv, uv_x, uv_y);
    k_t = lightColor(layer, covered_uv, uv_x, uv_y) * tint;
    even = leafEvenDirection(h).z;
    vec3 q = kLeafModel == kLeafMaps ? leafDirection(h) : vec3(0.0, 0.0, even);
    through = leafThrough(side, q);
  }

  // The light on the side that is seen, and on the other.
  vec3 near = vec3(0.0), beyond = vec3(0.0);
  if (kAmbient) {
    if (kAmbientSource == kTransfer) {
      near = gl_FrontFacing ? front_light : back_light;
      beyond = gl_FrontFacing ? back_light : front_light;
    } else if (kAmbientSource == kConstant) {
      near = beyond = frame.open_sky.rgb;
    } else {
      vec2 k_a = vec2(kAmbientSource == kBaked ? in_normal.w : 1.0);
      if (kAmbientSource == kLeafVisibility)
        k_a = visibilityShares(visibility_of_sides, gl_FrontFacing, frame.open_sky.w);
      near = shIrradiance(n, frame.open_light) * k_a.x;
      if (kTransmission)
        beyond = k_a.y * (kLeafHasMaps ? shIrradianceAlong(-side[2], through, frame.open_light)
                                       : shIrradiance(-n, frame.open_light));
    }
  }
  vec3 ambient = near * color;
  vec3 diffuse = kDiffuse ? color * diffuseFactor(n, l) : vec3(0.0);
  if (kScattering) diffuse *= scatteredInLeaf(k_t * even, uv_x, uv_y);
  // Near its plane, bumps of a leaf that face the sun are in each other's shade.
  float risen = kLeafHasMaps ? lightOnBumps(draw.leaf_gloss.w, dot(side[2], l)) : 1.0;
  diffuse *= risen;
  if (kTransmission) {
    bool summed = kLeafHasMaps && (kAmbientSource == kConstant || kAmbientSource == kTransfer);
    ambient += beyond * k_t * (summed ? even : 1.0);
    if (kDiffuse) diffuse += k_t * (kLeafHasMaps ? max(dot(through, l), 0.0)
                                                 : diffuseFactor(-n, l));
  }
  float roughness = front ? draw.leaf_gloss.x : draw.leaf_gloss.y;
  bool glossy = !kLeafHasMaps || roughness > 0.0;
  if (kGloss && glossy) {
    float mirrored = draw.surface.w * glossReflected(glossWidth(kFoliage), draw.surface.z,
                                                     max(dot(n, v), 0.0));
    ambient *= 1.0 - mirrored;
    diffuse *= 1.0 - mirrored;
    if (kAmbient) ambient += mirrored * mirroredLight(reflect(-v, n), n, near, in_normal.w);
  }
  float k_s = draw.surface.w * highlightStrength(glossWidth(kFoliage), draw.surface.z);
  float specular = 0.0;
  if (kSpecular && kLeafHasMaps) {
    if (glossy) specular = risen * cookTorrance(n, l, v, roughness, draw.leaf_gloss.z);
    k_s = 1.0;
  } else if (kSpecular) {
    specular = specularFactor(n, l, v, highlightExponent(kFoliage));
  }
  vec3 visibility = vec3(1.0);
  if (kShadow && (diffuse != vec3(0.0) || specular > 0.0)) {
    vec3 face = cross(p_x, p_y);
    visibility = sunVisibility(position, dot(face, face) > 0.0 ? normalize(face) : n,
                               draw.leaf, false);
  }
  vec3 lit = illumination(ambient, frame.sun_light.rgb, visibility, diffuse,
                          k_s, specular);
  out_color = vec4(clamp(kForest ? hazed(lit, position) : lit, vec3(0.0), vec3(65000.0)), 1.0);
}
