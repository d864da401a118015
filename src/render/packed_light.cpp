#include "render/packed_light.h"

#include "base/parallel.h"
#include "verdure/error.h"

namespace verdure {

PackedLight packLight(const Scene& scene) {
  PackedLight packed;
  for (const SceneItem& item : scene.items)
    for (std::size_t m = 0; m < item.plant->meshes.size(); ++m) {
      const Mesh& mesh = item.plant->meshes[m];
      const std::size_t count = mesh.positions.size(), base = packed.leaf_normals.size();
      if (item.light == nullptr || item.light->meshes.size() != item.plant->meshes.size() ||
          item.light->meshes[m].normals.size() != count ||
          item.light->meshes[m].ambient.size() != count || mesh.normals.size() != count)
        throw Error(item.plant->name, "its baked light belongs to another plant",
                    "bake this plant");
      const MeshLight& light = item.light->meshes[m];
      packed.leaf_normals.resize(base + count);
      packed.crown_normals.resize(base + count);
      parallelFor(count, 4096, [&](std::size_t v) {
        const glm::vec2 seen = light.visibility.empty() ? glm::vec2(1.0f) : light.visibility[v];
        packed.leaf_normals[base + v] = packNormal(mesh.normals[v], light.ambient[v], seen);
        packed.crown_normals[base + v] = packNormal(light.normals[v], light.ambient[v], seen);
      });
    }
  return packed;
}

}  // namespace verdure
