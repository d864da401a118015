#ifndef VERDURE_PLANT_WEBER_PENN_H_
#define VERDURE_PLANT_WEBER_PENN_H_

#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "plant/tree_parameters.h"
#include "verdure/plant.h"

// Stems and leaf places of Weber and Penn, "Creation and Rendering of Realistic Trees", SIGGRAPH
// 1995. A stem's local frame: z along the stem, y towards its parent's tip; +Y is the world's up.

namespace verdure {

/// ShapeRatio of the paper: `ratio` is 0 at the top of the crown and 1 at its base; 8 is the
/// pruning envelope of `parameters`, 0 outside [0, 1]. (The paper prints 1 - PruneWidthPeak below
/// both parts of the envelope, which breaks it at the peak; the lower part is divided by
/// PruneWidthPeak.)
float shapeRatio(int shape, float ratio, const TreeParameters& parameters);

/// Radius at z in [0, 1] of a stem of radius `radius` at its base and length `length` (m), by
/// nTaper in [0, 3]. Without flare.
float taperedRadius(float taper, float z, float radius, float length);

/// The paper's flare_z: factor of the trunk's radius at z in [0, 1].
float flareFactor(float flare, float z);

/// One stem, or one clone of a stem from its split on.
struct Stem {
  std::uint32_t parent = kNone;
  int level = 0;
  float parent_along = 0;    ///< where it leaves `parent`, m along it
  float offset = 0;          ///< where its original leaves the stem of the level above, m
  float parent_length = 1;   ///< length of that stem, m
  float start = 0;           ///< m along the original's length: above 0 for clones
  float length = 0;          ///< m, of the original
  float length_share = 1;    ///< the nLength drawn for it
  float radius = 0;          ///< at the original's base, m, without flare
  std::uint64_t stream = 0;  ///< seed of its random numbers
  std::vector<BranchPoint> points;
  std::vector<float> along;       ///< m from the original's base, of each point
  std::vector<glm::quat> frames;  ///< at each point
};

struct LeafPlace {
  glm::vec3 position{0.0f};  ///< foot of the stalk
  glm::quat frame{};         ///< z along the midrib, y normal to the blade's upper side
  float length = 0, width = 0;
  std::uint32_t branch = 0;
  std::uint32_t noise = 0;  ///< random bits of its own
};

struct Skeleton {
  std::vector<Stem> stems;  ///< parents before children
  std::vector<LeafPlace> leaves;
  float height = 0;  ///< Scale with its variation drawn, m
  float z_scale = 1;
};

/// Grows stems and leaf places. The same for any number of threads. Throws Error for parameters
/// that ask for millions of stems or leaves.
Skeleton growSkeleton(const TreeParameters& parameters, std::uint64_t seed);

/// Whether a point lies inside the pruning envelope of a tree `height` metres high.
bool insideEnvelope(const TreeParameters& parameters, float height, float z_scale,
                    const glm::vec3& point);

}  // namespace verdure

#endif  // VERDURE_PLANT_WEBER_PENN_H_
