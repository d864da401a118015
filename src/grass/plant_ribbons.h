#ifndef VERDURE_GRASS_PLANT_RIBBONS_H_
#define VERDURE_GRASS_PLANT_RIBBONS_H_

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "shared/grass_ribbon.h"
#include "verdure/grass.h"

namespace verdure {

/// The parts of a plant as the GPU reads them.
std::vector<shared::GrassRibbonPart> ribbonParts(const GrassPlant& plant);

/// A ribbon and what it looks like.
struct DrawnRibbon {
  shared::GrassRibbon ribbon;
  glm::vec3 root_color{0.0f}, tip_color{0.0f};  ///< linear reflectance
  float transmitted = 0.0f;
  float rank = 0.0f;
};

/// The ribbons of the plant with this seed, around the origin.
void appendRibbons(const std::vector<shared::GrassRibbonPart>& parts, std::uint32_t seed,
                   std::vector<DrawnRibbon>& ribbons);

/// Ribbons are drawn as strips between this many places on their middle lines.
inline constexpr int kRibbonStations = 9;

/// How far ribbons go from the origin along x and z, and how high, m.
struct RibbonExtent {
  float x = 0.0f, z = 0.0f;
  float y = 0.0f;
};
void extend(RibbonExtent& extent, const shared::GrassRibbon& ribbon);

/// The farthest that any plant of a kind can go aside from its middle, and up. Never too low.
struct PlantBounds {
  float aside_m = 0.0f;
  float height_m = 0.0f;
};
PlantBounds plantBounds(const GrassPlant& plant);

/// Throws Error, naming `where`, for a species that cannot be grown: numbers out of range, plants
/// higher than its shell, plants that reach farther than half a tile.
void checkGrassSpecies(const GrassSpecies& species, const std::string& where);

}  // namespace verdure

#endif  // VERDURE_GRASS_PLANT_RIBBONS_H_
