// What a fragment writes of a layer that drawn styles are made of (render/style_layers.h). All is
// multiplied by the share of a pixel that the layer covers: so averages over samples, and over
// pixels, are averages of what is seen. Needs frame_set.glsl; kGroundSet: the descriptor set.
#include "shared/illumination.h"
#include "shared/sh.h"
#include "shared/style.h"
#include "shared/tone.h"
layout(set = kGroundSet, binding = 0) uniform sampler2DMS ground_depth;
layout(location = 0) out vec4 out_normal;  // unit normal times the ambient coefficient
layout(location = 1) out vec4 out_color;   // reflectance
layout(location = 2) out vec4 out_layer;   // 1, lightness, 1 / distance along the view, noise

/// Size of the noise's patches, as a share of the picture's height.
const float kPatch = 1.0 / 24.0;

/// Samples in which the ground is not in front.
int maskBeforeGround() {
  int mask = 15;
  for (int i = 0; i < 4; ++i)
    if (gl_FragCoord.z < texelFetch(ground_depth, ivec2(gl_FragCoord.xy), i).r) mask &= ~(1 << i);
  return mask;
}

/// `n`: unit; `k`: ambient coefficient; `visible`: share of the sun.
void writeLayer(vec3 position, vec3 n, float k, vec3 color, vec3 visible) {
  float sun = luminanceOf(frame.sun_light.rgb), sky = luminanceOf(frame.open_sky.rgb);
  float light = k * luminanceOf(shIrradiance(n, frame.open_light)) +
                sun * diffuseFactor(n, frame.to_sun.xyz) * luminanceOf(visible);
  float distance = dot(position - frame.eye.xyz, normalize(frame.ray_forward.xyz));
  float height_m = 2.0 * distance * length(frame.ray_down.xyz) / length(frame.ray_forward.xyz);
  out_normal = vec4(n * k, 1.0);
  out_color = vec4(color, 1.0);
  out_layer = vec4(1.0, lightness(light, sun + sky), 1.0 / max(distance, 1e-6),
                   placeNoise(position, max(kPatch * height_m, 1e-6)));
}
