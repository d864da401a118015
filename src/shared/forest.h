#ifndef VERDURE_SHARED_FOREST_H_
#define VERDURE_SHARED_FOREST_H_

#include "portable.h"
#include "sway.h"

// A forest's trees as the GPU chooses them: which are seen, and how fine each is drawn.

SHARED_BEGIN

const uint kForestGroup = 128u;       ///< trees that are kept together: a cluster, a work group
const uint kMostForestClasses = 96u;  ///< kinds times their levels and impostor
const uint kMostForestLevels = 4u;    ///< meshes of a kind, the plant itself among them
/// Share of a level's reach over which it gives way to the next.
const float kForestFade = 0.12f;
const uint kForestNone = 0xffffffffu;
/// In the fade of a drawn tree: what the finer level leaves, see keptSamples().
const uint kForestRest = 128u;
const uint kForestWhole = 127u;
/// A tile of the farthest depths has so many pixels a side; 8 x 8 tiles are a block.
const uint kDepthTile = 8u;
/// Trees of a view: all, those that are meshes alone, those that are (or become) impostors.
const uint kForestAll = 0u, kForestFront = 1u, kForestBehind = 2u;

/// verdure::Placement, by its words.
struct ForestPlace {
  uint kind;
  float x, y, z;
  float angle;
  float scale;
  uint tint;
  uint phase;
};
SHARED_SIZE(ForestPlace, 32);

/// Of one kind of plant.
struct ForestKindData {
  vec4 sphere;        ///< around it in any wind that blows: middle and radius, plant's coordinates
  vec4 reach;         ///< how far each mesh is drawn at scale 1, m, rising; the last levels repeat
  uint first_class;   ///< of its meshes, finest first, then of its impostor
  uint meshes;        ///< [1, kMostForestLevels]
  uint has_impostor;  ///< else the last mesh is drawn at any distance
  uint moves;         ///< has motion
  uint beam_base;     ///< where the amplitudes of its first tree's beams are, less its first beam
  uint beams;
  uint leaf_base;
  uint leaves;
  float half_height;  ///< of an upright cylinder around the same middle that holds it, too
  float half_width;
  uint padding0;
  uint padding1;
};
SHARED_SIZE(ForestKindData, 80);

/// From where the forest is looked at.
struct ForestView {
  vec4 planes[6];   ///< dot(xyz, p) + w is negative outside, m
  mat4 clip;        ///< from the world; of the picture
  vec4 eye;         ///< of the picture, from which levels are chosen; w: most reach of meshes, m
  float farthest;   ///< from the eye, m
  uint fades;       ///< levels give way to each other step by step, not at once
  uint first_seat;  ///< where its drawn trees lie
  uint seats;       ///< and how many have room
  uint first_far;   ///< of its impostors
  uint fars;
  uint motion;   ///< 1: all trees around that may be drawn as meshes, for their motion
  uint horizon;  ///< 1: what hills hide is left out
  uint part;     ///< kForestAll, kForestFront or kForestBehind
  uint hides;    ///< 1: what lies behind the farthest depths is left out
  uint width;    ///< of the picture, pixels
  uint height;
  vec4 shade;   ///< of a map of the sun: where light goes, by its steps of 1 m down; w: how low
  uint shades;  ///< 1: what throws no shadow into the picture is left out
  float blur;   ///< as wide as the map\'s filter, m
  uint padding1;
  uint padding2;
};
SHARED_SIZE(ForestView, 256);

/// An impostor is a strip of so many quads, so that it can bend.
const uint kImpostorRows = 4u;
const uint kImpostorVertices = 24u;

/// What draws the impostors of a kind.
struct ImpostorKind {
  vec4 sphere;  ///< of its pictures: middle and radius, plant's coordinates
  vec4 leaf;    ///< of its leaves, as DrawUniforms
  vec4 crown;   ///< verdure::Impostor's: middle of the ellipsoid, extinction
  vec4 radii;   ///< of that; w: of mirroredByLeaves()
  vec4 reach;   ///< as ForestKindData
  uint meshes;
  uint views;  ///< a side
  uint moves;
  uint whole;  ///< seconds
  MotionMoment moment;
  MotionMoment last_moment;  ///< of the last frame, where velocities are asked for
  uint beam;                 ///< its trunk
  uint last_whole;
  uint padding1;
  uint padding2;
};
SHARED_SIZE(ImpostorKind, 304);

