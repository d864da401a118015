// I_a of (1): irradiance / pi of a surface by all light but the sun's own.

/// Under the open sky above open ground.
vec3 openLight(vec3 n) {
  vec3 sky = vec3(skyLight(n, frame.sky_light_r), skyLight(n, frame.sky_light_g),
                  skyLight(n, frame.sky_light_b));
  return sky + frame.ground_light.rgb * groundShare(n);
}
