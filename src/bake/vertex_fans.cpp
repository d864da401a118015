#include "bake/vertex_fans.h"

#include <glm/gtc/type_precision.hpp>
#include <numeric>

namespace verdure {

VertexFans::VertexFans(const Mesh& mesh) : fan_of_vertex_(mesh.positions.size()) {
  // A hash table of positions: sorting them takes several times as long.
  std::size_t size = 16;
  while (size < 2 * mesh.positions.size()) size *= 2;
  std::vector<std::uint32_t> table(size, kNone);
  std::vector<std::uint32_t> first_vertex;
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    const glm::vec3 p = mesh.positions[v] + 0.0f;  // -0 is 0
    std::uint64_t key = 1469598103934665603ull;
    for (int a = 0; a < 3; ++a) key = (key ^ glm::floatBitsToUint(p[a])) * 0x9e3779b97f4a7c15ull;
    std::size_t slot = (key >> 20) & (size - 1);
    while (table[slot] != kNone && mesh.positions[first_vertex[table[slot]]] != p)
      slot = (slot + 1) & (size - 1);
    if (table[slot] == kNone) {
      table[slot] = static_cast<std::uint32_t>(first_vertex.size());
      first_vertex.push_back(v);
    }
    fan_of_vertex_[v] = table[slot];
  }
  first_.assign(first_vertex.size() + 1, 0);
  for (const std::uint32_t v : mesh.indices) ++first_[fan_of_vertex_[v] + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  triangles_.resize(mesh.indices.size());
  std::vector<std::uint32_t> filled(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < mesh.indices.size(); ++i)
    triangles_[filled[fan_of_vertex_[mesh.indices[i]]]++] = static_cast<std::uint32_t>(i / 3);
}

}  // namespace verdure
