// What a card shows of a plant. Needs impostor_set.glsl.
layout(location = 0) in vec3 local;
layout(location = 1) in vec3 position;
layout(location = 2) flat in vec3 local_eye;
layout(location = 3) flat in vec3 weights;
layout(location = 4) flat in uvec3 views;
layout(location = 5) flat in vec2 turn;
layout(location = 6) flat in uvec2 seat;
layout(location = 7) flat in float scale;

struct Shown {
  float covered;
  vec3 color;     // of what is there
  vec3 normal;    // plant's coordinates, short where leaves face all ways
  vec3 light;     // ambient, share of foliage, light through leaves
  float nearer;   // than the card, m at scale 1
};

/// Where a ray from the eye through the card meets the plane of a view that lies `nearer` to it than
/// the sphere's middle; in its picture.
vec2 placeInView(vec4 sphere, vec3 ray, vec3 toward, float nearer) {
  vec3 middle = sphere.xyz + nearer * toward;
  float steep = dot(ray, toward);
  vec3 p = local + ray * (dot(middle - local, toward) / (abs(steep) > 0.05 ? steep : -0.05));
  vec3 right = viewRight(toward), up = cross(toward, right);
  vec2 at = vec2(dot(p - sphere.xyz, right), dot(p - sphere.xyz, up)) / sphere.w;
  return vec2(0.5 + 0.5 * at.x, 0.5 - 0.5 * at.y);
}

Shown shownThere(ImpostorKind kind) {
  vec3 ray = normalize(local - local_eye);
  vec4 color = vec4(0.0), normal = vec4(0.0);
  vec3 light = vec3(0.0);
  for (int i = 0; i < 3; ++i) {
    float layer = float(views[i]);
    vec2 cell = vec2(float(views[i] % kind.views), float(views[i] / kind.views));
    vec3 toward = octahedronDirection(cell / (float(kind.views) - 1.0));
    // The plane of the picture first, then that of what is seen there.
    vec2 flat_at = placeInView(kind.sphere, ray, toward, 0.0);
    vec2 uv_x = dFdx(flat_at), uv_y = dFdy(flat_at);
    float covered = textureGrad(impostor_color, vec3(flat_at, layer), uv_x, uv_y).a;
    float depth = textureGrad(impostor_normal, vec3(flat_at, layer), uv_x, uv_y).a;
    // Where a texel is smaller than a pixel it need not move, and what lies at the border would smear.
    float footprint = max(length(uv_x), length(uv_y)) * float(textureSize(impostor_color, 0).x);
    float detail = clamp(2.0 - 0.5 * footprint, 0.0, 1.0);
    float nearer = covered > 0.02 ? detail * (2.0 * depth / covered - 1.0) * kind.sphere.w : 0.0;
    vec3 at = vec3(placeInView(kind.sphere, ray, toward, nearer), layer);
    vec4 c = textureGrad(impostor_color, at, uv_x, uv_y);
    vec4 n = textureGrad(impostor_normal, at, uv_x, uv_y);
    color += weights[i] * c;
    normal += weights[i] * vec4((n.xyz * 255.0 - 128.0) / 127.0, n.w);
    light += weights[i] * textureGrad(impostor_light, at, uv_x, uv_y).rgb;
  }
  Shown shown;
  shown.covered = color.a;
  float whole = 1.0 / max(color.a, 1e-3);
  shown.color = color.rgb * whole;
  shown.normal = normal.xyz * whole;
  shown.light = light * whole;
  shown.nearer = (2.0 * normal.w * whole - 1.0) * kind.sphere.w;
  return shown;
}

/// How much the nearest picture alone says that it covers: for the sun's maps, which are finer than
/// the pictures and need many texels.
float coveredInNearest(ImpostorKind kind) {
  uint view = weights.x >= max(weights.y, weights.z) ? views.x
              : weights.y >= weights.z               ? views.y
                                                     : views.z;
  vec2 cell = vec2(float(view % kind.views), float(view / kind.views));
  vec3 toward = octahedronDirection(cell / (float(kind.views) - 1.0));
  vec2 at = placeInView(kind.sphere, normalize(local - local_eye), toward, 0.0);
  return texture(impostor_color, vec3(at, float(view))).a;
}

vec3 turnedToPlant(vec3 v) {
  return vec3(turn.x * v.x - turn.y * v.z, v.y, turn.x * v.z + turn.y * v.x);
}

vec3 turnedToWorld(vec3 v) {
  return vec3(turn.x * v.x + turn.y * v.z, v.y, turn.x * v.z - turn.y * v.x);
}
