#ifndef VERDURE_TESTS_SURFACE_CHECKS_H_
#define VERDURE_TESTS_SURFACE_CHECKS_H_

#include <map>
#include <set>

#include "verdure/field.h"

namespace verdure {

struct MeshTopology {
  std::size_t open_edges = 0;             ///< a directed edge without its opposite
  std::size_t non_manifold_edges = 0;     ///< a directed edge used twice
  std::size_t non_manifold_vertices = 0;  ///< whose triangles form more than one fan
  long euler = 0;
};

inline MeshTopology meshTopology(const Surface& surface) {
  MeshTopology result;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> edges;
  // Around each vertex, the opposite edges must link into one ring.
  std::map<std::uint32_t, std::map<std::uint32_t, std::uint32_t>> rings;
  for (std::size_t i = 0; i < surface.indices.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = surface.indices[i + k], b = surface.indices[i + (k + 1) % 3],
                          c = surface.indices[i + (k + 2) % 3];
      if (edges[{a, b}]++ > 0) ++result.non_manifold_edges;
      rings[a][b] = c;
    }
  for (const auto& [edge, count] : edges)
    if (edges.find({edge.second, edge.first}) == edges.end()) ++result.open_edges;
  for (const auto& [vertex, ring] : rings) {
    std::size_t length = 0;
    std::uint32_t at = ring.begin()->first;
    do {
      const auto next = ring.find(at);
      if (next == ring.end()) break;
      at = next->second;
      ++length;
    } while (at != ring.begin()->first && length <= ring.size());
    if (length != ring.size()) ++result.non_manifold_vertices;
  }
  result.euler = static_cast<long>(rings.size()) - static_cast<long>(edges.size() / 2) +
                 static_cast<long>(surface.indices.size() / 3);
  return result;
}

inline double signedVolume(const Surface& surface) {
  double volume = 0;
  for (std::size_t i = 0; i < surface.indices.size(); i += 3) {
    const glm::dvec3 a(surface.positions[surface.indices[i]]),
        b(surface.positions[surface.indices[i + 1]]), c(surface.positions[surface.indices[i + 2]]);
    volume += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  return volume;
}

}  // namespace verdure

#endif  // VERDURE_TESTS_SURFACE_CHECKS_H_
