#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <map>

#include "base/parallel.h"
#include "base/random.h"
#include "shared/beam.h"
#include "verdure/error.h"
#include "verdure/grow.h"
#include "verdure/motion.h"

namespace verdure {
namespace {

Plant grown(const std::string& species, std::uint32_t seed = 1) {
  GrowOptions options;
  options.species = species;
  options.seed = seed;
  options.texture_size = 32;
  return grow(options);
}

/// Amplitudes that take each tip `share` of the branch's length aside, any way.
std::vector<glm::vec2> storm(const MotionTree& tree, float share, std::uint64_t seed) {
  Random random(seed);
  std::vector<glm::vec2> amplitudes;
  for (const MotionBranch& branch : tree.branches) {
    const float turn = random.uniform(0.0f, glm::two_pi<float>());
    amplitudes.push_back(share * branch.length / shared::beamDeflection(branch.fit, 1.0f) *
                         glm::vec2(std::cos(turn), std::sin(turn)));
  }
  return amplitudes;
}

void bend(const MotionTree& tree, const std::vector<glm::vec2>& amplitudes, Plant& plant) {
  bendPlant(
      tree, [&](std::uint32_t b) { return amplitudes[b]; }, plant);
}

class MotionOf : public testing::TestWithParam<std::string> {
 protected:
  const Plant plant_ = grown(GetParam());
  const MotionTree tree_ = motionTree(plant_);
};
std::vector<std::string> names() {
  std::vector<std::string> list;
  for (const SpeciesInfo& info : speciesList()) list.push_back(info.name);
  return list;
}
INSTANTIATE_TEST_SUITE_P(Species, MotionOf, testing::ValuesIn(names()), [](const auto& species) {
  std::string name = species.param;
  std::erase(name, '-');
  return name;
});

TEST_P(MotionOf, IsATreeOfFourLevels) {
  ASSERT_FALSE(tree_.branches.empty());
  int deepest = 0;
  for (std::uint32_t b = 0; b < tree_.branches.size(); ++b) {
    const MotionBranch& branch = tree_.branches[b];
    deepest = std::max(deepest, branch.level);
    ASSERT_LT(branch.level, kMotionLevels);
    EXPECT_NEAR(glm::dot(glm::cross(branch.t, branch.r), branch.s), 1.0f, 1e-5f);
    if (branch.parent == kNone) {
      EXPECT_EQ(branch.level, 0);
      continue;
    }
    ASSERT_LT(branch.parent, b);
    EXPECT_EQ(branch.level, tree_.branches[branch.parent].level + 1);
    EXPECT_GE(branch.place, 0.0f);
    EXPECT_LE(branch.place, 1.0f);
    EXPECT_LT(branch.wood_m3, tree_.branches[branch.parent].wood_m3);
  }
  EXPECT_GE(deepest, 2);
  ASSERT_EQ(tree_.meshes.size(), plant_.meshes.size());
  for (std::size_t m = 0; m < plant_.meshes.size(); ++m) {
    ASSERT_EQ(tree_.meshes[m].size(), plant_.meshes[m].positions.size());
    for (const VertexMotion& v : tree_.meshes[m]) {
      ASSERT_LT(v.branch, tree_.branches.size());  // nothing of a grown plant stands still
      std::uint32_t b = v.branch;
      for (int level = 0; level < kMotionLevels; ++level) {
        ASSERT_GE(v.places[level], 0.0f);
        ASSERT_LE(v.places[level], 1.0f);
        if (level > tree_.branches[b].level) {
          ASSERT_EQ(v.places[level], 0.0f);
        }
      }
      // On its ancestors it is where its branch is.
      while (tree_.branches[b].parent != kNone) {
        const int level = tree_.branches[b].level;
        ASSERT_EQ(v.places[level - 1], tree_.branches[b].place);
        b = tree_.branches[b].parent;
      }
    }
  }
}

TEST_P(MotionOf, RestsWithoutWindToTheBit) {
  Plant bent = plant_;
  bend(tree_, std::vector<glm::vec2>(tree_.branches.size(), glm::vec2(0.0f)), bent);
  for (std::size_t m = 0; m < bent.meshes.size(); ++m) {
    EXPECT_EQ(bent.meshes[m].positions, plant_.meshes[m].positions);
    EXPECT_EQ(bent.meshes[m].normals, plant_.meshes[m].normals);
  }
}

TEST_P(MotionOf, LeavesKeepTheirShapeAndTheirPlace) {
  Plant bent = plant_;
  bend(tree_, storm(tree_, 0.3f, 1), bent);
  for (std::size_t l = 0; l < plant_.leaves.size(); l += 97) {
    const Leaf& leaf = plant_.leaves[l];
    const Mesh &rest = plant_.meshes[leaf.mesh], &moved = bent.meshes[leaf.mesh];
    const std::uint32_t* first =
        &rest.indices[3 * std::size_t{plant_.leaf_triangles[leaf.first_triangle]}];
    for (std::uint32_t c = 1; c < 3; ++c)
      EXPECT_NEAR(glm::length(moved.positions[first[c]] - moved.positions[first[0]]),
                  glm::length(rest.positions[first[c]] - rest.positions[first[0]]), 2e-5f);
  }
}

/// Positions by the definition: from the trunk on, each branch with its frame carried along by
/// those before it.
glm::vec3 fromTheTrunk(const MotionTree& tree, const std::vector<glm::vec2>& amplitudes,
                       const VertexMotion& motion, glm::vec3 p) {
  std::vector<std::uint32_t> chain;
  for (std::uint32_t b = motion.branch; b != kNone; b = tree.branches[b].parent)
    chain.insert(chain.begin(), b);
  std::vector<shared::BeamFrame> frames;
  for (const std::uint32_t b : chain) {
    const MotionBranch& branch = tree.branches[b];
    frames.push_back({branch.root, branch.length, branch.t, branch.r, branch.s});
  }
  for (std::size_t k = 0; k < chain.size(); ++k) {
    const shared::BeamPose pose =
        shared::poseOfBeam(frames[k], tree.branches[chain[k]].fit,
                           motion.places[static_cast<int>(k)], amplitudes[chain[k]]);
    p = shared::posedPoint(pose, p);
    for (std::size_t next = k + 1; next < chain.size(); ++next) {
      shared::BeamFrame& frame = frames[next];
      frame.root = shared::posedPoint(pose, frame.root);
      frame.t = shared::posedVector(pose, frame.t);
      frame.r = shared::posedVector(pose, frame.r);
      frame.s = shared::posedVector(pose, frame.s);
    }
  }
  return p;
}

TEST_P(MotionOf, BendsAsFromTheTrunkOn) {
  const std::vector<glm::vec2> amplitudes = storm(tree_, 0.2f, 2);
  Plant bent = plant_;
  bend(tree_, amplitudes, bent);
  for (std::size_t m = 0; m < bent.meshes.size(); ++m)
    for (std::size_t v = 0; v < bent.meshes[m].positions.size(); v += 211)
      ASSERT_LT(glm::length(bent.meshes[m].positions[v] -
                            fromTheTrunk(tree_, amplitudes, tree_.meshes[m][v],
                                         plant_.meshes[m].positions[v])),
                5e-5f);
}

TEST_P(MotionOf, ChildrenStayAttached) {
  // The root of each branch, as a point of itself and as one of the stem that carries it.
  float height = 0.0f;
  for (const Mesh& mesh : plant_.meshes)
    for (const glm::vec3& p : mesh.positions) height = std::max(height, p.y);
  for (const std::uint64_t seed : {3u, 4u}) {
    const std::vector<glm::vec2> amplitudes = storm(tree_, 0.25f, seed);
    // The vertices of each wood branch at rest and bent, by branch.
    Plant bent = plant_;
    bend(tree_, amplitudes, bent);
    std::map<std::uint32_t, std::vector<std::pair<std::size_t, std::size_t>>> of_branch;
    for (std::size_t m = 0; m < plant_.meshes.size(); ++m)
      for (std::size_t v = 0; v < plant_.meshes[m].branch_of_vertex.size(); ++v)
        of_branch[plant_.meshes[m].branch_of_vertex[v]].emplace_back(m, v);
    for (std::uint32_t b = 0; b < plant_.branches.size();
         b += 1 + static_cast<std::uint32_t>(plant_.branches.size() / 400)) {
      const Branch& branch = plant_.branches[b];
      if (branch.parent == kNone) continue;
      // The nearest vertices of both before and after.
      const glm::vec3 root = branch.points.front().position;
      const auto nearest = [&](std::uint32_t of) {
        std::pair<std::size_t, std::size_t> found;
        float least = 1e9f;
        for (const auto& [m, v] : of_branch[of]) {
          const float distance = glm::length(plant_.meshes[m].positions[v] - root);
          if (distance < least) {
            least = distance;
            found = {m, v};
          }
        }
        return found;
      };
      const auto [m0, v0] = nearest(b);
      const auto [m1, v1] = nearest(branch.parent);
      const float before =
          glm::length(plant_.meshes[m0].positions[v0] - plant_.meshes[m1].positions[v1]);
      const float after =
          glm::length(bent.meshes[m0].positions[v0] - bent.meshes[m1].positions[v1]);
      // Two points of one stem's surface, whose distance a bend changes by its strain.
      EXPECT_LT(after, before * 1.6f + 1e-4f * height) << "branch " << b;
    }
  }
}

TEST(MotionTree, TurnsWhatLeavesABranch) {
  // A trunk of 4 m and a bough of 2 m that leaves it squarely at its middle.
  Plant plant;
  plant.branches.resize(2);
  plant.branches[0].points = {{{0, 0, 0}, 0.1f}, {{0, 2, 0}, 0.06f}, {{0, 4, 0}, 0.02f}};
  plant.branches[1].parent = 0;
  plant.branches[1].level = 1;
  plant.branches[1].points = {{{0, 2, 0}, 0.03f}, {{2, 2, 0}, 0.01f}};
  Mesh mesh;
  mesh.positions = {{0, 2, 0}, {0, 4, 0}, {0, 2, 0}, {2, 2, 0}};
  mesh.normals.resize(4, glm::vec3(0, 0, 1));
  mesh.branch_of_vertex = {0, 0, 1, 1};
  mesh.indices = {0, 1, 2, 1, 2, 3};
  plant.meshes.push_back(mesh);
  const MotionTree tree = motionTree(plant);
  ASSERT_EQ(tree.branches.size(), 2u);
  EXPECT_FLOAT_EQ(tree.branches[1].place, 0.5f);
  EXPECT_EQ(tree.meshes[0][3].places, glm::vec4(0.5f, 1, 0, 0));
  // Cones: pi h (a^2 + ab + b^2) / 3.
  const float bough = glm::pi<float>() * 2 * (0.0009f + 0.0003f + 0.0001f) / 3;
  EXPECT_NEAR(tree.branches[1].wood_m3, bough, 1e-7f);
  EXPECT_NEAR(
      tree.branches[0].wood_m3,
      bough + glm::pi<float>() * 2 * (0.01f + 0.006f + 0.0036f + 0.0036f + 0.0012f + 0.0004f) / 3,
      1e-7f);

  // The trunk towards +x: the bough keeps its length and its right angle to the trunk.
  const MotionBranch& trunk = tree.branches[0];
  const glm::vec2 amplitude =
      0.8f / shared::beamDeflection(trunk.fit, 1.0f) *
      glm::vec2(glm::dot(trunk.r, glm::vec3(1, 0, 0)), glm::dot(trunk.s, glm::vec3(1, 0, 0)));
  bendPlant(
      tree, [&](std::uint32_t b) { return b == 0 ? amplitude : glm::vec2(0); }, plant);
  const std::vector<glm::vec3>& p = plant.meshes[0].positions;
  EXPECT_LT(glm::length(p[2] - p[0]), 1e-6f);
  EXPECT_NEAR(glm::length(p[3] - p[2]), 2.0f, 1e-5f);
  EXPECT_GT(p[1].x, 0.5f);
  EXPECT_LT(p[1].y, 4.0f);
  EXPECT_LT(p[3].y, p[2].y - 0.1f);  // the bough's tip goes down with the section
  EXPECT_EQ(plant.meshes[0].normals[3], glm::vec3(0, 0, 1));
}

TEST(MotionTree, DoesNotDependOnThreads) {
  const Plant plant = grown("black-oak", 2);
  const auto bent = [&](int threads) {
    setThreadCount(threads);
    const MotionTree tree = motionTree(plant);
    Plant out = plant;
    bend(tree, storm(tree, 0.2f, 5), out);
    setThreadCount(0);
    return out.meshes[1].positions;
  };
  EXPECT_EQ(bent(1), bent(2));
}

TEST(MotionTree, SaysThatBranchesAreUnknown) {
  Plant plant;
  plant.name = "stone";
  try {
    motionTree(plant);
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("stone"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace verdure
