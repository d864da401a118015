#ifndef VERDURE_LEVELS_H_
#define VERDURE_LEVELS_H_

#include <array>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "verdure/density.h"
#include "verdure/motion.h"
#include "verdure/plant.h"

/// Coarser versions of a plant, for where it is small: fewer, larger leaves and simpler wood, and
/// pictures of it from around.
namespace verdure {

/// A plant with fewer leaves and triangles.
struct PlantLevel {
  Plant plant;  ///< as many meshes as the plant has, in its order; some may be empty
  std::optional<CrownLight> light;
  std::optional<PlantMotion> motion;
  /// Of each mesh, of each vertex: the plant's vertex that it comes from.
  std::vector<std::vector<std::uint32_t>> sources;
  float leaf_share = 1.0f;  ///< of the plant's leaves
};

/// `leaf_share` of the leaves, (0, 1]: the same random order for all shares, so that a level's
/// leaves are among those of a finer one. Each that stays grows about the middle of its base so
/// that the area of all does (Cook, Halstead, Planck, Ryu, "Stochastic Simplification of Aggregate
/// Detail", SIGGRAPH 2007). Wood keeps about `wood_share` of its triangles, fewer where
/// `wood_error` (of the plant's size) lets it. Deterministic.
PlantLevel simplifyPlant(const Plant& plant, const CrownLight* light, const PlantMotion* motion,
                         float leaf_share, float wood_share, float wood_error);

/// A plant seen from the corners of an octahedron's upper half, unfolded to a square of
/// `views` x `views` pictures (shared/octahedron.h), each `texels` wide, without perspective and as
/// large as a sphere around the plant. Rows first, the whole square as one picture.
struct Impostor {
  int views = 0, texels = 0;
  glm::vec3 center{0.0f};  ///< of the sphere, in the plant's coordinates
  float radius = 0.0f;     ///< m
  Image color;             ///< base colour, sRGB, spread beyond the plant; alpha: covered share
  /// Mean normal on the seen side of leaves and wood, 0.5 + 0.5 n, its length the share that is not
  /// scattered around; alpha: depth from the sphere's front (255) to its back (0), mean.
  Image normal;
  /// Red: ambient coefficient. Green: share of foliage. Blue: light that goes through, green
  /// channel of the mean transmittance over that of the colour. Alpha 255.
  Image light;
};

struct ImpostorOptions {
  int views = 8;    ///< a side, [2, 32]
  int texels = 96;  ///< of a picture, [16, 512]
  int samples = 4;  ///< rays a texel, along each axis, [1, 16]
};

/// Throws Error for a plant without triangles and options out of range. Deterministic for any
/// number of threads.
Impostor bakeImpostor(const Plant& plant, const CrownLight* light,
                      const ImpostorOptions& options = {});

/// What a forest draws of one kind of plant, finest first; the plant itself is not among them.
struct PlantLevels {
  std::vector<PlantLevel> meshes;
  Impostor impostor;
};

struct LevelOptions {
  std::vector<float> leaf_shares{0.25f, 0.0625f};  ///< falling, each in (0, 1)
  ImpostorOptions impostor;
};

PlantLevels makeLevels(const Plant& plant, const CrownLight* light, const PlantMotion* motion,
                       const LevelOptions& options = {});

}  // namespace verdure

#endif  // VERDURE_LEVELS_H_
