#include "verdure/plant.h"

#include <limits>

namespace verdure {
namespace {

template <class Accept>
Bounds boundsWhere(const Plant& plant, const Accept& accept) {
  Bounds box{glm::vec3(std::numeric_limits<float>::max()),
             glm::vec3(std::numeric_limits<float>::lowest())};
  bool any = false;
  for (const Mesh& mesh : plant.meshes) {
    if (!accept(mesh)) continue;
    for (const glm::vec3& p : mesh.positions) {
      box.min = glm::min(box.min, p);
      box.max = glm::max(box.max, p);
      any = true;
    }
  }
  return any ? box : Bounds{};
}

template <class T>
std::size_t bytesOf(const std::vector<T>& v) {
  return v.size() * sizeof(T);
}

}  // namespace

Bounds bounds(const Plant& plant) {
  return boundsWhere(plant, [](const Mesh&) { return true; });
}

Bounds bounds(const Plant& plant, PartKind kind) {
  return boundsWhere(plant, [kind](const Mesh& mesh) { return mesh.kind == kind; });
}

std::size_t vertexCount(const Plant& plant) {
  std::size_t count = 0;
  for (const Mesh& mesh : plant.meshes) count += mesh.positions.size();
  return count;
}

std::size_t triangleCount(const Plant& plant) {
  std::size_t count = 0;
  for (const Mesh& mesh : plant.meshes) count += mesh.triangleCount();
  return count;
}

std::size_t memoryBytes(const Plant& plant) {
  std::size_t bytes = bytesOf(plant.leaves) + bytesOf(plant.leaf_triangles);
  for (const Mesh& mesh : plant.meshes)
    bytes += bytesOf(mesh.positions) + bytesOf(mesh.normals) + bytesOf(mesh.uvs) +
             bytesOf(mesh.indices) + bytesOf(mesh.ambient) + bytesOf(mesh.visibility) +
             bytesOf(mesh.branch_of_vertex);
  for (const Texture& texture : plant.textures) bytes += bytesOf(texture.image.rgba);
  for (const Branch& branch : plant.branches) bytes += sizeof(Branch) + bytesOf(branch.points);
  return bytes;
}

}  // namespace verdure
