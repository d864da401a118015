#ifndef VERDURE_BAKE_SURFEL_TREE_H_
#define VERDURE_BAKE_SURFEL_TREE_H_

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/depth_kernel.h"
#include "verdure/optical_depth.h"

namespace verdure {

/// Numbers of the positions, halved again and again at the median of their longest side, down to
/// pieces of at most `piece`; neighbours in space are neighbours in order. The same for any number
/// of threads.
std::vector<std::uint32_t> sortedByMedians(std::span<const glm::vec3> positions, std::size_t piece);

/// A balanced tree over surfels, halved at the median of the longest side. Coordinates and areas
/// are relative to its own origin and scale, so that nothing overflows whatever the unit.
class SurfelTree {
 public:
  SurfelTree() = default;
  explicit SurfelTree(std::span<const Surfel> surfels);

  std::size_t count() const { return count_; }
  glm::vec3 toTree(const glm::vec3& p) const { return (p - origin_) * scale_; }
  float scale() const { return scale_; }

  /// The terms that stand for all surfels, seen from the box [low, high] (of the tree's own
  /// coordinates): nodes whose radius is below `opening` times their distance, single surfels of
  /// the rest.
  void termsFor(const glm::vec3& low, const glm::vec3& high, float opening,
                DepthTerms& terms) const;

 private:
  struct Node {
    glm::vec3 center{0.0f};  ///< area-weighted
    float radius = 0.0f;     ///< no part of a surfel is farther from the center
    float half_area = 0.0f, softening = 0.0f;
    std::uint32_t first = 0, last = 0;  ///< surfels
  };
  void makeNode(std::size_t node, std::size_t first, std::size_t last);

  glm::vec3 origin_{0.0f};
  float scale_ = 1.0f;
  std::size_t count_ = 0, levels_ = 0;
  std::vector<Node> nodes_;  ///< node n has children 2 n + 1 and 2 n + 2
  std::vector<glm::vec3> positions_;
  std::vector<float> half_areas_, extents_;
};

}  // namespace verdure

#endif  // VERDURE_BAKE_SURFEL_TREE_H_
