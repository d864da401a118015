#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "leaf/grown_leaf.h"

namespace verdure {

GrownLeaf growForm(const LeafSpecies& species, std::uint32_t seed) {
  GrownLeaf leaf;
  if (!species.form) {
    leaf.rods = makeRods(seed);
    return leaf;
  }
  leaf.form = species.form(seed);
  leaf.veins = growVenation(leaf.form, species.veins, seed);
  return leaf;
}

std::vector<GrownLeaf> growForms(const LeafSpecies& species, std::uint32_t seed, int count) {
  std::vector<GrownLeaf> leaves(static_cast<std::size_t>(count));
  parallelFor(leaves.size(), 1, [&](std::size_t k) {
    leaves[k] = growForm(species, seed + static_cast<std::uint32_t>(k));
  });
  return leaves;
}

Polyline silhouetteOf(const GrownLeaf& leaf) {
  Polyline points = leaf.form.outline;
  for (const Rod& rod : leaf.rods)
    for (std::size_t i = 0; i < rod.points.size(); ++i)
      for (const glm::vec2 side : {glm::vec2(1, 1), {1, -1}, {-1, 1}, {-1, -1}})
        points.push_back(rod.points[i] + std::max(rod.radii[i], 1.0f) * side);
  return points;
}

float frameExtent(const std::vector<GrownLeaf>& leaves) {
  float extent = 0;
  for (const GrownLeaf& leaf : leaves) extent = std::max(extent, frameExtent(silhouetteOf(leaf)));
  return extent;
}

BladeFields rasterise(const GrownLeaf& leaf, const LeafSpecies& species, const LeafFrame& frame) {
  BladeFields fields;
  fields.frame = frame;
  fields.coverage = coverageOf(leaf.form.outline, frame);
  fields.edge_reach = 0.06f * frame.extent_mm;
  fields.edge = signedDistance(leaf.form.outline, fields.edge_reach, frame);

  std::vector<Stroke> all, major, stalk;
  for (const VeinNode& node : leaf.veins) {
    if (node.parent < 0) continue;
    const VeinNode& parent = leaf.veins[static_cast<std::size_t>(node.parent)];
    // A branch is as thin at its fork as behind it.
    const bool fork = parent.tips > node.tips && parent.order != node.order;
    Stroke stroke{parent.position, node.position, fork ? node.radius : parent.radius, node.radius};
    if (node.midrib && node.position.y <= leaf.form.blade_base + 1e-3f) {
      // The stalk narrows to the midrib.
      const auto radius = [&](float y) {
        const float base = leaf.form.blade_base, thick = stalkRadius(leaf.form, y);
        return glm::mix(thick, node.radius,
                        glm::smoothstep(base - 8 * leaf.form.stalk_radius, base, y));
      };
      stroke.radius_a = radius(stroke.a.y);
      stroke.radius_b = radius(stroke.b.y);
    }
    if (node.position.y < leaf.form.blade_base + 4 * leaf.form.stalk_radius && node.midrib)
      stalk.push_back(stroke);
    all.push_back(stroke);
    if (node.order <= 2) major.push_back(stroke);
  }
  fields.ridge = ridgesOf(all, frame);
  fields.vein = distanceTo(all, 1.2f * species.veins.spacing_mm, frame);
  fields.major = distanceTo(major, 2.2f * species.quilt_reach_mm, frame);
  const float radius = fields.stalk_radius = leaf.form.stalk_radius;
  fields.stalk = distanceTo(stalk, 3 * radius, frame);
  for (std::size_t i = 0; i < fields.stalk.size(); ++i) {
    const auto row = static_cast<float>(i / static_cast<std::size_t>(frame.size)) + 0.5f;
    const float y = frame.toMm({0, row}).y - leaf.form.blade_base;
    fields.stalk[i] = (1 - glm::smoothstep(1.25f * radius, 2.2f * radius, fields.stalk[i])) *
                      (1 - glm::smoothstep(-3 * radius, 3 * radius, y));
  }
  return fields;
}

std::vector<std::uint8_t> insideOf(const LeafSet& set) {
  std::vector<std::uint8_t> inside(set.texelCount());
  for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = set.opacity[i] > 0;
  return inside;
}

}  // namespace verdure
