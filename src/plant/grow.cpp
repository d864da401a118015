#include "verdure/grow.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "plant/bark_texture.h"
#include "plant/leaf_shape.h"
#include "plant/species.h"
#include "plant/tree_mesh.h"
#include "plant/weber_penn.h"
#include "verdure/error.h"
#include "verdure/leaf_plant.h"

namespace verdure {
namespace {

/// Plant::branches from stems.
std::vector<Branch> branchesOf(std::vector<Stem>& stems) {
  std::vector<Branch> branches(stems.size());
  for (std::size_t i = 0; i < stems.size(); ++i) {
    Branch& branch = branches[i];
    branch.parent = stems[i].parent;
    branch.level = stems[i].level;
    if (branch.parent != kNone) {
      const Stem& parent = stems[branch.parent];
      branch.parent_offset = std::clamp(
          (stems[i].parent_along - parent.start) / (parent.length - parent.start), 0.0f, 1.0f);
    }
  }
  for (std::size_t i = 0; i < stems.size(); ++i) branches[i].points = std::move(stems[i].points);
  return branches;
}

}  // namespace

Plant grow(const GrowOptions& options) {
  const Species& species = findSpecies(options.species);
  TreeParameters parameters = species.parameters;
  for (const auto& [name, value] : options.set) setParameter(parameters, name, value);
  if (options.texture_size < 32 || options.texture_size > 8192 || options.texture_size % 4 != 0)
    throw Error("texture_size", std::to_string(options.texture_size) + " is out of range",
                "give a multiple of 4 from 32 to 8192");
  const auto shape = static_cast<LeafShape>(static_cast<int>(parameters.leaf_shape));

  Plant plant;
  plant.name = options.species;
  // Bark and leaves look the same for all plants of a species: textures do not depend on the seed.
  const auto pattern = static_cast<std::uint32_t>(&species - allSpecies().data()) + 1;
  BarkTexture bark = makeBark(species.bark, options.texture_size, pattern);
  plant.textures.push_back({"bark", std::move(bark.color)});
  plant.textures.push_back({"bark normal", std::move(bark.normal)});
  Material wood;
  wood.name = "bark";
  wood.base_color_texture = 0;
  wood.normal_texture = 1;
  const auto addMesh = [&plant](Mesh&& mesh, const Material& material) {
    mesh.name = material.name;
    mesh.material = static_cast<std::uint32_t>(plant.materials.size());
    plant.materials.push_back(material);
    plant.meshes.push_back(std::move(mesh));
  };

  Skeleton skeleton = growSkeleton(parameters, options.seed);
  const float thin = species.twig_radius, any = std::numeric_limits<float>::max();
  addMesh(meshStems(skeleton, parameters, species.bark.width_m, thin, any), wood);
  if (!skeleton.leaves.empty()) {
    const LeafAtlas atlas =
        growLeafAtlas(leafSpeciesOf(shape), options.texture_size, options.leaf_age);
    Mesh leaves =
        meshLeaves(skeleton, atlas, species.blade, options.leaf_form, shape == LeafShape::kNeedles,
                   static_cast<std::uint32_t>(plant.meshes.size()), plant);
    leaves.material = addLeafMaterial(plant, atlas.set, atlas.light);
    Material& foliage = plant.materials.back();
    leaves.name = foliage.name = "leaf";
    foliage.alpha_cutoff = species.alpha_cutoff;
    plant.meshes.push_back(std::move(leaves));
  }
  // Young wood of species with pale bark has another colour.
  Mesh twigs = meshStems(skeleton, parameters, species.bark.width_m, 0.0f, thin);
  if (!twigs.indices.empty()) {
    Material young = wood;
    young.name = "twig";
    young.base_color = glm::vec4(species.twig_tint, 1.0f);
    addMesh(std::move(twigs), young);
  }
  plant.branches = branchesOf(skeleton.stems);
  return plant;
}

const std::vector<SpeciesInfo>& speciesList() {
  static const std::vector<SpeciesInfo> list = [] {
    std::vector<SpeciesInfo> infos;
    for (const Species& species : allSpecies()) infos.push_back(species.info);
    return infos;
  }();
  return list;
}

std::vector<ParameterInfo> speciesParameters(const std::string& species) {
  return listParameters(findSpecies(species).parameters);
}

}  // namespace verdure
