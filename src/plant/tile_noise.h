#ifndef VERDURE_PLANT_TILE_NOISE_H_
#define VERDURE_PLANT_TILE_NOISE_H_

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "base/random.h"

// Noise that repeats after 1 in both directions, for textures that tile. u and v run over [0, 1).

namespace verdure {

inline float latticeValue(int x, int y, std::uint32_t seed) {
  const auto key = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32) |
                   static_cast<std::uint32_t>(y);
  return static_cast<float>(hash(key ^ (std::uint64_t{seed} * 0x9e3779b97f4a7c15ull)) >> 40) *
         0x1p-24f;
}

inline int wrap(int i, int n) {
  return ((i % n) + n) % n;
}

/// Smooth noise in [0, 1] with nu x nv cells.
inline float valueNoise(float u, float v, int nu, int nv, std::uint32_t seed) {
  const float x = u * static_cast<float>(nu), y = v * static_cast<float>(nv);
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  fx = fx * fx * fx * (fx * (fx * 6 - 15) + 10);
  fy = fy * fy * fy * (fy * (fy * 6 - 15) + 10);
  const auto at = [&](int dx, int dy) {
    return latticeValue(wrap(x0 + dx, nu), wrap(y0 + dy, nv), seed);
  };
  return glm::mix(glm::mix(at(0, 0), at(1, 0), fx), glm::mix(at(0, 1), at(1, 1), fx), fy);
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
/// value of the nearest cell, all in units of cells.
struct Cell {
  float nearest, border, value;
};
inline Cell cellNoise(float u, float v, int nu, int nv, std::uint32_t seed) {
  const float x = u * static_cast<float>(nu), y = v * static_cast<float>(nv);
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  float first = 1e9f, second = 1e9f, value = 0;
  for (int j = -2; j <= 2; ++j)
    for (int i = -2; i <= 2; ++i) {
      const int cx = wrap(x0 + i, nu), cy = wrap(y0 + j, nv);
      const float px = static_cast<float>(x0 + i) + 0.1f + 0.8f * latticeValue(cx, cy, seed);
      const float py = static_cast<float>(y0 + j) + 0.1f + 0.8f * latticeValue(cx, cy, seed + 77);
      const float d = std::hypot(px - x, py - y);
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

#endif  // VERDURE_PLANT_TILE_NOISE_H_
