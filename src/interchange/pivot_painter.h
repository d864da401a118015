#ifndef VERDURE_INTERCHANGE_PIVOT_PAINTER_H_
#define VERDURE_INTERCHANGE_PIVOT_PAINTER_H_

#include <cstdint>
#include <string>

#include "verdure/motion.h"

// Textures of Pivot Painter 2, a texel for each branch, rows from the top. Unreal's x, y, z are
// glTF's x, z, y.
namespace verdure {

/// Parents are numbered by the bits of halves, from 1024 on: 30719 is the last below infinity.
inline constexpr std::size_t kMostElements = 30720;

/// RGB: a branch's root, cm; A: its parent's number (its own for a trunk) + 1024 as the bits of a
/// half. OpenEXR. Roots are relative to `origin`, which is added.
std::vector<std::uint8_t> pivotTexture(const MotionTree& tree, const glm::dvec3& origin);

/// RGB: the branch's axis, 0.5 + 0.5 v; A: its length, in steps of 8 cm, 1 to 256, as share of 256.
/// TGA of 8 bits, rows from the bottom.
std::vector<std::uint8_t> axisTexture(const MotionTree& tree);

/// The names that Pivot Painter's own tool gives, for UV set `uv_set` (1 = the second, "UV2").
std::string pivotTextureName(const std::string& mesh, int uv_set);
std::string axisTextureName(const std::string& mesh, int uv_set);

}  // namespace verdure

#endif  // VERDURE_INTERCHANGE_PIVOT_PAINTER_H_
