// Rows of world_from_plant of the instance.
layout(location = 3) in vec4 row0;
layout(location = 4) in vec4 row1;
layout(location = 5) in vec4 row2;
// Added to the index of a beam and of a leaf: where its motion is; its number among plants; tint
// of its leaves, 0xRRGGBB, below how it fades (shared/forest.h).
layout(location = 8) in uvec4 seat_motion;

vec3 worldFromPlant(vec3 p) {
  vec4 q = vec4(p, 1.0);
  return vec3(dot(row0, q), dot(row1, q), dot(row2, q));
}

/// Whether the instance turns the triangles' winding over.
bool isMirrored() {
  return dot(row0.xyz, cross(row1.xyz, row2.xyz)) < 0.0;
}

/// Direction of a normal in the world: the cofactor matrix serves any scale. With `by_winding` a
/// mirrored instance turns the normal over, as it does the triangles' winding.
vec3 worldNormal(vec3 n, bool by_winding) {
  vec3 c0 = cross(row1.xyz, row2.xyz);
  vec3 world = vec3(dot(c0, n), dot(cross(row2.xyz, row0.xyz), n), dot(cross(row0.xyz, row1.xyz), n));
  return !by_winding && dot(row0.xyz, c0) < 0.0 ? -world : world;
}
