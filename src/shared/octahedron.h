#ifndef VERDURE_SHARED_OCTAHEDRON_H_
#define VERDURE_SHARED_OCTAHEDRON_H_

#include "portable.h"

// Directions of the upper hemisphere on a square: the upper half of an octahedron, unfolded
// (Engelhardt, Dachsbacher, "Octahedron Environment Maps", VMV 2008), turned so that the horizon is
// the square's border.

SHARED_BEGIN

/// Where a unit direction lies in [0, 1]^2; those below the horizon as if they were on it.
SHARED_FUNCTION vec2 octahedronPlace(vec3 direction) {
  float y = max(direction.y, 0.0f);
  float sum = abs(direction.x) + y + abs(direction.z);
  if (sum <= 0.0f) return vec2(0.5f, 0.5f);
  float x = direction.x / sum, z = direction.z / sum;
  return vec2(0.5f + 0.5f * (x + z), 0.5f + 0.5f * (x - z));
}

/// Its inverse, unit.
SHARED_FUNCTION vec3 octahedronDirection(vec2 place) {
  float u = 2.0f * place.x - 1.0f, v = 2.0f * place.y - 1.0f;
  float x = 0.5f * (u + v), z = 0.5f * (u - v);
  return normalize(vec3(x, 1.0f - abs(x) - abs(z), z));
}

/// A picture's axis to the right, unit, for a view from `direction`; its axis upwards is
/// cross(direction, right).
SHARED_FUNCTION vec3 viewRight(vec3 direction) {
  // Straight from above any will do.
  vec2 across = vec2(direction.z, -direction.x);
  float size = length(across);
  if (size < 1e-4f) return vec3(1.0f, 0.0f, 0.0f);
  return vec3(across.x / size, 0.0f, across.y / size);
}

/// The three pictures of a grid of `views` x `views` that are nearest to a direction, and their
/// weights, which sum to 1.
struct NearestViews {
  vec3 weights;
  vec2 first, second, third;  ///< columns and rows
};

SHARED_FUNCTION NearestViews nearestViews(vec3 direction, float views) {
  vec2 at = octahedronPlace(direction) * (views - 1.0f);
  vec2 cell = min(floor(at), vec2(views - 2.0f));
  vec2 f = at - cell;
  NearestViews nearest;
  nearest.first = cell;
  nearest.third = cell + vec2(1.0f, 1.0f);
  // Two triangles of the cell, on either side of its diagonal.
  if (f.x > f.y) {
    nearest.second = cell + vec2(1.0f, 0.0f);
    nearest.weights = vec3(1.0f - f.x, f.x - f.y, f.y);
  } else {
    nearest.second = cell + vec2(0.0f, 1.0f);
    nearest.weights = vec3(1.0f - f.y, f.y - f.x, f.x);
  }
  return nearest;
}

SHARED_END

#endif  // VERDURE_SHARED_OCTAHEDRON_H_
