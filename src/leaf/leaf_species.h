#ifndef VERDURE_LEAF_LEAF_SPECIES_H_
#define VERDURE_LEAF_LEAF_SPECIES_H_

#include <functional>
#include <vector>

#include "leaf/leaf_form.h"
#include "leaf/pigments.h"
#include "leaf/venation.h"
#include "verdure/leaf_grow.h"

namespace verdure {

struct LeafSpecies {
  LeafSpeciesInfo info;
  std::function<LeafPlan(std::uint64_t seed)> form;  ///< none: a shoot with needles
  VenationOptions veins;

  float thickness_mm = 0.2f;    ///< of the blade between veins
  float protrusion = 1.0f;      ///< of veins at the back, by their radius
  float groove = 0.7f;          ///< of veins at the front, by their radius
  float quilt_mm = 0.3f;        ///< height of the bulges between large veins
  float quilt_reach_mm = 2.5f;  ///< from a vein to the bulge's top
  float pillow_mm = 0.04f;      ///< the same between fine veins
  float wave_mm = 0.5f;         ///< slow ups and downs of the blade
  float areole_mm = 0.45f;      ///< fields of the finest net

  Pigments spring, summer, autumn, stalk;
  float back_path = 0.62f;      ///< how deep light goes in at the back, by the front's
  float back_bloom = 0.03f;     ///< white wax and hairs: added reflectance
  float vein_contrast = 0.75f;  ///< how much of its pigments a vein lacks
  float edge_browning = 1.0f;   ///< how far autumn dries the margin, by the usual
  float roughness = 0.3f;       ///< LeafOptics::front_roughness
};

const std::vector<LeafSpecies>& allLeafSpecies();
/// Throws Error, naming them all, if there is none.
const LeafSpecies& findLeafSpecies(const std::string& name);

}  // namespace verdure

#endif  // VERDURE_LEAF_LEAF_SPECIES_H_
