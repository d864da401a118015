#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "shared/illumination.h"
#include "terms.glsl"
#include "dome_light.glsl"
#include "grass_set.glsl"
#include "grass_place.glsl"

// Slices of grass as polygons, farthest first. What changes little along them is found at their
// corners.
struct Billboard {
  int plane;     // of the slice, from the eye's
  uint axis;     // 0: across u, 1: across v
  float begin;   // along it past the eye's tile, m
  float end;
};
layout(set = 2, binding = 0, std430) readonly buffer Billboards { Billboard billboards[]; };

layout(location = 0) out vec3 from_eye;
layout(location = 1) out vec4 picture;   // along past the eye's tile, height, longer at rest, bend: m
layout(location = 2) out vec4 tint;      // w = density
layout(location = 3) out vec4 sideways;  // light; w = height that this grass has, in shares
layout(location = 4) out vec4 haze;      // its luminance, premultiplied by its share, w
layout(location = 5) flat out uvec2 slice;  // number, axis

void main() {
  Billboard quad = billboards[gl_VertexIndex / 6];
  int corner = gl_VertexIndex % 6;
  bool at_end = corner == 1 || corner == 2 || corner == 4;
  bool at_top = corner == 2 || corner == 4 || corner == 5;
  bool across_u = quad.axis == 0u;

  float spacing = across_u ? grass.shell.y : grass.shell.z;
  uint eye_plane = across_u ? grass.eye_cell.x : grass.eye_cell.y;
  float across = slicePlace(quad.plane, eye_plane, grass.placing.x, quad.axis) * spacing -
                 (across_u ? grass.eye.x : grass.eye.y);
  float past_tile = at_end ? quad.end : quad.begin;
  float along = past_tile - (across_u ? grass.eye.w : grass.eye.z);
  vec2 at = (across_u ? across : along) * grass.rows.xy + (across_u ? along : across) * grass.rows.zw;
  vec3 foot = vec3(at.x, groundHeight(at) - frame.eye.y, at.y);

  float density = clamp(coverAt(at), 0.0, 1.0);
  float tall = grassHeight(density);
  vec3 place = frame.eye.xyz + foot;
  vec2 bend = grassBend(grass.moment, place, windNoise(place));
  float height = at_top ? grass.placing.y * tall : 0.0;
  from_eye = foot + vec3(0.0, height, 0.0);
  gl_Position = clipFromEye(from_eye);

  float distance = length(from_eye);
  vec3 direction = from_eye / distance;
  picture = vec4(past_tile, height, heightAtRest(1.0, bend),
                 dot(across_u ? grass.rows.zw : grass.rows.xy, bend) * grass.shell.x);
  tint = vec4(grassTint(place.xz, distance), density);
  sideways = vec4(sidewaysLight(direction), tall);
  float share = hazeShare(distance, frame.ground.z);
  haze = vec4((kBackground ? vec3(0.0) : domeLuminance(direction)) * share, share);
  slice = uvec2(eye_plane + uint(quad.plane), quad.axis);
}
