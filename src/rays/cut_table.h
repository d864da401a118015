#ifndef VERDURE_RAYS_CUT_TABLE_H_
#define VERDURE_RAYS_CUT_TABLE_H_

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "scene/texel_grid.h"

namespace verdure {

/// What a texture's alpha cut leaves of a piece of surface.
enum class Cut : std::uint8_t { kOpaque, kTransparent, kMixed };

/// Which parts of a texture are wholly opaque or wholly cut, exactly as bilinear interpolation has
/// it: between four neighbouring texel centres alpha stays within theirs.
class CutTable {
 public:
  /// `cutoff` in (0, 1]: alpha below it is cut.
  CutTable(const Texture& texture, float cutoff);

  bool transparentAt(const glm::vec2& uv) const {
    const TexelGrid::Cell at = grid_.cellAt(uv);
    // Clamped at the low edge, its texel is one of the first cell's.
    const Cut kind = cells_[cellIndex(at.x0, at.y0)];
    return kind == Cut::kMixed ? grid_.alpha(at) < cutoff_ : kind == Cut::kTransparent;
  }
  /// Of the triangle with these texture coordinates; kMixed wherever it is not certain.
  Cut classify(const std::array<glm::vec2, 3>& uvs) const;

 private:
  // Between texel i and i + 1; i runs from -1 to the size - 1.
  std::size_t cellIndex(int x, int y) const {
    return static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(x + 1);
  }
  bool uniform(int first_x, int last_x, int y, std::optional<Cut>& seen) const;

  TexelGrid grid_;
  float cutoff_ = 0.0f;  ///< of 255
  int columns_ = 0;
  std::vector<Cut> cells_;
  std::vector<std::int32_t> run_end_;  ///< last cell of its row's run of the same kind
};

}  // namespace verdure

#endif  // VERDURE_RAYS_CUT_TABLE_H_
