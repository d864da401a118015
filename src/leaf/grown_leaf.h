#ifndef VERDURE_LEAF_GROWN_LEAF_H_
#define VERDURE_LEAF_GROWN_LEAF_H_

#include <cstdint>
#include <vector>

#include "leaf/leaf_raster.h"
#include "leaf/leaf_species.h"

// What the maps of a blade are made from, texel by texel, and the steps that make them.

namespace verdure {

/// A round thing seen from the front: a polyline with a radius at each point, mm.
struct Rod {
  enum class Part { kNeedle, kTwig };
  Polyline points;
  std::vector<float> radii;
  float height = 0;  ///< towards the viewer, [-1, 1]: which rod hides which
  float shade = 1, old = 0;
  Part part = Part::kNeedle;
  float length = 0;
};
/// A shoot's axis and needles, from the nearest to the farthest.
std::vector<Rod> makeRods(std::uint32_t seed);

/// A grown leaf before it is painted: a blade or a shoot.
struct GrownLeaf {
  LeafPlan form;
  std::vector<VeinNode> veins;
  std::vector<Rod> rods;  ///< of a shoot; empty: a blade
};
GrownLeaf growForm(const LeafSpecies& species, std::uint32_t seed);
/// Those of the seeds seed, seed + 1 ...
std::vector<GrownLeaf> growForms(const LeafSpecies& species, std::uint32_t seed, int count);

/// Points, mm, whose convex hull holds the leaf; a blade's are its outline.
Polyline silhouetteOf(const GrownLeaf& leaf);
/// LeafFrame::extent_mm of the smallest frame that shows each of the leaves.
float frameExtent(const std::vector<GrownLeaf>& leaves);

struct BladeFields {
  LeafFrame frame;
  std::vector<float> coverage;  ///< by the outline, [0, 1]
  std::vector<float> edge;      ///< mm to the outline, positive inside, at most edge_reach
  Ridges ridge;                 ///< veins
  std::vector<float> vein;      ///< mm to the nearest vein
  std::vector<float> major;     ///< mm to the nearest primary or secondary vein
  std::vector<float> stalk;     ///< 1 on the stalk, 0 on the blade
  float edge_reach = 0;
  float stalk_radius = 0;  ///< mm
};
BladeFields rasterise(const GrownLeaf& leaf, const LeafSpecies& species, const LeafFrame& frame);

/// What time does to a leaf, texel by texel.
struct Blemishes {
  std::vector<float> hole;   ///< mm to the nearest hole or bite, negative inside
  std::vector<float> brown;  ///< dead tissue, [0, 1]
};
Blemishes blemish(const GrownLeaf& leaf, const BladeFields& fields, const LeafSpecies& species,
                  const LeafGrowOptions& options);

/// Fills relief, thickness and normals.
void shapeRelief(const BladeFields& fields, const LeafSpecies& species, std::uint32_t seed,
                 LeafSet& set);

/// Fills albedo and translucency of both sides.
void paintLeaf(const BladeFields& fields, const Blemishes& blemishes, const LeafSpecies& species,
               const LeafGrowOptions& options, LeafSet& set);

/// Normals of a side from the slopes of its relief (central differences, one-sided at the borders).
void setNormals(LeafSide& side, int size, float mm_per_texel);

/// 1 where there is any leaf: whose colours are painted.
std::vector<std::uint8_t> insideOf(const LeafSet& set);

/// A shoot with needles: all maps.
LeafSet paintShoot(const GrownLeaf& leaf, const LeafSpecies& species, const LeafFrame& frame,
                   const LeafGrowOptions& options);

/// The maps of leaves that growForms() made of options.seed.
std::vector<LeafSet> paintLeaves(const std::vector<GrownLeaf>& leaves, const LeafSpecies& species,
                                 const LeafFrame& frame, const LeafGrowOptions& options);

}  // namespace verdure

#endif  // VERDURE_LEAF_GROWN_LEAF_H_
