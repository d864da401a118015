#include "plant/tangents.h"

#include <cmath>

namespace verdure {

std::vector<glm::vec4> vertexTangents(const Mesh& mesh, const std::vector<glm::vec3>& normals) {
  const std::size_t count = mesh.positions.size();
  std::vector<glm::dvec3> along_u(count, glm::dvec3(0.0)), along_v(count, glm::dvec3(0.0));
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const std::uint32_t* corner = &mesh.indices[t];
    const glm::dvec3 p(mesh.positions[corner[0]]);
    const glm::dvec3 e1 = glm::dvec3(mesh.positions[corner[1]]) - p;
    const glm::dvec3 e2 = glm::dvec3(mesh.positions[corner[2]]) - p;
    const glm::dvec2 uv(mesh.uvs[corner[0]]);
    const glm::dvec2 d1 = glm::dvec2(mesh.uvs[corner[1]]) - uv;
    const glm::dvec2 d2 = glm::dvec2(mesh.uvs[corner[2]]) - uv;
    const double determinant = d1.x * d2.y - d2.x * d1.y;
    if (determinant == 0.0 || !std::isfinite(1.0 / determinant)) continue;
    const glm::dvec3 u = (e1 * d2.y - e2 * d1.y) / determinant;
    const glm::dvec3 v = (e2 * d1.x - e1 * d2.x) / determinant;
    for (int c = 0; c < 3; ++c) {
      along_u[corner[c]] += u;
      along_v[corner[c]] += v;
    }
  }
  std::vector<glm::vec4> tangents(count);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 n(normals[i]);
    glm::dvec3 tangent = along_u[i] - n * glm::dot(n, along_u[i]);
    double length = glm::length(tangent);
    if (!(length > 1e-12) || !std::isfinite(length)) {
      // No direction of U: any perpendicular one.
      tangent = glm::cross(n, std::abs(n.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0));
      length = glm::length(tangent);
    }
    tangent /= length;
    // The bitangent, cross(n, t) * w, points up the image (+Y of a normal map), where V decreases.
    const double sign = glm::dot(glm::cross(n, tangent), along_v[i]) > 0.0 ? -1.0 : 1.0;
    tangents[i] = glm::vec4(glm::vec3(tangent), static_cast<float>(sign));
  }
  return tangents;
}

}  // namespace verdure
