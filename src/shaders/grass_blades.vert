#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "grass_set.glsl"
#include "grass_place.glsl"
#include "grass_blades_set.glsl"
layout(set = 2, binding = 1, std430) readonly buffer Blades { GrassBlade blades[]; };

// Centroid: ribbons are thin, and beside of them all that is interpolated may be anything.
layout(location = 0) centroid out vec3 out_from_eye;
layout(location = 1) centroid out vec3 out_normal;
layout(location = 2) centroid out vec4 out_color;  // and what is transmitted
layout(location = 3) centroid out vec3 out_place;  // height in the canopy, density, half of the width
layout(location = 4) centroid out vec3 out_tint;

void main() {
  GrassBlade blade = blades[gl_InstanceIndex];
  GrassRibbonPart part = parts[blade.part];
  GrassRibbonPart stalk = parts[blade.part - part.kind.w];
  GrassRibbon ribbon = ribbonOf(part, stalk, vec3(0.0), blade.plant, blade.index);
  float s = float(gl_VertexIndex / 2) / float(kBladeSegments);
  float side = (gl_VertexIndex & 1) == 0 ? -1.0 : 1.0;
  vec3 toward = -normalize(blade.root);
  float half_width = 0.5 * ribbonWidth(ribbon.profile, ribbon.width, s);
  vec3 across = ribbonAcross(ribbon, s, toward);
  vec3 p = (ribbonPoint(ribbon, s) + half_width * side * across) * blade.scale;
  vec3 n = ribbonNormal(ribbon, s, side, toward);
  // In wind, as the slices are looked up.
  vec3 world = frame.eye.xyz + blade.root;
  vec2 bend = grassBend(grass.moment, world, windNoise(world));
  vec2 moved = bend * (grass.shell.x * bendShape(p.y / max(grassHeight(blade.density), 0.01), grass.shell.x));
  p.y /= heightAtRest(1.0, bend);
  out_place = vec3(p.y, blade.density, half_width);
  p.xz += moved;
  out_from_eye = blade.root + p;
  out_normal = n;
  out_color = vec4(ribbonColor(part, s, plantBrightness(part, blade.plant)), part.tip.w);
  out_tint = grassTint(world.xz, length(blade.root));
  gl_Position = clipFromEye(out_from_eye);
}
