#ifndef VERDURE_SHARED_NORMAL_MAP_H_
#define VERDURE_SHARED_NORMAL_MAP_H_

#include "portable.h"

SHARED_BEGIN

/// The directions of a texture on a surface: to the right of the image, up in it (against glTF's v)
/// and n, without vertex tangents: they follow from how position and texture coordinates change
/// along any two directions in the surface, x and y (screen derivatives, or edges of the triangle):
/// Schueler, "Followup: Normal Mapping Without Precomputed Tangents", 2013. n is unit; the longer
/// of the other two is, too, and both are zero where texture coordinates stand still.
SHARED_FUNCTION mat3 textureFrame(vec3 n, vec3 p_x, vec3 p_y, vec2 uv_x, vec2 uv_y) {
  vec3 x_perpendicular = cross(p_y, n), y_perpendicular = cross(n, p_x);
  float handedness = dot(p_x, x_perpendicular) < 0.0f ? -1.0f : 1.0f;
  vec3 t = (x_perpendicular * uv_x.x + y_perpendicular * uv_y.x) * handedness;
  vec3 b = (x_perpendicular * uv_x.y + y_perpendicular * uv_y.y) * -handedness;
  float longest = max(dot(t, t), dot(b, b));
  float unit = longest > 0.0f ? 1.0f / sqrt(longest) : 0.0f;
  return mat3(t * unit, b * unit, n);
}

/// Normal map, green up. `texel` in [0, 1].
SHARED_FUNCTION vec3 mappedNormal(mat3 frame_of_texture, vec3 texel, float scale) {
  vec3 m = texel * (255.0f / 127.0f) - vec3(128.0f / 127.0f);
  return normalize(frame_of_texture * vec3(m.x * scale, m.y * scale, max(m.z, 0.05f)));
}

/// Share of the light on bumps that others between them and the light leave: Smith's shadowing of
/// facets with Beckmann's distribution, by the fit of Walter et al., "Microfacet Models for
/// Refraction through Rough Surfaces", 2007. With it bumps get on the mean what the plane gets.
/// `slope`: root of their mean squared slope; `cosine`: of the light with the plane's normal, 0
/// behind it.
SHARED_FUNCTION float lightOnBumps(float slope, float cosine) {
  if (cosine <= 0.0f) {
    return 0.0f;
  }
  float a = cosine / (max(slope, 1e-4f) * sqrt(max(1.0f - cosine * cosine, 1e-8f)));
  return a < 1.6f ? (3.535f * a + 2.181f * a * a) / (1.0f + 2.276f * a + 2.577f * a * a) : 1.0f;
}

SHARED_END

#endif  // VERDURE_SHARED_NORMAL_MAP_H_
