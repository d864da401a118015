#ifndef VERDURE_LEVELS_H_
#define VERDURE_LEVELS_H_

#include <glm/glm.hpp>
#include <vector>

#include "verdure/plant.h"

/// Coarser versions of a plant, for where it is small: fewer, larger leaves and simpler wood, and
/// pictures of it from around.
namespace verdure {

/// A plant with fewer leaves and triangles.
struct PlantLevel {
  std::vector<Mesh> meshes;  ///< as many as the plant has, in its order; some may be empty
  /// Of each mesh, of each vertex: the plant's vertex that it comes from; what that has (light,
  /// branch, leaf) it has, too.
  std::vector<std::vector<std::uint32_t>> sources;
  float leaf_share = 1.0f;   ///< of the plant's leaves
  float leaf_growth = 1.0f;  ///< how much longer each is
};

/// The light of the plant on a coarser version of it.
CrownLight lightOf(const PlantLevel& level, const CrownLight& light);

struct SimplifyOptions {
  float leaf_share = 0.25f;  ///< of the leaves that stay, (0, 1]
  /// How much longer they become; unset (0): so that the area of all stays.
  float leaf_growth = 0.0f;
  float wood_share = 0.25f;   ///< of the wood's triangles, (0, 1]
  float wood_error = 0.002f;  ///< how far it may move, in the plant's height, above 0
};

/// Leaves go in the same random order for all shares, so that a coarse level's are among those of
/// a finer one; each that stays grows about its middle (Cook, Halstead, Planck, Ryu, "Stochastic
/// Simplification of Aggregate Detail", SIGGRAPH 2007). Wood loses triangles to meshoptimizer's
/// edge collapses, and where these cannot thin it enough, whole stems: the thinnest first. The
/// plant's leaves must have been found (findLeaves). Deterministic. Throws Error for options out of
/// range.
PlantLevel simplifyPlant(const Plant& plant, const SimplifyOptions& options = {});

/// A plant seen from the corners of an octahedron's upper half, unfolded to a square of
/// `views` x `views` pictures (shared/octahedron.h), each `texels` wide, without perspective and as
/// large as a sphere around the plant. Rows first, the whole square as one picture. All values are
/// means over the texel, where nothing is 0: those of what is seen there are in proportion to
/// the covered share.
struct Impostor {
  int views = 0, texels = 0;
  glm::vec3 center{0.0f};  ///< of the sphere, in the plant's coordinates
  float radius = 0.0f;     ///< m
  /// An ellipsoid around the foliage, in the plant's coordinates, and how much of a straight line's
  /// light its leaves take away: of a way of s, in radii, exp(-extinction s) is left.
  glm::vec3 crown_center{0.0f}, crown_radii{1.0f};
  float extinction = 0.0f;
  Image color;  ///< base colour, sRGB; alpha: covered share
  /// 128 + 127 times the normal of leaves and wood on the seen side: short where they differ.
  /// Alpha: depth, 255 at the sphere's front to 0 at its back.
  Image normal;
  /// Red: ambient coefficient; green: share of foliage; blue: light through leaves, half of the
  /// green that passes over the green that their colour lets guess (shared/leaf.h). Alpha 255.
  Image light;
};

struct ImpostorOptions {
  int views = 8;     ///< a side, [2, 32]
  int texels = 128;  ///< of a picture, [16, 512]
  int samples = 2;   ///< rays a texel along each axis, [1, 16]
};

/// Throws Error for a plant without triangles and options out of range. The same bits for any
/// number of threads.
Impostor bakeImpostor(const Plant& plant, const CrownLight* light,
                      const ImpostorOptions& options = {});

/// What a forest draws of one kind of plant, finest first; the plant itself is not among them.
struct PlantLevels {
  std::vector<PlantLevel> meshes;
  Impostor impostor;
};

struct LevelOptions {
  std::vector<float> leaf_shares{0.25f, 0.0625f, 0.015625f};  ///< falling, each in (0, 1)
  ImpostorOptions impostor;
};

/// Levels whose leaves grow so that the plant covers, seen from all sides, as much as it does.
PlantLevels makeLevels(const Plant& plant, const CrownLight* light,
                       const LevelOptions& options = {});

}  // namespace verdure

#endif  // VERDURE_LEVELS_H_
