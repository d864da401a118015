#include <algorithm>
#include <cmath>

#include "leaf/leaf_maps.h"

namespace verdure {

GrownLeaf growForm(const LeafSpecies& species, std::uint32_t seed) {
  GrownLeaf leaf;
  leaf.form = species.form(seed);
  leaf.veins = growVenation(leaf.form, species.veins, seed);
  return leaf;
}

BladeFields rasterise(const GrownLeaf& leaf, const LeafSpecies& species, int size) {
  BladeFields fields;
  fields.frame = frameOf(leaf.form.outline, size);
  const LeafFrame& frame = fields.frame;
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
    if (node.position.y <= leaf.form.blade_base + 1e-3f && node.order == 1) {
      stroke.radius_a = stalkRadius(leaf.form, stroke.a.y);
      stroke.radius_b = stalkRadius(leaf.form, stroke.b.y);
      stalk.push_back(stroke);
    }
    all.push_back(stroke);
    if (node.order <= 2) major.push_back(stroke);
  }
  fields.ridge = ridgesOf(all, frame);
  fields.vein = distanceTo(all, 1.2f * species.veins.spacing_mm, frame);
  fields.major = distanceTo(major, 2.2f * species.quilt_reach_mm, frame);
  const float radius = leaf.form.stalk_radius;
  fields.stalk = distanceTo(stalk, 3 * radius, frame);
  for (float& d : fields.stalk) d = 1 - glm::smoothstep(1.25f * radius, 2.2f * radius, d);
  return fields;
}

}  // namespace verdure
