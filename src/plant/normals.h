#ifndef VERDURE_PLANT_NORMALS_H_
#define VERDURE_PLANT_NORMALS_H_

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace verdure {

/// Unit vertex normals from the triangles around each vertex, weighted by their angles (Thürmer and
/// Wüthrich 1998, "Computing Vertex Normals from Polygonal Facets"): smooth where triangles share
/// vertices, flat where they do not. Vertices of no triangle, or of empty ones alone, get +Y.
std::vector<glm::vec3> angleWeightedNormals(const std::vector<glm::vec3>& positions,
                                            const std::vector<std::uint32_t>& indices);

}  // namespace verdure

#endif  // VERDURE_PLANT_NORMALS_H_
