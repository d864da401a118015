#ifndef VERDURE_SCATTER_H_
#define VERDURE_SCATTER_H_

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "verdure/placement.h"
#include "verdure/terrain.h"

namespace verdure {

/// One kind among the plants that are scattered.
struct ScatterKind {
  std::uint32_t plant = 0;        ///< Placement::plant
  float share = 1.0f;             ///< of the places, in shares of all kinds' sum, above 0
  float radius_m = 1.0f;          ///< two places are at least both radii apart, at least 0
  glm::vec2 scale{0.85f, 1.15f};  ///< least and most, above 0; uniform between
};

/// Ground that is taken: no plant's own circle overlaps it.
struct TakenCircle {
  glm::vec2 center{0.0f};  ///< x, z
  float radius_m = 0.0f;   ///< at least 0
};

struct ScatterOptions {
  std::vector<ScatterKind> kinds;  ///< 1 to 64; either all or none with a radius of 0
  std::uint64_t seed = 1;
  glm::vec2 corner{0.0f};    ///< least x and z of the area
  glm::vec2 size_m{100.0f};  ///< above 0
  /// Places a square metre where the map is white; unset: as many as find room. Never more than
  /// that. Needed where kinds have no radius.
  std::optional<float> per_m2;
  const CoverMap* density = nullptr;                         ///< times that; null: 1 everywhere
  const Terrain* terrain = nullptr;                          ///< null: the plane at height 0
  float most_slope = 1.6f;                                   ///< of the ground, radians
  float lowest_m = -std::numeric_limits<float>::infinity();  ///< of the ground
  float highest_m = std::numeric_limits<float>::infinity();
  std::vector<TakenCircle> taken;
  float hue_spread = 0.1f;         ///< of tints: yellowish to bluish green, [0, 1]
  float brightness_spread = 0.2f;  ///< tints are as bright as 1 less this to 1, [0, 1]
};

/// Most places that scatterPlants() makes.
inline constexpr std::size_t kMostScattered = std::size_t{1} << 27;

/// Places of plants by chance, on the ground, with a random turn, scale, tint and phase. With radii
/// they are a Poisson-disk sampling (Cook, "Stochastic Sampling in Computer Graphics", 1986), close
/// to a maximal one for a single kind without `per_m2`: darts are thrown into all cells of a grid
/// in turn, and only where the cells are not yet covered (after Wei, "Parallel Poisson Disk
/// Sampling", 2008, and White, Cline, Egbert, "Poisson Disk Point Sets by Hierarchical Dart
/// Throwing", 2007). Of several kinds the largest come first, and all discs together cover about
/// half of the ground; a kind that finds too little room thins out the others, so that shares hold.
/// The density map thins all kinds alike. The same options give the same places, to the bit, for
/// any number of threads. Throws Error: numbers out of range, more than kMostScattered places or
/// than memory has room for.
std::vector<Placement> scatterPlants(const ScatterOptions& options);

}  // namespace verdure

#endif  // VERDURE_SCATTER_H_
