#include "plant/normals.h"

#include <algorithm>
#include <cmath>

namespace verdure {

std::vector<glm::vec3> angleWeightedNormals(const std::vector<glm::vec3>& positions,
                                            const std::vector<std::uint32_t>& indices) {
  std::vector<glm::dvec3> sums(positions.size(), glm::dvec3(0.0));
  for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
    const glm::dvec3 corner[3] = {glm::dvec3(positions[indices[t]]),
                                  glm::dvec3(positions[indices[t + 1]]),
                                  glm::dvec3(positions[indices[t + 2]])};
    const glm::dvec3 area = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    const double length = glm::length(area);
    if (!(length > 0.0)) continue;
    for (int c = 0; c < 3; ++c) {
      const glm::dvec3 a = corner[(c + 1) % 3] - corner[c];
      const glm::dvec3 b = corner[(c + 2) % 3] - corner[c];
      const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
      sums[indices[t + static_cast<std::size_t>(c)]] += area * (angle / length);
    }
  }
  std::vector<glm::vec3> normals(positions.size());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double length = glm::length(sums[i]);
    normals[i] = length > 1e-12 ? glm::vec3(sums[i] / length) : glm::vec3(0.0f, 1.0f, 0.0f);
  }
  return normals;
}

}  // namespace verdure
