#include "base/parallel.h"
#include "motion/motion_tables.h"
#include "shared/beam.h"

namespace verdure {

void bendPlant(const MotionTree& tree,
               const std::function<glm::vec2(std::uint32_t branch)>& amplitude, Plant& plant,
               CrownLight* light) {
  std::vector<glm::vec2> amplitudes;
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b) amplitudes.push_back(amplitude(b));
  for (std::size_t m = 0; m < plant.meshes.size(); ++m) {
    Mesh& mesh = plant.meshes[m];
    glm::vec3* const crown = light != nullptr ? light->meshes[m].normals.data() : nullptr;
    parallelFor(mesh.positions.size(), 1 << 11, [&](std::size_t v) {
      // From the vertex's own branch to the trunk, each in its pose at rest: what a branch carries
      // moves with its section, so the order of frames at rest and of bent frames is the same.
      forEachCarrier(tree, tree.meshes[m][v], [&](std::uint32_t b, float place) {
        const MotionBranch& branch = tree.branches[b];
        const shared::BeamFrame frame{branch.root, branch.length, branch.t, branch.r, branch.s};
        const shared::BeamPose pose = shared::poseOfBeam(frame, branch.fit, place, amplitudes[b]);
        mesh.positions[v] = shared::posedPoint(pose, mesh.positions[v]);
        mesh.normals[v] = shared::posedVector(pose, mesh.normals[v]);
        if (crown != nullptr) crown[v] = shared::posedVector(pose, crown[v]);
      });
    });
  }
}

}  // namespace verdure
