#ifndef VERDURE_BASE_TILE_NOISE_H_
#define VERDURE_BASE_TILE_NOISE_H_

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "base/random.h"

// Noise that repeats after 1 in both directions, for textures that tile. u and v run over [0, 1).

namespace verdure {

/// Uniform in [0, 1) for a lattice point: two rounds of a 32-bit mixer (textures ask for tens of
/// millions of these; the 64-bit hash of base/random.h takes twice as long).
inline float latticeValue(int x, int y, std::uint32_t seed) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x8da6b343u ^
                    static_cast<std::uint32_t>(y) * 0xd8163841u ^ (seed + 1) * 0xcb1ab31fu;
  h = (h ^ (h >> 16)) * 0x21f0aaadu;
  h = (h ^ (h >> 15)) * 0x735a2d97u;
  h ^= h >> 15;
  return static_cast<float>(h >> 8) * 0x1p-24f;
}

/// i modulo n, for i near [0, n).
inline int wrap(int i, int n) {
  while (i < 0) i += n;
  while (i >= n) i -= n;
  return i;
}

inline int floorOf(float x) {
  const int i = static_cast<int>(x);
  return i - (x < static_cast<float>(i) ? 1 : 0);
}

/// Smooth noise in [0, 1] with nu x nv cells.
inline float valueNoise(float u, float v, int nu, int nv, std::uint32_t seed) {
  const float x = u * static_cast<float>(nu), y = v * static_cast<float>(nv);
  const int x0 = floorOf(x), y0 = floorOf(y);
  float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  fx = fx * fx * fx * (fx * (fx * 6 - 15) + 10);
  fy = fy * fy * fy * (fy * (fy * 6 - 15) + 10);
  const int xa = wrap(x0, nu), xb = wrap(x0 + 1, nu);
  const int ya = wrap(y0, nv), yb = wrap(y0 + 1, nv);
  return glm::mix(glm::mix(latticeValue(xa, ya, seed), latticeValue(xb, ya, seed), fx),
                  glm::mix(latticeValue(xa, yb, seed), latticeValue(xb, yb, seed), fx), fy);
}

/// Sum of octaves of valueNoise, each twice as fine and half as strong; in [0, 1].
inline float fractalNoise(float u, float v, int nu, int nv, int octaves, std::uint32_t seed) {
  float sum = 0, weight = 0, amplitude = 1;
  for (int o = 0; o < octaves; ++o) {
    sum += amplitude * valueNoise(u, v, nu, nv, seed + static_cast<std::uint32_t>(o));
    weight += amplitude;
    amplitude *= 0.5f;
    nu *= 2;
    nv *= 2;
  }
  return sum / weight;
}

/// Worley's cells (1996): distance to the nearest point, by how much the second is farther, and a
/// value of the nearest cell, all in units of cells. Only the eight cells around are searched,
/// which is enough where the second point is nearer than a cell.
struct Cell {
  float nearest, border, value;
};
inline Cell cellNoise(float u, float v, int nu, int nv, std::uint32_t seed) {
  const float x = u * static_cast<float>(nu), y = v * static_cast<float>(nv);
  const int x0 = floorOf(x), y0 = floorOf(y);
  float first = 1e9f, second = 1e9f, value = 0;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      const int cx = wrap(x0 + i, nu), cy = wrap(y0 + j, nv);
      const float px = static_cast<float>(x0 + i) + 0.1f + 0.8f * latticeValue(cx, cy, seed);
      const float py = static_cast<float>(y0 + j) + 0.1f + 0.8f * latticeValue(cx, cy, seed + 77);
      const float d = std::sqrt((px - x) * (px - x) + (py - y) * (py - y));
      if (d < first) {
        second = first;
        first = d;
        value = latticeValue(cx, cy, seed + 154);
      } else if (d < second) {
        second = d;
      }
    }
  return {first, second - first, value};
}

}  // namespace verdure

#endif  // VERDURE_BASE_TILE_NOISE_H_
