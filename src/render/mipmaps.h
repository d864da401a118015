#ifndef VERDURE_RENDER_MIPMAPS_H_
#define VERDURE_RENDER_MIPMAPS_H_

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "gpu/resources.h"
#include "verdure/image.h"
#include "verdure/plant.h"

namespace verdure {

struct MipChain {
  std::vector<gpu::MipLevel> levels;  ///< largest first, down to 1 x 1
  glm::vec3 mean_color{1.0f};         ///< linear RGB; of the opaque part if alpha is cut
};

/// Where a texture is used: a raster over its unit square, 0 where no triangle reads it. Leaf
/// geometry hugs its outline, so most of the transparent part is never drawn, and coverage is that
/// of the rest.
class UsedTexels {
 public:
  static constexpr int kSize = 64;
  /// Marks the cells that triangles of the mesh read (repeating). Of large meshes an even sample:
  /// leaves repeat a few outlines.
  void add(const Mesh& mesh);
  /// At texture coordinates in [0, 1); everywhere true while nothing was added.
  bool at(float u, float v) const;

 private:
  std::vector<std::uint8_t> cells_;
};

/// Mips of an sRGB colour texture, box-filtered in linear light. With `alpha_cutoff` in (0, 1] the
/// texture is alpha-cut: colours are weighted by alpha, transparent texels take the colour of their
/// opaque neighbours (no halos), and the alpha of every level is scaled so that the level covers as
/// much as the first (Castano, "Computing Alpha Mipmaps", 2010) of what is `used`, as measured by
/// alphaCoverage().
MipChain buildColorMips(const Image& image, std::optional<float> alpha_cutoff,
                        const UsedTexels& used = {});

/// Mips of a texture of linear data (normal maps).
MipChain buildLinearMips(const Image& image);

/// Share of the used part of a repeating texture level that plant_pass.frag covers: alpha,
/// interpolated bilinearly, times `scale`, steepened around the cutoff by `slope` (the shader's
/// least; infinity = a sharp cut).
double alphaCoverage(const gpu::MipLevel& level, float cutoff, float slope, float scale = 1.0f,
                     const UsedTexels& used = {});

/// The shader's least steepness of alpha around the cutoff.
inline constexpr float kCoverageSlope = 8.0f;

}  // namespace verdure

#endif  // VERDURE_RENDER_MIPMAPS_H_
