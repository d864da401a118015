#ifndef VERDURE_PLANT_SPECIES_H_
#define VERDURE_PLANT_SPECIES_H_

#include <string>
#include <vector>

#include "plant/bark_texture.h"
#include "plant/tree_mesh.h"
#include "plant/tree_parameters.h"

namespace verdure {

struct Species {
  SpeciesInfo info;
  TreeParameters parameters;
  BarkLook bark;
  BladeForm blade;
  float alpha_cutoff = 0.5f;
  float twig_radius = 0;      ///< m: thinner stems are young wood; 0 = none
  glm::vec3 twig_tint{1.0f};  ///< linear: multiplies the bark's colour for young wood
};

/// All species, in the order of speciesList().
const std::vector<Species>& allSpecies();

/// Throws Error for an unknown name.
const Species& findSpecies(const std::string& name);

}  // namespace verdure

#endif  // VERDURE_PLANT_SPECIES_H_
