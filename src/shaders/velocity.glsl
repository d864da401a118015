// How far what is seen in a pixel has come since the last frame. Needs frame_set.glsl.

/// `now`, `last`: clip x, y, w. Pixels, x right, y down; what was behind the eye came from nowhere.
vec2 wayOf(vec3 now, vec3 last) {
  vec2 way = last.z > 0.0 ? now.xy / now.z - last.xy / last.z : vec2(0.0);
  return way / vec2(frame.ray_right.w, frame.ray_down.w);
}
