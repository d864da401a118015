#ifndef VERDURE_GRASS_WANG_PLANTS_H_
#define VERDURE_GRASS_WANG_PLANTS_H_

#include <array>
#include <cstdint>
#include <vector>

#include "grass/plant_ribbons.h"

/// Plants on Wang tiles. A plant that crosses a tile's border belongs to the border's colour, one
/// that does not to the tile. Where each plant would stand is drawn uniformly, and how far it
/// reaches does not depend on that: so the density is even across borders.
namespace verdure {

/// What grows, and how densely.
struct Planting {
  std::vector<GrassPlant> plants;
  float density = 1.0f;  ///< multiplies per_m2
  float tile_m = 0.5f;
  std::uint64_t seed = 1;
};

/// Plants of a strip of tiles: x along the strip, z across it. Each list is relative to its tile's
/// left border or to its border.
struct StripPlants {
  float tile_m = 0.0f;
  std::array<std::vector<DrawnRibbon>, 4> tiles;    ///< of wangColumn()
  std::array<std::vector<DrawnRibbon>, 2> borders;  ///< of each colour
};
/// A strip `depth_m` wide; roots lie at z in [0, depth_m).
StripPlants plantStrip(const Planting& planting, float depth_m);
/// Plants of a sequence of tiles: `borders` are the colours from left to right, the last is that of
/// the right end, which is planted if `ends`.
std::vector<DrawnRibbon> plantsOfStrip(const StripPlants& strip,
                                       const std::vector<std::uint32_t>& borders, bool ends);

/// Plants of the square of 4 x 4 tiles that repeats: x to the right, z down, both in
/// [0, 4 tile_m).
std::vector<DrawnRibbon> plantSquare(const Planting& planting);

/// The colours of the borders of the four tiles that repeat, and again the first.
inline const std::vector<std::uint32_t> kWangBorders{0, 0, 1, 1, 0};

}  // namespace verdure

#endif  // VERDURE_GRASS_WANG_PLANTS_H_
