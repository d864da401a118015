#include "verdure/leaf_grow.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/parallel.h"
#include "leaf/fill_outside.h"
#include "leaf/grown_leaf.h"
#include "verdure/error.h"

namespace verdure {
namespace {

void checkOptions(const LeafGrowOptions& options) {
  if (options.size < 16 || options.size > 8192)
    throw Error("leaf size", fmt::format("{} texels are out of range", options.size),
                "take 16 to 8192");
  if (!(options.age >= 0 && options.age <= 1))
    throw Error("leaf age", fmt::format("{} is out of range", options.age),
                "take 0 (spring) to 1 (autumn)");
}

LeafSet paintBlade(const GrownLeaf& leaf, const LeafSpecies& species, const LeafFrame& frame,
                   const LeafGrowOptions& options) {
  const BladeFields fields = rasterise(leaf, species, frame);
  const Blemishes blemishes = blemish(leaf, fields, species, options);
  LeafSet set;
  set.width = set.height = options.size;
  set.mm_per_texel = fields.frame.mmPerTexel();
  shapeRelief(fields, species, options.seed, set);
  paintLeaf(fields, blemishes, species, options, set);
  set.opacity = fields.coverage;
  for (std::size_t i = 0; i < set.opacity.size(); ++i)
    set.opacity[i] *= glm::clamp(0.5f + blemishes.hole[i] / set.mm_per_texel, 0.0f, 1.0f);
  return set;
}

/// What is reflected and what comes through on the other side never sum to more than 1.
void limitLight(LeafSet& set) {
  const auto limit = [](const glm::vec3& reflected, glm::vec3& through) {
    const glm::vec3 share = (glm::vec3(0.99f) - reflected) / glm::max(through, glm::vec3(1e-6f));
    through *= glm::clamp(std::min({share.x, share.y, share.z}), 0.0f, 1.0f);
  };
  parallelFor(set.texelCount(), 1 << 14, [&](std::size_t i) {
    limit(set.front.albedo[i], set.back.translucency[i]);
    limit(set.back.albedo[i], set.front.translucency[i]);
  });
}

}  // namespace

LeafSet growLeaf(const LeafGrowOptions& options) {
  return std::move(growLeaves(options, 1).front());
}

std::vector<LeafSet> growLeaves(const LeafGrowOptions& options, int count) {
  const LeafSpecies& species = findLeafSpecies(options.species);
  if (count < 1 || count > 1024)
    throw Error("leaves", fmt::format("{} of them are out of range", count), "take 1 to 1024");
  const std::vector<GrownLeaf> leaves = growForms(species, options.seed, count);
  return paintLeaves(leaves, species, {options.size, frameExtent(leaves)}, options);
}

std::vector<LeafSet> paintLeaves(const std::vector<GrownLeaf>& leaves, const LeafSpecies& species,
                                 const LeafFrame& frame, const LeafGrowOptions& options) {
  checkOptions(options);
  std::vector<LeafSet> sets(leaves.size());
  parallelFor(leaves.size(), 1, [&](std::size_t k) {
    LeafGrowOptions own = options;
    own.seed = options.seed + static_cast<std::uint32_t>(k);
    LeafSet& set = sets[k];
    set = leaves[k].rods.empty() ? paintBlade(leaves[k], species, frame, own)
                                 : paintShoot(leaves[k], species, frame, own);
    set.name = species.info.name;
    set.optics.front_roughness =
        glm::mix(species.roughness, 0.45f, options.age * options.age * options.age);
    const std::vector<std::uint8_t> inside = insideOf(set);
    for (LeafSide* side : {&set.front, &set.back})
      for (std::vector<glm::vec3>* map : {&side->albedo, &side->translucency})
        fillOutside(*map, inside, set.width, set.height);
    limitLight(set);
    checkLeafSet(set, "grown leaf " + species.info.name);
  });
  return sets;
}

}  // namespace verdure
