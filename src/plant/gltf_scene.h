#ifndef VERDURE_PLANT_GLTF_SCENE_H_
#define VERDURE_PLANT_GLTF_SCENE_H_

#include <glm/glm.hpp>

#include "plant/gltf_document.h"

namespace verdure {

/// What a glTF file shows: its default scene (else the first, else all nodes).
struct GltfScene {
  std::vector<glm::dmat4> world_from_node;  ///< of every node of the file
  std::vector<std::size_t> mesh_nodes;      ///< nodes of the scene that have a mesh, in order
};

/// Throws Error for node cycles, nodes with two parents and broken transforms.
GltfScene readScene(const GltfDocument& document);

/// How the vertices of a primitive get into the world. Without a skin: one transform per instance
/// (one in all without EXT_mesh_gpu_instancing). With a skin: one per vertex of the accessors, the
/// weighted sum of its joints at the rest pose.
struct NodePlacement {
  std::vector<glm::dmat4> world_from_local;
  bool skinned = false;
  std::size_t instances() const { return skinned ? 1 : world_from_local.size(); }
  const glm::dmat4& transform(std::size_t instance, std::size_t vertex) const {
    return world_from_local[skinned ? vertex : instance];
  }
};

NodePlacement placement(const GltfDocument& document, const GltfScene& scene, std::size_t node,
                        const Json& primitive, const std::string& who);

/// The instances of a node with EXT_mesh_gpu_instancing, relative to the node; empty without.
struct Instance {
  glm::dvec3 translation{0.0};
  glm::dvec4 rotation{0.0, 0.0, 0.0, 1.0};  ///< x, y, z, w
  glm::dvec3 scale{1.0};
};
std::vector<Instance> readInstances(const GltfDocument& document, std::size_t node);

/// The matrix that takes normals where `m` takes points: inverse transpose up to a positive factor,
/// also for singular matrices (the cofactors).
glm::dmat3 normalTransform(const glm::dmat4& m);

}  // namespace verdure

#endif  // VERDURE_PLANT_GLTF_SCENE_H_
