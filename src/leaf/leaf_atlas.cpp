#include "leaf/leaf_atlas.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "leaf/grown_leaf.h"

namespace verdure {
namespace {

/// How far a leaf reaches to the left and to the right of its foot, and up, mm.
struct Bounds {
  float left = std::numeric_limits<float>::max(), right = std::numeric_limits<float>::lowest();
  float top = 0;
};

Bounds boundsOf(const Polyline& points) {
  Bounds b;
  for (const glm::vec2& p : points) {
    b.left = std::min(b.left, p.x);
    b.right = std::max(b.right, p.x);
    b.top = std::max(b.top, p.y);
  }
  return b;
}

/// The colour that a leaf reflects most of: light of that one goes through it.
glm::vec3 dominantColor(const LeafSet& set) {
  glm::vec3 sum(0.0f);
  for (std::size_t i = 0; i < set.texelCount(); ++i) sum += set.opacity[i] * set.front.albedo[i];
  const int most = sum.x > sum.y ? (sum.x > sum.z ? 0 : 2) : (sum.y > sum.z ? 1 : 2);
  glm::vec3 color(0.0f);
  color[most] = 1.0f;
  return color;
}

}  // namespace

LeafAtlas growLeafAtlas(const std::string& name, int size, float age) {
  const LeafSpecies& species = findLeafSpecies(name);
  constexpr std::uint32_t kFirstSeed = 1;
  const std::vector<GrownLeaf> leaves = growForms(species, kFirstSeed, kLeafVariants);
  std::vector<Polyline> silhouettes;
  std::vector<Bounds> bounds;
  const float extent = frameExtent(leaves);
  float widest = 0;
  LeafAtlas atlas;
  for (const GrownLeaf& leaf : leaves) {
    silhouettes.push_back(silhouetteOf(leaf));
    const Bounds& b = bounds.emplace_back(boundsOf(silhouettes.back()));
    widest = std::max(widest, b.right - b.left);
    atlas.natural_width += (b.right - b.left) / b.top / kLeafVariants;
  }

  // Cells leave room for the corners of a polygon around the leaf.
  const float share = 1.1f * widest / extent;
  const int part = share <= 0.25f ? 4 : share <= 0.5f ? 2 : 1;
  const int height = part == 4 ? size : size / 2, width = height / part;
  atlas.columns = size / width;
  atlas.rows = kLeafVariants / atlas.columns;
  atlas.cell_width = 1.0f / static_cast<float>(part);

  std::vector<LeafSet> sets =
      paintLeaves(leaves, species, {height, extent}, {name, kFirstSeed, height, age});
  for (std::size_t k = 0; k < sets.size(); ++k) {
    // The cell has the leaf in its middle; the foot is in the middle of what was painted.
    const float middle = 0.5f + 0.5f * (bounds[k].left + bounds[k].right) / extent;
    const int left =
        std::clamp(static_cast<int>(std::lround(middle * static_cast<float>(height))) - width / 2,
                   0, height - width);
    if (part > 1) sets[k] = cropLeaf(sets[k], left, 0, width, height);
    LeafAtlas::Variant& variant = atlas.variants.emplace_back();
    variant.foot = 0.5f - static_cast<float>(left) / static_cast<float>(height);
    variant.points = silhouettes[k];
    for (glm::vec2& p : variant.points) p /= extent;
  }
  atlas.set = tileLeaves(sets, atlas.columns);
  LeafBakeOptions bake;
  bake.wavelength = dominantColor(atlas.set);
  atlas.light = bakeLeafTranslucency(atlas.set, bake);
  return atlas;
}

}  // namespace verdure
