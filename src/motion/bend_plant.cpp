#include "base/parallel.h"
#include "shared/beam.h"
#include "verdure/motion.h"

namespace verdure {

void bendPlant(const MotionTree& tree,
               const std::function<glm::vec2(std::uint32_t branch)>& amplitude, Plant& plant) {
  std::vector<glm::vec2> amplitudes;
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b) amplitudes.push_back(amplitude(b));
  for (std::size_t m = 0; m < plant.meshes.size(); ++m) {
    Mesh& mesh = plant.meshes[m];
    parallelFor(mesh.positions.size(), 1 << 11, [&](std::size_t v) {
      const VertexMotion& motion = tree.meshes[m][v];
      // From the vertex's own branch to the trunk, each in its pose at rest: what a branch carries
      // moves with its section, so the order of frames at rest and of bent frames is the same.
      for (std::uint32_t b = motion.branch; b != kNone; b = tree.branches[b].parent) {
        const MotionBranch& branch = tree.branches[b];
        const shared::BeamFrame frame{branch.root, branch.length, branch.t, branch.r, branch.s};
        const shared::BeamPose pose =
            shared::poseOfBeam(frame, branch.fit, motion.places[branch.level], amplitudes[b]);
        mesh.positions[v] = shared::posedPoint(pose, mesh.positions[v]);
        mesh.normals[v] = shared::posedVector(pose, mesh.normals[v]);
      }
    });
  }
}

}  // namespace verdure
