#ifndef VERDURE_PLANT_TANGENTS_H_
#define VERDURE_PLANT_TANGENTS_H_

#include <glm/glm.hpp>
#include <vector>

#include "verdure/plant.h"

namespace verdure {

/// Unit tangents along +U with the sign of the bitangent in w (Lengyel 2001, "Computing Tangent
/// Space Basis Vectors for an Arbitrary Mesh"), perpendicular to `normals`. The mesh has UVs.
std::vector<glm::vec4> vertexTangents(const Mesh& mesh, const std::vector<glm::vec3>& normals);

}  // namespace verdure

#endif  // VERDURE_PLANT_TANGENTS_H_
