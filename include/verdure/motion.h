#ifndef VERDURE_MOTION_H_
#define VERDURE_MOTION_H_

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "verdure/plant.h"

/// Plants in wind: Habel, "Real-time Rendering and Animation of Vegetation", dissertation, TU Wien
/// 2009, chapter 4.
namespace verdure {

inline constexpr int kMotionLevels = 4;

/// A branch as a beam, at rest: metres.
struct MotionBranch {
  std::uint32_t parent = kNone;  ///< index into MotionTree::branches, below its own; kNone: ground
  int level = 0;                 ///< 0 to kMotionLevels - 1: its parent's + 1
  float place = 0.0f;            ///< where it leaves its parent, [0, 1] of that one's length
  glm::vec3 root{0.0f};
  glm::vec3 t{0, 1, 0}, r{1, 0, 0}, s{0, 0, 1};  ///< axis from root to tip, two directions across
  float length = 0.0f;                           ///< from root to tip, straight
  float root_radius = 0.0f, tip_radius = 0.0f;
  glm::vec2 fit{0.0f};   ///< c_2, c_4 of (4.8)
  float wood_m3 = 0.0f;  ///< of the branch and all that it carries (4.17, without the density)
  float leaf_m2 = 0.0f;  ///< one side of all leaves that it carries
};

/// What each vertex of a mesh hangs on.
struct VertexMotion {
  std::uint32_t branch = kNone;  ///< kNone: it stands still
  /// Where it is along each of its branches, by their levels, [0, 1]; its own last, 0 beyond.
  glm::vec4 places{0.0f};
  std::uint32_t leaf = kNone;  ///< index into Plant::leaves, of foliage
};

struct MotionTree {
  std::vector<MotionBranch> branches;
  std::vector<std::vector<VertexMotion>> meshes;  ///< of each mesh of the plant, vertex by vertex
};

/// The tree of beams of a plant whose branches are known (Plant::branches, branch_of_vertex and
/// Leaf::branch: of grown plants, or by findBranches()). Trunks that part near the foot (below 0.15
/// of the first) stand side by side; what would be deeper than kMotionLevels is part of the branch
/// that carries it. Leaves hang on their stalk's place as a whole. Throws Error for a plant
/// without branches.
MotionTree motionTree(const Plant& plant);

/// The plant's positions and normals, and the light's if there is one, with its branches bent:
/// `amplitude` gives each branch's along r and s, metres for each 1 of (4.8). With 0 everywhere the
/// plant itself, to the bit.
void bendPlant(const MotionTree& tree,
               const std::function<glm::vec2(std::uint32_t branch)>& amplitude, Plant& plant,
               CrownLight* light = nullptr);

/// Wind over a scene. Deflections grow as the speed's square, up to tips that go 0.45 of their
/// branch's length aside; at 0 m/s a plant is at rest, to the bit.
struct Wind {
  float speed = 0.0f;  ///< mean, m/s, [0, 60]
  float from = 0.0f;   ///< azimuth that it comes from, radians, as directionOf()'s
  float gusts = 0.4f;  ///< by which share of itself the speed rises and falls, [0, 1]
  /// How far the wind has come, m: the integral of its velocity, for wind that changes with time.
  /// Unset: velocity times seconds.
  std::optional<glm::dvec3> way = {};
};
/// Throws Error unless all numbers are in their ranges.
void checkWind(const Wind& wind);

struct MotionOptions {
  std::uint64_t seed = 1;
  float flexibility = 1.0f;  ///< times all deflections, above 0
  /// By level, [0.02, 4]: see BranchOscillator::damping_ratio in motion/motion_texture.h.
  std::array<float, kMotionLevels> damping_ratio{0.3f, 0.2f, 0.2f, 0.2f};
  float spectrum_speed = 5.0f;  ///< v_m of (4.15), m/s, above 0: the spectrum's, not the strength's
  bool thesis_textures = false;  ///< radial ones, whose resonance is low and broad: for comparison
  int texture_width = 2048, texture_height = 1024;  ///< of each texture, see MotionTextureOptions
};

/// How a branch answers wind; `mean` and `swing` for 1 m/s, growing as the speed's square, in
/// lengths of the branch.
struct BranchMotion {
  float frequency_hz = 0.0f;   ///< (4.20), at most 15
  float damping_ratio = 0.0f;  ///< of its level
  float mass_kg = 0.0f;        ///< (4.17): wood and leaves of the branch and all that it carries
  float mean = 0.0f;           ///< the tip's deflection downwind, by the drag of what it carries
  float swing = 0.0f;          ///< root mean square of the tip's swinging along r, and along s
};

/// A leaf as a plate that bends at its stalk and twists about its axis.
struct LeafMotion {
  glm::vec3 stalk{0.0f};
  glm::vec3 axis{0, 1, 0}, normal{0, 0, 1};  ///< unit, across each other
  float reach = 0.0f;                        ///< its farthest vertex from the stalk, m
  std::uint32_t branch = kNone;              ///< index into MotionTree::branches
  float place = 0.0f;                        ///< of the stalk on that, [0, 1]
};

struct MotionTables;

/// All that a plant needs to move, the same for all places where it stands.
struct PlantMotion {
  MotionTree tree;
  std::vector<BranchMotion> branches;          ///< of each of tree.branches
  std::vector<LeafMotion> leaves;              ///< of each of Plant::leaves
  std::shared_ptr<const MotionTables> tables;  ///< the same for the GPU, and textures
};

/// Throws Error for a plant without branches, numbers out of range. Deterministic for any number of
/// threads. Takes about a second: four textures are made.
PlantMotion plantMotion(const Plant& plant, const MotionOptions& options = {});

/// Where a plant stands, and its number among all places of the scene, items in their order: no two
/// move alike.
struct MotionPlace {
  glm::mat4 world_from_plant{1.0f};  ///< may turn, mirror and scale evenly
  std::uint32_t instance = 0;
};

/// Amplitudes along r and s that bendPlant() takes, m, of each branch.
std::vector<glm::vec2> branchAmplitudes(const PlantMotion& motion, const Wind& wind, double seconds,
                                        const MotionPlace& place = {});
/// Tangents of half the angles by which each leaf is bent towards its normal and twisted about its
/// axis (from its normal towards cross(axis, normal)).
std::vector<glm::vec2> leafTurns(const PlantMotion& motion, const Wind& wind, double seconds,
                                 const MotionPlace& place = {});

/// The plant at a moment, in its own coordinates at rest: positions and normals of all meshes, and
/// those of `light` if it is given. A function of time alone: the same seconds give the same bits.
/// Any finite time; throws Error otherwise.
void movePlant(const PlantMotion& motion, const Wind& wind, double seconds,
               const MotionPlace& place, Plant& plant, CrownLight* light = nullptr);

/// Holds every vertex of the plant at any time in this wind or a weaker one, in the plant's
/// coordinates.
Bounds movedBounds(const PlantMotion& motion, const Wind& wind);

}  // namespace verdure

#endif  // VERDURE_MOTION_H_
