#ifndef VERDURE_SHARED_GRASS_H_
#define VERDURE_SHARED_GRASS_H_

#include "portable.h"
#include "sway.h"
#include "terrain.h"

// Rays through grass: Habel, "Real-time Rendering and Animation of Vegetation", dissertation, TU
// Wien 2009, chapter 2. Lengths in metres; u and v along the ground, w above it.

SHARED_BEGIN

/// PCG's output hash of two numbers and a salt.
SHARED_FUNCTION uint grassHash(uint a, uint b, uint salt) {
  uint x = a * 0x8da6b343u + b * 0xd8163841u + salt * 0xcb1ab31fu + 0x9e3779b9u;
  x = x * 747796405u + 2891336453u;
  x = ((x >> ((x >> 28u) + 4u)) ^ x) * 277803737u;
  return (x >> 22u) ^ x;
}

/// Wang tiles (Cohen, Shade, Hiller, Deussen, "Wang Tiles for Image and Texture Generation", 2003)
/// of two colours, packed so that each tile's neighbours in the picture match and the picture
/// repeats (Wei, "Tile-Based Texture Mapping on Graphics Hardware", 2004): its borders have the
/// colours 0, 0, 1, 1 and again. The column of a tile whose left border has the colour `left`.
SHARED_FUNCTION uint wangColumn(uint left, uint right) {
  // 00 01 11 10
  return left == 0u ? right : 3u - right;
}

/// Salts of grassHash(): what is asked for.
const uint kSliceKindOfU = 1u;    ///< and 2 of v
const uint kBorderOfU = 3u;       ///< along a slice across u; 4 across v
const uint kBorderOfGround = 5u;  ///< across u; 6 across v

/// Colour of the border `border` of a line of tiles.
SHARED_FUNCTION uint wangColor(uint line, uint border, uint salt) {
  return grassHash(line, border, salt) >> 31u;
}

/// Where a place on a line of Wang tiles is in their picture, [0, 1): `tile` is the tile's number
/// and `share` the place in it, [0, 1).
SHARED_FUNCTION float wangPlace(uint line, uint tile, float share, uint salt) {
  uint column = wangColumn(wangColor(line, tile, salt), wangColor(line, tile + 1u, salt));
  return (float(column) + share) * 0.25f;
}

/// Which kind of slice stands at the plane of this number.
SHARED_FUNCTION uint sliceKind(uint plane, uint kinds, uint salt) {
  return grassHash(plane, 0u, salt) % kinds;
}

/// Where the slice of this number stands, in spacings: off its even place by up to `scatter` in [0,
/// 1), so that they do not stand in rows.
SHARED_FUNCTION float slicePlace(int plane, uint eye_plane, float scatter, uint salt) {
  uint random = grassHash(eye_plane + uint(plane), 7u, salt);
  return float(plane) + scatter * float(random >> 8u) * 5.9604644775390625e-8f;
}

/// Share of plants of this rank that stand where the density is d, both [0, 1]. `blur`: how widely
/// ranks are mixed in what is looked at, (0, 1]: from 0 for one plant to 1 for many, of which the
/// share d stands.
SHARED_FUNCTION float plantsStanding(float density, float rank, float blur) {
  return clamp(0.5f + (density - mix(rank, 0.5f, blur)) / max(blur, 0.02f), 0.0f, 1.0f);
}

/// Height of grass of this density, in shares of the full one: sparse grass is low.
SHARED_FUNCTION float grassHeight(float density) {
  return mix(0.4f, 1.0f, clamp(density * 1.5f, 0.0f, 1.0f));
}

/// How far tips go aside in wind, in shares of their height, along x and z: leaning with gusts, the
/// same that trees are in, and shaking by `noise`, [-1, 1]. Exactly 0 without wind.
SHARED_FUNCTION vec2 grassBend(MotionMoment moment, vec3 place, vec2 noise) {
  float speed = gustySpeed(moment, place);
  // Half of the most at 7 m/s: blades give way as branches do, at less.
  float push = speed * speed / (speed * speed + 49.0f);
  vec2 toward = vec2(moment.toward.x, moment.toward.z);
  vec2 across = vec2(-toward.y, toward.x);
  return push * (toward * (0.75f + 0.55f * noise.x) + across * (0.35f * noise.y));
}

/// A blade's point at rest height w goes aside by this times grassBend() times the height of all.
SHARED_FUNCTION float bendShape(float w, float height) {
  float share = clamp(w / height, 0.0f, 1.0f);
  return share * share;
}

/// What a blade's point that is seen at height w was at rest: bent blades are as long as before.
SHARED_FUNCTION float heightAtRest(float w, vec2 bend) {
  return w * (1.0f + 0.35f * dot(bend, bend));
}

/// Height over the ground along a ray, w(t) = w + slope t + curve t^2.
struct ShellPath {
  float w;
  float slope;
  float curve;
};

/// Through three heights at 0, t / 2 and t.
SHARED_FUNCTION ShellPath shellPath(float w_0, float w_half, float w_1, float t) {
  ShellPath path;
  path.w = w_0;
  path.slope = (4.0f * w_half - 3.0f * w_0 - w_1) / t;
  path.curve = 2.0f * (w_0 - 2.0f * w_half + w_1) / (t * t);
  return path;
}
SHARED_FUNCTION float shellHeight(ShellPath path, float t) {
  return path.w + t * (path.slope + t * path.curve);
}

