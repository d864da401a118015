#ifndef VERDURE_PLANT_GLTF_ATTRIBUTES_H_
#define VERDURE_PLANT_GLTF_ATTRIBUTES_H_

#include <functional>

#include "plant/gltf_document.h"

namespace verdure {

/// How a vertex attribute's numbers are stored.
enum class Stored {
  kFloats,
  kShares,   ///< in [0, 1], as normalised bytes
  kIndices,  ///< whole, in [0, 65535], as unsigned shorts
};

/// A vertex attribute that is to be written into a plant's document.
struct VertexAttribute {
  std::string name;    ///< semantic
  int components = 1;  ///< 1 to 4
  Stored stored = Stored::kFloats;
  bool filler = false;     ///< only where the primitive has none of that name
  glm::vec4 unused{0.0f};  ///< of elements that no triangle uses
  /// Whether the part has it; null: all do.
  std::function<bool(std::size_t mesh, const Json& primitive)> wanted = {};
  /// Of vertex `vertex` of Plant::meshes[mesh]. The file holds it in coordinates of its own, where
  /// `plant_from_local` takes from.
  std::function<glm::vec4(std::size_t mesh, std::size_t vertex, const glm::dmat4& plant_from_local)>
      value;
};

/// The plant's document (its own, or a new one for a plant that was grown or came in another
/// format) with these attributes, in their order, and nothing else changed: as savePlant()
/// describes it.
GltfDocument documentWith(const Plant& plant, const std::vector<VertexAttribute>& attributes);

/// Whether the plant's meshes are still those of its document.
bool matchesSource(const Plant& plant);

/// A point and a direction of the plant as the file holds them.
glm::vec4 localPoint(const glm::dmat4& plant_from_local, const glm::vec3& point);
glm::vec4 localNormal(const glm::dmat4& plant_from_local, const glm::vec3& normal);

}  // namespace verdure

#endif  // VERDURE_PLANT_GLTF_ATTRIBUTES_H_
