#ifndef VERDURE_PLANT_SPECIES_H_
#define VERDURE_PLANT_SPECIES_H_

#include <string>
#include <vector>

#include "plant/bark_texture.h"
#include "plant/leaf_texture.h"
#include "plant/tree_mesh.h"
#include "plant/tree_parameters.h"

namespace verdure {

struct Species {
  SpeciesInfo info;
  TreeParameters parameters;
  BarkLook bark;
  LeafLook leaf;
  BladeForm blade;
  float alpha_cutoff = 0.5f;
};

/// All species, in the order of speciesList().
const std::vector<Species>& allSpecies();

/// Throws Error for an unknown name.
const Species& findSpecies(const std::string& name);

}  // namespace verdure

#endif  // VERDURE_PLANT_SPECIES_H_
