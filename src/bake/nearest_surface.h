#ifndef VERDURE_BAKE_NEAREST_SURFACE_H_
#define VERDURE_BAKE_NEAREST_SURFACE_H_

#include <memory>

#include "verdure/field.h"

namespace verdure {

/// Finds the vertex or point of a surface that is nearest to a point.
class NearestSurface {
 public:
  /// `surface` must outlive this; every vertex finite and corner of a triangle with an area.
  explicit NearestSurface(const Surface& surface);
  ~NearestSurface();

  /// The nearest vertex, the one with the lowest index when several are. `hint` is any vertex, best
  /// the answer for a point close by: it shortens the search and does not change the result.
  std::uint32_t vertex(const glm::vec3& point, std::uint32_t hint = 0) const;

  struct Point {
    glm::vec3 position{0.0f};
    glm::vec3 normal{0.0f};    ///< interpolated from the triangle's vertices, unit
    std::uint32_t vertex = 0;  ///< the nearest vertex
  };
  /// The point of the triangles around the nearest vertex that is nearest or, where it lies on
  /// their rim, walks on from there while that comes nearer: on marching cubes' meshes
  /// the nearest point to within a twentieth of a cell (another sheet may be nearer by so little).
  Point point(const glm::vec3& from, std::uint32_t hint = 0) const;

  /// Every edge has exactly two triangles, with opposite directions.
  bool watertight() const;
  std::size_t components() const;

 private:
  struct Tree;
  const Surface& surface_;
  std::vector<std::uint32_t> first_;      // per vertex, into triangles_
  std::vector<std::uint32_t> triangles_;  // of each vertex
  std::unique_ptr<Tree> tree_;
};

}  // namespace verdure

#endif  // VERDURE_BAKE_NEAREST_SURFACE_H_
