// How grass is lit and composited. Needs grass_place.glsl, terms.glsl, ground.glsl and
// sun_visibility.glsl.

/// Sine of the angle between leaves' normals and the horizon, on the mean.
const float kLeafTilt = 0.35;

struct Light {
  vec3 up;       // irradiance / pi of what faces the sky
  vec3 sideways; // mean of what faces the horizon, any way
  vec3 faces;    // meanFacing()
};

/// What has been met so far.
struct Met {
  vec3 sunlit;   // to be lit by the sun: premultiplied
  vec3 color;    // lit by the rest: premultiplied
  float alpha;
  float depth_t; // where alpha passed the threshold
  float first_t; // where anything was met
  float sum_t;   // the mean place, times alpha
};
const Met kNothingMet = Met(vec3(0.0), vec3(0.0), 0.0, -1.0, -1.0, 0.0);

/// What packGrassData() packed.
vec4 unpackGrassData(vec4 texel) {
  return vec4((texel.xy * 255.0 - 128.0) / 127.0, texel.zw);
}

vec4 canopyAt(float w) {
  float at = clamp(w / grass.shell.x, 0.0, 1.0) * float(kCanopySteps);
  int below = min(int(at), kCanopySteps - 1);
  return mix(grass.canopy[below], grass.canopy[below + 1], at - float(below));
}

/// How a normal faces the sun, as meanFacing().
vec3 facingOf(vec3 normal) {
  float n_l = dot(normal, frame.to_sun.xyz);
  return vec3(max(n_l, 0.0), max(-n_l, 0.0), abs(normal.y));
}

/// Composites what is met, (2.3), `color` times its alpha, by how it faces the sun and by what it
/// transmits, in shares of what it reflects.
void meetFacing(inout Met met, vec4 color, vec3 faces, float through, float w, float t, vec3 tint,
                float density, Light light) {
  if (!kTextures) color.rgb = vec3(0.18 * color.a);
  float share = 1.0 - met.alpha;
  vec3 seen = share * color.rgb * tint;
  vec4 canopy = canopyAt(w);
  float lit = sunThroughGrass(canopy.x * density, frame.to_sun.xyz, grass.rows, grass.shell.yz);
  if (kDiffuse) met.sunlit += seen * (lit * (faces.x + through * faces.y));
  if (kAmbient) {
    if (kAmbientSource == kConstant) {
      met.color += seen * frame.open_sky.rgb;
    } else {
      float open = mix(1.0, canopy.y, density);
      vec3 sky = mix(light.sideways, light.up, faces.z) * open;
      // What is hidden by other plants is as bright as these.
      vec3 green = grass.mean.rgb * (0.5 + 0.5 * grass.mean.w) * (1.0 - open);
      sky += green * (light.up * open + frame.sun_light.rgb * (lit * max(frame.to_sun.y, 0.0)));
      met.color += seen * sky * (1.0 + through);
    }
  }
  met.alpha += share * color.a;
  met.sum_t += share * color.a * t;
  if (met.first_t < 0.0) met.first_t = t;
  if (met.depth_t < 0.0 && met.alpha > grass.limits.y) met.depth_t = t;
}

/// A texel of a picture: `color` and `data` are times its alpha. The picture's axes in the world;
/// `facing` is towards the looker, `behind` if he sees its back.
void meet(inout Met met, vec4 color, vec4 data, vec3 right, vec3 up, vec3 facing, bool behind,
          float w, float t, vec3 tint, float density, Light light) {
  if (color.a <= 0.0) return;
  vec2 n = data.xy / color.a * (behind ? -1.0 : 1.0);
  n /= max(length(n), 1.0);  // rounded
  vec3 normal = right * n.x + up * n.y + facing * sqrt(max(1.0 - dot(n, n), 0.0));
  float through = kTransmission ? data.z / color.a : 0.0;
  // Where a texel mixes many leaves, so does their light: their mean normal would be none of theirs.
  float many = smoothstep(1.0, 4.0, sliceLod(t, 1.0));
  meetFacing(met, color, mix(facingOf(normal), light.faces, many), through, w, t, tint, density, light);
}

/// What is seen through what was met.
void addBehind(inout Met met, Met behind) {
  float share = 1.0 - met.alpha;
  met.sunlit += share * behind.sunlit;
  met.color += share * behind.color;
  met.alpha += share * behind.alpha;
  met.sum_t += share * behind.sum_t;
  if (met.first_t < 0.0) met.first_t = behind.first_t;
  if (met.depth_t < 0.0 && met.alpha > grass.limits.y) met.depth_t = behind.first_t;
}

/// Which of a map's plants stand: those that are not drawn as blades, where the density is d.
void thin(inout vec4 color, inout vec4 data, float density, float blades, float lod) {
  if (color.a <= 0.0) return;
  float rank = data.w / color.a, blur = clamp(0.15 * lod, 0.02, 1.0);
  float standing = plantsStanding(density, rank, blur);
  if (blades > 0.0) standing -= plantsStanding(density * blades, rank, blur);
  color *= standing;
  data *= standing;
}

/// Texels of the ground, layer 0, or of the level slice, 1, at u, v past the eye's tile, seen from a
/// distance t along `direction`.
void meetLevel(inout Met met, vec2 past_tile, float t, vec3 direction, float layer, float share, vec3 n,
               float w, float density, float blades, vec3 tint, Light light) {
  float lod = log2(max(grass.texels.z * grass.texels.w * t * inversesqrt(max(abs(direction.y), 0.05)),
                       1.0));
  vec3 uv = vec3(groundPlace(past_tile), layer);
  vec4 color = share * textureLod(ground_colors, uv, lod);
  vec4 data = share * unpackGrassData(textureLod(ground_data, uv, lod));
  if (layer > 0.0)
    thin(color, data, density, blades, lod);
  else
    color.rgb = mix(grass.soil.rgb * color.a, color.rgb, smoothstep(0.0, 0.4, density));
  light.faces = meanFacing(-direction, frame.to_sun.xyz, 0.8);  // seen from above
  vec3 right = normalize(axisOf(false) - n * dot(axisOf(false), n));
  meet(met, color, data, right, cross(n, right), n, false, w, t, tint, density, light);
}

vec3 shadowAt(vec3 place) {
  if (!kShadow) return vec3(1.0);
  return sunVisibility(frame.eye.xyz + place, vec3(0.0, 1.0, 0.0), vec4(frame.leaf_tint.rgb, 0.0), true);
}

vec3 skyOn(vec3 place, vec3 normal) {
  if (kAmbientSource == kConstant) return frame.open_sky.rgb;
  if (kAmbientSource == kTransfer && frame.ground_map.z > 0.0) return mappedLight(frame.eye.xyz + place);
  return shIrradiance(normal, frame.open_light);
}

/// `sideways`: sidewaysLight(); `direction`: from the eye.
Light lightAt(vec3 place, vec3 sideways, vec3 direction) {
  Light light = Light(frame.open_sky.rgb, frame.open_sky.rgb,
                      meanFacing(-direction, frame.to_sun.xyz, kLeafTilt));
  if (kAmbientSource == kConstant) return light;
  light.up = skyOn(place, vec3(0.0, 1.0, 0.0));
  light.sideways = sideways;
  if (kAmbientSource == kTransfer && frame.ground_map.z > 0.0)
    light.sideways *= light.up / max(frame.open_sky.rgb, vec3(1e-20));
  return light;
}