/// Never reached.
const float kFarAway = 1e9f;

/// Where the path sinks through a height, `rising` false, or rises through it: t > 0, or kFarAway.
SHARED_FUNCTION float shellCrossing(ShellPath path, float height, bool rising) {
  float side = rising ? 1.0f : -1.0f;
  // a t^2 + b t + c = 0; the root where the slope has the sign of `side`.
  float a = path.curve, b = path.slope * side, c = (path.w - height) * side;
  a = a * side;
  float discriminant = b * b - 4.0f * a * c;
  if (discriminant < 0.0f) return kFarAway;
  float root = sqrt(discriminant);
  float t = kFarAway;
  if (b > 0.0f)
    t = -2.0f * c / (b + root);
  else if (a > 1e-9f)
    t = (root - b) / (2.0f * a);
  return t > 0.0f ? t : kFarAway;
}

/// What slices look like from afar: pictures of so many columns and rows, each in so many levels;
/// a level's columns are mixed twice as widely as the last one's, its rows are not.
const int kFarColumns = 256;
const int kFarRows = 64;
const int kFarLevels = 8;

/// How leaves that stand upright and face all ways face the sun: means, over those that a looker
/// sees, of the cosines on the side that he sees and on the other, the phase functions of a matt
/// cylinder; and their share that faces up. `toward`: unit, to the looker; `tilt`: sine of how far
/// their normals are off the horizon.
SHARED_FUNCTION vec3 meanFacing(vec3 toward, vec3 to_sun, float tilt) {
  float level = sqrt(max(1.0f - tilt * tilt, 0.0f));
  float aside = sqrt(to_sun.x * to_sun.x + to_sun.z * to_sun.z);
  float look = sqrt(toward.x * toward.x + toward.z * toward.z);
  float cosine = (toward.x * to_sun.x + toward.z * to_sun.z) / max(aside * look, 1e-6f);
  cosine = clamp(cosine, -1.0f, 1.0f);
  float angle = acos(cosine), sine = sqrt(max(1.0f - cosine * cosine, 0.0f));
  float front = 0.25f * ((3.14159265f - angle) * cosine + sine);
  float back = 0.25f * (sine - angle * cosine);
  float up = 0.5f * tilt * max(to_sun.y, 0.0f);
  return vec3(level * aside * front + up, level * aside * back + up, tilt);
}

/// Steps of canopy[]: over the shell's height.
const int kCanopySteps = 32;

/// One layer of grass for the shaders: std140. Places are relative to the eye, so that nothing is
/// lost far from the origin.
struct GrassUniforms {
  vec4 shell;         ///< height, spacing of slices across u and v, side of a tile, m
  vec4 limits;        ///< most slices on a ray, alpha that writes depth, middle plane (0, 1), kinds
  vec4 texels;        ///< a metre along slices, up them, on the ground; w = a pixel's angle
  vec4 rows;          ///< u = x rows.x + z rows.y, v = x rows.z + z rows.w
  vec4 eye;           ///< u, v past the plane across u, v at or before the eye; u, v past its tile
  uvec4 eye_cell;     ///< numbers of these planes and tiles, wrapped
  vec4 terrain;       ///< first sample's x, z from the eye; distance of samples along x, z, m
  vec4 terrain_size;  ///< samples along x, z; 1 if the eye is in the shell; 1 if rays end at depth
  vec4 terrain_range;  ///< lowest and highest place, height of the eye, m; 1 if all is level
  vec4 cover;          ///< corner's x, z from the eye; texels a metre along x, z
  vec4 cover_size;     ///< texels along x, z; density of the layer; share of tones that vary
  vec4 blades;         ///< distances between which near blades fade out; both 0: there are none
  vec4 soil;           ///< reflectance
  vec4 mean;           ///< reflectance of the plants; w = what is transmitted, in shares of that
  vec4 placing;        ///< how far slices are off their even distances, in shares of them; height
                       ///< of the highest plant
  vec4 scroll;         ///< how far the wind's noise has come, [0, 1): x, z at two sizes
  /// At even heights: optical depth of the slices above, for one slice a metre along the ground
  /// (times metres along the ground); how much of the sky is seen. z: the height in shares of the
  /// shell's where that depth has grown to a share of all of which the root is even.
  vec4 canopy[33];
  MotionMoment moment;
};
SHARED_SIZE(GrassUniforms, 880);

/// Side of the noise of wind, m, at its two sizes.
const float kWindNoise_m = 37.0f;
const float kWindRipple_m = 5.3f;

/// Share of the sun that comes through slices of which it meets `depth` along the ground.
SHARED_FUNCTION float sunThroughGrass(float depth, vec3 to_sun, vec4 rows, vec2 spacing) {
  float u = abs(to_sun.x * rows.x + to_sun.z * rows.y);
  float v = abs(to_sun.x * rows.z + to_sun.z * rows.w);
  return exp(-depth * (u / spacing.x + v / spacing.y) / max(to_sun.y, 0.02f));
}

SHARED_END

#endif  // VERDURE_SHARED_GRASS_H_
