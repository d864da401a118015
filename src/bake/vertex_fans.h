#ifndef VERDURE_BAKE_VERTEX_FANS_H_
#define VERDURE_BAKE_VERTEX_FANS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "verdure/plant.h"

namespace verdure {

/// The triangles that meet at each vertex of a mesh; vertices at one position share a fan.
class VertexFans {
 public:
  VertexFans() = default;
  explicit VertexFans(const Mesh& mesh);

  /// Number of a vertex's fan.
  std::uint32_t of(std::size_t vertex) const { return fan_of_vertex_[vertex]; }
  /// Where a fan begins in triangles(); that of the number behind the last fan is the end.
  std::uint32_t first(std::uint32_t fan) const { return first_[fan]; }
  /// Of all fans one after the other: indices into the mesh's triangles.
  std::span<const std::uint32_t> triangles() const { return triangles_; }
  std::span<const std::uint32_t> at(std::size_t vertex) const {
    const std::uint32_t fan = of(vertex);
    return triangles().subspan(first_[fan], first_[fan + 1] - first_[fan]);
  }

 private:
  std::vector<std::uint32_t> fan_of_vertex_, first_, triangles_;
};

}  // namespace verdure

#endif  // VERDURE_BAKE_VERTEX_FANS_H_
