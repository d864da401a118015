#ifndef VERDURE_GROW_H_
#define VERDURE_GROW_H_

#include <string>
#include <utility>
#include <vector>

#include "verdure/plant.h"

namespace verdure {

enum class LeafForm {
  kMesh,  ///< folded, curved blades of at least 4 triangles (needles: crossed strips)
  kCard   ///< one quad a leaf
};

struct GrowOptions {
  std::string species = "quaking-aspen";
  std::uint32_t seed = 1;
  LeafForm leaf_form = LeafForm::kMesh;
  /// Overrides of the species' parameters, by the paper's names: {"Levels", "3"},
  /// {"1CurveV", "40"}. Angles in degrees, lengths in metres, as in the paper. Added to them:
  /// LeafBend, LeafDistrib and LeafQuality (constants in the paper's text).
  std::vector<std::pair<std::string, std::string>> set;
  int texture_size = 512;  ///< side of the textures, pixels: a multiple of 4, 32 to 8192
  float leaf_age = 0.4f;   ///< [0, 1]: 0 fresh in spring, 0.4 summer, 1 autumn
};

/// Grows a tree by the model of Weber and Penn, "Creation and Rendering of Realistic Trees",
/// SIGGRAPH 1995. The plant stands on the origin, +Y up; its branches, leaves, materials and
/// textures are filled in. Leaves are four of growLeaf(), with the light through them
/// (addLeafMaterial()). The same options give the same plant on every machine with the same
/// floating-point arithmetic, for any number of threads. Throws Error for an unknown species or
/// parameter, or a value out of range.
///
/// Meshes, each with a material of its name: "bark" (wood), "leaf" (foliage; none when Leaves is 0)
/// and, for species whose young wood has another colour, "twig" (wood). Each stem is a closed
/// surface in one of the wood meshes; each leaf is one connected piece. A clone (split) is a branch
/// of its own, of the same level as the stem it leaves.
Plant grow(const GrowOptions& options);

struct SpeciesInfo {
  std::string name;    ///< as given to GrowOptions::species
  std::string title;   ///< "Quaking aspen (Populus tremuloides)"
  std::string source;  ///< where its parameters come from
};

/// All species, in a fixed order.
const std::vector<SpeciesInfo>& speciesList();

struct ParameterInfo {
  std::string name;
  std::string value;  ///< the species' own
  std::string help;   ///< meaning and unit
};

/// All parameters of a species, in the order of the paper's tables. Throws Error if unknown.
std::vector<ParameterInfo> speciesParameters(const std::string& species);

}  // namespace verdure

#endif  // VERDURE_GROW_H_
