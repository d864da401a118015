#ifndef VERDURE_TERRAIN_H_
#define VERDURE_TERRAIN_H_

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace verdure {

/// Ground as a height field over the plane of x and z, bilinear between its samples; beyond them it
/// goes on as its edge.
struct Terrain {
  int width = 0, height = 0;   ///< samples along x and along z, at least 2
  glm::vec2 corner{0.0f};      ///< x, z of the first sample
  glm::vec2 spacing_m{1.0f};   ///< between samples along x and z, above 0
  std::vector<float> heights;  ///< m; width * height, rows along x, the smallest z first

  float heightAt(const glm::vec2& place) const;      ///< at x, z
  glm::vec3 normalAt(const glm::vec2& place) const;  ///< unit, up; smooth: of central differences
};

/// A number for each place of the ground, [0, 1], bilinear; beyond its edge it goes on as that. How
/// densely a kind of grass grows, for example.
struct CoverMap {
  int width = 0, height = 0;  ///< at least 1
  glm::vec2 corner{0.0f};     ///< x, z of the outer corner of the first texel
  glm::vec2 size_m{1.0f};
  std::vector<float> values;  ///< rows along x, the smallest z first

  float at(const glm::vec2& place) const;
};

struct TerrainOptions {
  glm::vec2 size_m{200.0f};  ///< along x and z, above 0; its middle lies at x = z = 0
  float lowest_m = 0.0f, highest_m = 20.0f;  ///< of black and white, finite
};

/// Reads a PNG of 8 or 16 bits, grey (or the first channel); its top row lies at the smallest z.
/// Throws Error: not a picture, one texel wide or high, numbers out of range.
Terrain readTerrain(const std::filesystem::path& path, const TerrainOptions& options);

/// Reads a picture's first channel; the same place as readTerrain()'s.
CoverMap readCoverMap(const std::filesystem::path& path, const glm::vec2& size_m);

struct TerrainGrowOptions {
  std::uint64_t seed = 1;
  glm::vec2 size_m{200.0f};
  float relief_m = 12.0f;  ///< between its lowest and highest place, at least 0
  float hill_m = 60.0f;    ///< size of the largest hills, above 0
  int samples = 257;       ///< along x and z, 9 to 8193
};

/// Rolling hills: a sum of smooth noise, the height 0 at x = z = 0, and level for 3 m around (for
/// 0.15 of the shorter side, if that is less). Deterministic. Throws Error for numbers out of
/// range.
Terrain growTerrain(const TerrainGrowOptions& options);

/// Throws Error unless sizes and numbers are what they should be; places and heights at most
/// 10,000 km from the origin, samples at least 0.1 mm apart.
void checkTerrain(const Terrain& terrain, const std::string& where);
void checkCoverMap(const CoverMap& map, const std::string& where);

}  // namespace verdure

#endif  // VERDURE_TERRAIN_H_
