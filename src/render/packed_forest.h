#ifndef VERDURE_RENDER_PACKED_FOREST_H_
#define VERDURE_RENDER_PACKED_FOREST_H_

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "gpu/resources.h"
#include "motion/motion_tables.h"
#include "shared/forest.h"
#include "verdure/scene.h"

namespace verdure {

/// Trees are drawn as meshes up to where there are so many of them around the eye, whatever their
/// levels ask for; and cast shadows up to where there are so many.
inline constexpr std::uint32_t kMostForestMeshes = 2048, kMostForestCasters = 32768;

/// An impostor as layers of one texture each, [view] with its mips.
struct PackedImpostor {
  int views = 0, texels = 0;
  glm::vec4 sphere{0.0f};
  glm::vec4 crown{0.0f}, radii{1.0f};  ///< as shared::ImpostorKind
  std::vector<std::vector<gpu::MipLevel>> color, normal, light;
};

struct PackedForestKind {
  Bounds box;                     ///< of the plant, its own coordinates
  glm::vec4 sphere{0.0f};         ///< around it at rest
  std::vector<float> grain_m;     ///< of each mesh: width of a leaf
  std::uint32_t first_class = 0;  ///< of its meshes; the impostor's comes behind
  int motion_item = -1;           ///< index into PackedMotions::items
  std::shared_ptr<const MotionTables> tables;
  glm::vec4 leaf{1.0f};     ///< of its leaves, mean, as DrawUniforms::leaf
  PackedImpostor impostor;  ///< views = 0: none
};

/// A forest's trees in clusters of neighbours.
struct PackedForest {
  std::vector<shared::ForestPlace> places;
  std::vector<glm::vec4> clusters;  ///< spheres around the places of each group
  std::vector<PackedForestKind> kinds;
  std::vector<std::uint32_t> draw_classes;  ///< of each draw of a forest, in their order
  std::uint32_t classes = 0;
  std::uint32_t motion_seats = 0;  ///< of each kind
  std::uint32_t most_meshes = kMostForestMeshes;
  float detail = 1.0f;
  float largest_scale = 1.0f;
};

/// Sorts the places and makes clusters. Throws Error: a kind without plant, a place of no kind, a
/// scale that is not above 0, a position that is not finite, a detail out of range.
PackedForest packForest(const Forest& forest);

/// The farthest distance from `eye` within which at most `most` places lie.
float distanceOfNearest(const PackedForest& forest, const glm::vec3& eye, std::uint32_t most);

/// How far each mesh of a kind is drawn, m at scale 1, for pictures with so many pixels a metre at
/// a distance of one.
glm::vec4 levelReach(const PackedForestKind& kind, float pixels_per_m, float detail);

}  // namespace verdure

#endif  // VERDURE_RENDER_PACKED_FOREST_H_