/// Push constants of its draws.
struct ImpostorJob {
  uint kind;
  uint range;      ///< of its trees
  uint first_far;  ///< of the view's
  uint cascade;    ///< kForestNone: the picture
  float most;      ///< reach of meshes, m
  uint velocity;   ///< 1: where its vertices were in the last frame is asked for
};
SHARED_SIZE(ImpostorJob, 24);

/// The level at which a tree is drawn, and the one that it gives way to.
struct ForestLevel {
  uint level;
  uint next;    ///< the same where it does not
  float share;  ///< of `level`, (0, 1]
};

/// `reach`, `meshes`, `has_impostor` of the kind; `distance` and `most`, the farthest that meshes
/// are drawn at all, m, both divided by the tree's scale. The impostor is level `meshes`.
SHARED_FUNCTION ForestLevel forestLevel(vec4 reach, uint meshes, uint has_impostor, float distance,
                                        float most) {
  ForestLevel choice;
  uint last = has_impostor != 0u ? meshes : meshes - 1u;
  choice.level = last;
  choice.next = last;
  choice.share = 1.0f;
  for (uint i = 0u; i < last; ++i) {
    float end = min(reach[int(i)], most);
    if (distance >= end) continue;
    choice.level = i;
    choice.next = i;
    float start = end * (1.0f - kForestFade);
    if (distance > start) {
      // Levels that end at the same distance are left out.
      choice.next = i + 1u;
      while (choice.next < last && min(reach[int(choice.next)], most) <= end) ++choice.next;
      choice.share = 1.0f - (distance - start) / (end - start);
    }
    return choice;
  }
  return choice;
}

/// Whether a sphere reaches into a view.
SHARED_FUNCTION bool seesSphere(ForestView view, vec3 middle, float radius) {
  for (int i = 0; i < 6; ++i)
    if (dot(vec3(view.planes[i]), middle) + view.planes[i].w < -radius) return false;
  return length(middle - vec3(view.eye)) - radius < view.farthest;
}

/// Where something is in the picture, all of it: a rectangle of tiles, and its nearest depth.
struct DepthTiles {
  uint first_x;
  uint first_y;
  uint end_x;  ///< behind the last
  uint end_y;
  float depth;  ///< 2 where it reaches behind the eye: nothing hides it
};

/// Half of an upright cylinder's extent along a direction of any length, times that.
SHARED_FUNCTION float cylinderExtent(vec3 along, float half_height, float half_width) {
  return half_height * abs(along.y) + half_width * sqrt(along.x * along.x + along.z * along.z);
}

/// Of the box along the camera's axes that holds an upright cylinder, and a pixel around.
SHARED_FUNCTION DepthTiles depthTilesOf(ForestView view, vec3 middle, float half_height,
                                        float half_width) {
  vec4 clip = view.clip * vec4(middle, 1.0f);
  vec3 x_row = vec3(view.clip[0][0], view.clip[1][0], view.clip[2][0]);
  vec3 y_row = vec3(view.clip[0][1], view.clip[1][1], view.clip[2][1]);
  vec3 z_row = vec3(view.clip[0][2], view.clip[1][2], view.clip[2][2]);
  vec3 w_row = vec3(view.clip[0][3], view.clip[1][3], view.clip[2][3]);
  float half_w = cylinderExtent(w_row, half_height, half_width);
  float near = clip.w - half_w, far = clip.w + half_w;
  DepthTiles tiles;
  tiles.first_x = 0u;
  tiles.first_y = 0u;
  tiles.end_x = 0u;
  tiles.end_y = 0u;
  tiles.depth = 2.0f;
  if (near <= 1e-3f * half_w) return tiles;
  // Depths fall along the axis of the eye.
  tiles.depth = (clip.z - dot(z_row, w_row) / dot(w_row, w_row) * half_w) / near;
  float half_x = cylinderExtent(x_row, half_height, half_width);
  float half_y = cylinderExtent(y_row, half_height, half_width);
  vec2 low = vec2(min((clip.x - half_x) / near, (clip.x - half_x) / far),
                  min((clip.y - half_y) / near, (clip.y - half_y) / far));
  vec2 high = vec2(max((clip.x + half_x) / near, (clip.x + half_x) / far),
                   max((clip.y + half_y) / near, (clip.y + half_y) / far));
  vec2 size = vec2(float(view.width), float(view.height));
  low = clamp((low * 0.5f + 0.5f) * size - 1.0f, vec2(0.0f), size);
  high = clamp((high * 0.5f + 0.5f) * size + 1.0f, vec2(0.0f), size);
  tiles.first_x = uint(low.x) / kDepthTile;
  tiles.first_y = uint(low.y) / kDepthTile;
  tiles.end_x = (uint(high.x) + kDepthTile) / kDepthTile;
  tiles.end_y = (uint(high.y) + kDepthTile) / kDepthTile;
  return tiles;
}

