#ifndef VERDURE_PLANT_WELD_H_
#define VERDURE_PLANT_WELD_H_

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <numeric>
#include <vector>

namespace verdure {

/// Union-find; the representative of a set is its lowest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Joins all vertices within 1e-6 of the points' size (the diagonal of their bounds) of each other.
void weld(const std::vector<glm::vec3>& positions, DisjointSets& sets);

}  // namespace verdure

#endif  // VERDURE_PLANT_WELD_H_
