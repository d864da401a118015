#version 460
#extension GL_GOOGLE_include_directive : require
#include "style_set.glsl"
// Normals as colours: right, up and towards the eye are red, green and blue; none is grey.
void main() {
  vec4 seen = textureLod(sharp_normals, placeInPicture(), 0.0);
  vec3 n = vec3(dot(seen.xyz, style.right.xyz), dot(seen.xyz, style.up.xyz),
                dot(seen.xyz, style.back.xyz));
  vec3 level = mix(vec3(1.0), 0.5 * n / max(seen.w, 1e-4) + 0.5, seen.w);
  out_color = vec4(clamp(level, 0.0, 1.0), 1.0);
}
