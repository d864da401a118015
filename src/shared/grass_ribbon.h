#ifndef VERDURE_SHARED_GRASS_RIBBON_H_
#define VERDURE_SHARED_GRASS_RIBBON_H_

#include "grass.h"
#include "portable.h"

// Blades, stalks, leaflets and petals as ribbons along arcs of circles. What a plant looks like is
// a function of its parts and of one number, so pictures of grass and blades near the camera show
// the same plants. Metres, radians, y up.

SHARED_BEGIN

// RibbonProfile of verdure/grass.h.
const uint kRibbonBlade = 0u;
const uint kRibbonStalk = 1u;
const uint kRibbonOval = 2u;
const uint kRibbonCut = 3u;

/// A GrassPart of verdure/grass.h.
struct GrassRibbonPart {
  vec4
      size;  ///< length, m; its spread, share; width, m; ribbons on the ground begin within this, m
  vec4 turn;   ///< lean and its spread, bend and its spread, radians
  vec4 root;   ///< colour at the foot, linear; w = spread of brightness, share
  vec4 tip;    ///< colour at the end, linear; w = transmitted, share of what is reflected
  uvec4 kind;  ///< profile; 1 on the stalk, else 0; count; number of the part in its plant
};
SHARED_SIZE(GrassRibbonPart, 80);

/// An arc in the plane of `up` and `side`, unit and at right angles. It begins at `root`, `lean`
/// away from `up`, and ends `lean + bend` away from it.
struct GrassRibbon {
  vec3 root;
  float span;  ///< length along the arc, m
  vec3 up;
  float lean;
  vec3 side;
  float bend;
  float width;   ///< where it is widest, m
  float facing;  ///< how far it is turned about its middle line out of the plane's normal, radians
  uint profile;
};

/// Uniform in [0, 1) for a plant's seed, a ribbon of one of its parts, and a purpose.
SHARED_FUNCTION float ribbonRandom(uint plant, uint part, uint index, uint purpose) {
  return float(grassHash(plant, part * 65536u + index, purpose) >> 8u) * (1.0f / 16777216.0f);
}

/// Rank of a plant, uniform in [0, 1): where the grass has density d, plants of rank below d stand.
SHARED_FUNCTION float plantRank(uint plant) {
  return float(grassHash(plant, 0xffffffffu, 0u) >> 8u) * (1.0f / 16777216.0f);
}

/// What the colours of a plant's part are multiplied with: one number for the whole plant.
SHARED_FUNCTION float plantBrightness(GrassRibbonPart part, uint plant) {
  return 1.0f + part.root.w * (2.0f * ribbonRandom(plant, 0xffffu, 0u, 1u) - 1.0f);
}

/// sin(x) / x.
SHARED_FUNCTION float ribbonSinc(float x) {
  return abs(x) < 0.01f ? 1.0f - x * x * (1.0f / 6.0f) : sin(x) / x;
}

/// Middle line at s in [0, 1].
SHARED_FUNCTION vec3 ribbonPoint(GrassRibbon ribbon, float s) {
  float half_turn = 0.5f * ribbon.bend * s;
  float angle = ribbon.lean + half_turn;
  float chord = ribbon.span * s * ribbonSinc(half_turn);
  return ribbon.root + chord * (cos(angle) * ribbon.up + sin(angle) * ribbon.side);
}

/// Unit direction of the middle line at s, towards its end.
SHARED_FUNCTION vec3 ribbonTangent(GrassRibbon ribbon, float s) {
  float angle = ribbon.lean + ribbon.bend * s;
  return cos(angle) * ribbon.up + sin(angle) * ribbon.side;
}

