#include <algorithm>

#include "verdure/wind_files.h"

namespace verdure {

bool standOnOneTrunk(Plant& plant) {
  if (!plant.branches.empty()) return false;
  const Bounds box = bounds(plant);
  const float height = std::max(box.size().y, 1e-3f);
  const glm::vec3 foot(box.center().x, box.min.y, box.center().z);
  Branch trunk;
  // Trees are about a fiftieth of their height thick.
  trunk.points = {{foot, 0.01f * height}, {foot + glm::vec3(0, height, 0), 0.002f * height}};
  plant.branches = {trunk};
  for (Mesh& mesh : plant.meshes)
    if (mesh.kind == PartKind::kWood) mesh.branch_of_vertex.assign(mesh.positions.size(), 0);
  for (Leaf& leaf : plant.leaves) leaf.branch = 0;
  return true;
}

}  // namespace verdure
