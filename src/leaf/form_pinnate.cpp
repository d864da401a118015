#include <algorithm>

#include "leaf/leaf_form.h"

namespace verdure {

LeafPlan makePinnate(const PinnateForm& form, std::uint64_t seed) {
  Random random(hash(seed ^ 0x6c656166ull));
  LeafPlan leaf;
  leaf.blade_base = form.stalk_mm;
  leaf.stalk_radius = form.stalk_radius_mm;
  BladeShape shape = form.blade;
  shape.length_mm *= random.uniform(0.92f, 1.08f);
  const float wide = random.uniform(0.92f, 1.08f), broadest = random.vary(0.02f);
  for (std::size_t i = 1; i + 1 < shape.margin.size(); ++i) {
    glm::vec2& p = shape.margin[i].at;
    p += glm::vec2((wide - 1) * p.x, broadest * std::max(p.y, 0.0f) * (1 - p.y) * 4);
  }
  shape.margin.front().at = glm::vec2(form.stalk_radius_mm / shape.length_mm, 0);
  const Polyline stalk = stalkSide(leaf);
  const HalfBlade right = makeHalfBlade(shape, 0.0f, random);
  const HalfBlade left = makeHalfBlade(shape, 1.0f, random);
  const glm::vec2 base(0, form.stalk_mm), tip = base + glm::vec2(0, shape.length_mm);
  const auto lifted = [&](Polyline points) {
    for (glm::vec2& p : points) p += base;
    return points;
  };

  leaf.outline = stalk;
  for (const glm::vec2& p : lifted(right.margin)) leaf.outline.push_back(p);
  const Polyline other = mirrored(lifted(left.margin));
  leaf.outline.insert(leaf.outline.end(), other.begin() + 1, other.end());
  const Polyline back = mirrored(stalk);
  leaf.outline.insert(leaf.outline.end(), back.begin(), back.end());

  leaf.guides.push_back({{{0, 0}, base, 0.5f * (base + tip), tip}, 1, -1});
  for (std::size_t k = std::max(right.secondaries.size(), left.secondaries.size()); k-- > 0;) {
    // From the tip on: loops end at the vein above.
    if (k < right.secondaries.size()) leaf.guides.push_back({lifted(right.secondaries[k]), 2, 0});
    if (k < left.secondaries.size()) {
      Polyline points = lifted(left.secondaries[k]);
      for (glm::vec2& p : points) p.x = -p.x;
      leaf.guides.push_back({points, 2, 0});
    }
  }
  // Bending needs points in between.
  leaf.guides.front().points = splineThrough({{{0, 0}, true}, {base, true}, {tip, true}}, 1.0f);
  bendForm(leaf, form.bend, random);
  return leaf;
}

}  // namespace verdure