/// Tiles along a side of so many pixels: whole blocks.
SHARED_FUNCTION uint depthTiles(uint pixels) {
  return (pixels + 63u) / 64u * 8u;
}

/// Whether a sphere's shadow, in a map of the sun, may reach into the picture.
SHARED_FUNCTION bool shadesPicture(ForestView map, ForestView picture, vec3 middle, float radius) {
  vec3 way = vec3(map.shade) * max(middle.y + radius - map.shade.w, 0.0f);
  float wide = radius + map.blur + 0.01f * length(way);  // half-shadows of the sun's disc
  for (int i = 0; i < 6; ++i) {
    float here = dot(vec3(picture.planes[i]), middle) + picture.planes[i].w;
    if (here + max(dot(vec3(picture.planes[i]), way), 0.0f) < -wide) return false;
  }
  return true;
}

/// A direction from the plant's coordinates to the world's, by its turn about +Y.
SHARED_FUNCTION vec3 turnedBy(float angle, vec3 v) {
  float c = cos(angle), s = sin(angle);
  return vec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x);
}

/// The middle of a tree's sphere in the world.
SHARED_FUNCTION vec3 forestMiddle(ForestPlace place, vec4 sphere) {
  return vec3(place.x, place.y, place.z) + place.scale * turnedBy(place.angle, vec3(sphere));
}

/// Which of a pixel's four samples a tree may cover that fades in or out: a level and the one that
/// takes its place have none in common, and all together. `noise` in [0, 1) is the pixel's and the
/// tree's.
SHARED_FUNCTION uint keptSamples(uint fade, float noise) {
  if (fade == kForestWhole) return 15u;
  uint share = fade & kForestWhole;
  uint count = min(uint(floor(float(share) * (4.0f / 127.0f) + noise)), 4u);
  uint turn = uint(floor(noise * 64.0f)) & 3u;
  uint mask = (1u << count) - 1u;
  mask = ((mask << turn) | (mask >> (4u - turn))) & 15u;
  return (fade & kForestRest) != 0u ? 15u - mask : mask;
}

/// How far light has come through a crown that arrives at `from`, in radii of a sphere: both in
/// coordinates in which the crown's ellipsoid is the unit sphere. `toward` the light, any length.
SHARED_FUNCTION float wayThroughCrown(vec3 from, vec3 toward) {
  float size = length(toward);
  vec3 d = toward * (1.0f / max(size, 1e-20f));
  float along = dot(from, d);
  float square = along * along + 1.0f - dot(from, from);
  return square > 0.0f ? max(sqrt(square) - along, 0.0f) : 0.0f;
}

/// What a cloud of small mirrors, of the refractive index of leaves, sends towards `v` of light
/// from `l` (both unit), in shares of irradiance / pi: their normals are spread as those of an
/// ellipsoid whose projected area from above is `upright` times that from the side (Heitz, Dupuy,
/// Crassin, Dachsbacher, "The SGGX Microflake Distribution", SIGGRAPH 2015, (4) and (10), with
/// Schlick's Fresnel factor).
SHARED_FUNCTION float mirroredByLeaves(float upright, vec3 l, vec3 v) {
  vec3 h = l + v;
  float size = length(h);
  if (size < 1e-4f) return 0.0f;
  h = h * (1.0f / size);
  float grazing = 1.0f - clamp(dot(h, l), 0.0f, 1.0f);
  float fresnel = 0.034f + 0.966f * grazing * grazing * grazing * grazing * grazing;
  float spread = h.x * h.x + h.z * h.z + h.y * h.y / (upright * upright);
  float seen = sqrt(v.x * v.x + v.z * v.z + upright * upright * v.y * v.y);
  return 0.25f * fresnel / (upright * spread * spread * seen);
}

/// Irradiance by direction on leaves that face all ways, of which `normal` is the mean: the cosine
/// to light from `l`, clamped, by its harmonics of three bands (Ramamoorthi and Hanrahan 2001),
/// with the mean's length for what they have in common. [0, 1.07].
SHARED_FUNCTION float meanCosine(vec3 normal, vec3 l) {
  float x = dot(normal, l);
  return max(0.25f + 0.5f * x + 0.15625f * (3.0f * x * x - dot(normal, normal)), 0.0f);
}

SHARED_END

#endif  // VERDURE_SHARED_FOREST_H_