/// The `index`-th ribbon of a part on the ground, of the plant with the seed `plant`.
SHARED_FUNCTION GrassRibbon ribbonOnGround(GrassRibbonPart part, vec3 plant_root, uint plant,
                                           uint index) {
  uint number = part.kind.w;
  float around =
      ribbonRandom(plant, number, 0xffffu, 2u) +
      (float(index) + 0.8f * ribbonRandom(plant, number, index, 3u)) / float(part.kind.z);
  float azimuth = 6.2831853f * around;
  GrassRibbon ribbon;
  ribbon.up = vec3(0.0f, 1.0f, 0.0f);
  ribbon.side = vec3(cos(azimuth), 0.0f, sin(azimuth));
  ribbon.root =
      plant_root + part.size.w * sqrt(ribbonRandom(plant, number, index, 4u)) * ribbon.side;
  ribbon.span =
      part.size.x * (1.0f + part.size.y * (2.0f * ribbonRandom(plant, number, index, 5u) - 1.0f));
  ribbon.lean = part.turn.x + part.turn.y * (2.0f * ribbonRandom(plant, number, index, 6u) - 1.0f);
  ribbon.bend = part.turn.z + part.turn.w * (2.0f * ribbonRandom(plant, number, index, 7u) - 1.0f);
  ribbon.width = part.size.z;
  ribbon.profile = part.kind.x;
  ribbon.facing = 0.0f;
  if (ribbon.profile != kRibbonOval)
    ribbon.facing = 1.6f * (ribbonRandom(plant, number, index, 8u) - 0.5f);
  return ribbon;
}

/// The `index`-th ribbon of a part; `stalk` is the plant's part 0, whose first ribbon carries what
/// grows on the stalk.
SHARED_FUNCTION GrassRibbon ribbonOf(GrassRibbonPart part, GrassRibbonPart stalk, vec3 plant_root,
                                     uint plant, uint index) {
  GrassRibbon ribbon = ribbonOnGround(part, plant_root, plant, index);
  if (part.kind.y != 0u) {
    GrassRibbon carrier = ribbonOnGround(stalk, plant_root, plant, 0u);
    vec3 across = cross(carrier.up, carrier.side);
    vec3 forth = ribbon.side;
    ribbon.root = ribbonPoint(carrier, 1.0f);
    ribbon.up = ribbonTangent(carrier, 1.0f);
    ribbon.side = forth.x * cross(across, ribbon.up) + forth.z * across;
  }
  return ribbon;
}

/// Width at s, m.
SHARED_FUNCTION float ribbonWidth(uint profile, float width, float s) {
  if (profile == kRibbonBlade) {
    if (s < 0.2f) return width * (0.7f + 1.5f * s);
    float rest = (s - 0.2f) * 1.25f;
    return width * (1.0f - rest * rest);
  }
  if (profile == kRibbonOval) return width * sqrt(max(4.0f * s * (1.0f - s), 0.0f));
  return width;
}

/// Unit vector along the ribbon's width at s. Stalks are round: they turn towards the looker, who
/// is seen along the unit vector `toward`.
SHARED_FUNCTION vec3 ribbonAcross(GrassRibbon ribbon, float s, vec3 toward) {
  vec3 across = cross(ribbon.up, ribbon.side);
  vec3 tangent = ribbonTangent(ribbon, s);
  if (ribbon.profile == kRibbonStalk) {
    vec3 turned = cross(tangent, toward);
    float square = dot(turned, turned);
    return square < 1e-6f ? across : turned * (1.0f / sqrt(square));
  }
  return cos(ribbon.facing) * across + sin(ribbon.facing) * cross(across, tangent);
}

/// Unit normal at s and at t in [-1, 1] across the width, on the side that faces the looker.
/// Stalks are round, all others are a little arched.
SHARED_FUNCTION vec3 ribbonNormal(GrassRibbon ribbon, float s, float t, vec3 toward) {
  vec3 across = ribbonAcross(ribbon, s, toward);
  vec3 normal = cross(across, ribbonTangent(ribbon, s));
  float side = dot(normal, toward) < 0.0f ? -1.0f : 1.0f;
  float arch = t * (ribbon.profile == kRibbonStalk ? 1.2f : 0.35f);
  return side * (cos(arch) * normal + sin(arch) * across);
}

/// Reflectance at s, linear.
SHARED_FUNCTION vec3 ribbonColor(GrassRibbonPart part, float s, float brightness) {
  return brightness * mix(vec3(part.root), vec3(part.tip), s);
}

SHARED_END

#endif  // VERDURE_SHARED_GRASS_RIBBON_H_
