// Textures of a leaf beyond its base colour, and the light that they let through.
// Layer 0 is the back's albedo and normals, 1 and 2 are light through the leaf that leaves the front
// and the back: its colour, and its coefficients.
layout(set = 1, binding = 3) uniform sampler2DArray leaf_colors;
layout(set = 1, binding = 4) uniform sampler2DArray leaf_vectors;
// DiffuseTransmission: its share (grey), its colour.
layout(set = 1, binding = 5) uniform sampler2D transmission_share;
layout(set = 1, binding = 6) uniform sampler2D transmission_color;

/// Share of all diffuse light that goes through.
float statedShare(float factor, vec2 uv, vec2 uv_x, vec2 uv_y) {
  return factor * textureGrad(transmission_share, uv, uv_x, uv_y).r;
}

vec3 statedColor(vec3 color, vec2 uv, vec2 uv_x, vec2 uv_y) {
  return color * textureGrad(transmission_color, uv, uv_x, uv_y).rgb;
}

/// Of the light through a leaf that leaves the front (layer 1) or the back (2): its colour, and the
/// coefficients of where it comes from. `range`: DrawUniforms::leaf_light.
vec3 lightColor(float layer, vec2 uv, vec2 uv_x, vec2 uv_y) {
  return textureGrad(leaf_colors, vec3(uv, layer), uv_x, uv_y).rgb;
}

vec3 lightCoefficients(float layer, vec4 range, vec2 uv, vec2 uv_x, vec2 uv_y) {
  vec2 side = layer < 1.5 ? range.xy : range.zw;
  return textureGrad(leaf_vectors, vec3(uv, layer), uv_x, uv_y).rgb * side.x + side.y;
}
