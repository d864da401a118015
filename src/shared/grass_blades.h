#ifndef VERDURE_SHARED_GRASS_BLADES_H_
#define VERDURE_SHARED_GRASS_BLADES_H_

#include "grass_ribbon.h"
#include "portable.h"

// Plants near the eye, drawn one by one: one stands in each cell of a lattice that its kind has.

SHARED_BEGIN

/// A ribbon that is drawn.
struct GrassBlade {
  vec3 root;    ///< of its plant, from the eye
  uint plant;   ///< seed
  uint part;    ///< of the layer's
  uint index;   ///< among the part's ribbons
  float scale;  ///< of the plant: small ones grow as the eye comes near
  float density;
};
SHARED_SIZE(GrassBlade, 32);

/// Push constants of grass_blades.comp: all plants of one kind within a square around the eye.
struct BladeJob {
  mat4 clip_from_eye;  ///< without what depends on the eye's place
  vec2 past;           ///< the eye's place in its cell, m
  float cell_m;
  float reach_m;   ///< a plant's farthest point from its root
  uvec2 eye_cell;  ///< its number, wrapped
  uint cells;      ///< along the square's side, even
  uint kind;       ///< of plant
  uint first_part;
  uint parts;
};
SHARED_SIZE(BladeJob, 104);

/// Segments along a ribbon, each two triangles.
const uint kBladeSegments = 6u;

SHARED_END

#endif  // VERDURE_SHARED_GRASS_BLADES_H_
