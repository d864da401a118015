#ifndef VERDURE_RENDER_PACKED_GRASS_H_
#define VERDURE_RENDER_PACKED_GRASS_H_

#include <array>
#include <vector>

#include "gpu/resources.h"
#include "shared/grass.h"
#include "verdure/scene.h"

namespace verdure {

/// A layer of grass as arrays for the GPU, and what of GrassUniforms hangs on neither eye nor time.
struct PackedGrass {
  /// Layers of textures with their mips: each kind of slice, then the opaque one.
  std::vector<std::vector<gpu::MipLevel>> slice_colors, slice_data;
  std::vector<std::vector<gpu::MipLevel>> ground_colors, ground_data;  ///< ground, middle
  /// shared::kFarLevels of each kind of slice and of all kinds' mean: colour, root of alpha.
  std::vector<std::vector<gpu::MipLevel>> far_colors;
  CoverMap cover;
  std::vector<GrassPlant> plants;  ///< of which those near the eye are drawn one by one
  shared::GrassUniforms uniforms{};
  bool ends_at_depth = true, medium = true;
};

/// Throws Error for a layer without a set, numbers out of range.
PackedGrass packGrass(const GrassLayer& layer);

/// Half a byte for 0, so that numbers of both signs have one: [-1, 1] from value / 255.
std::array<std::uint8_t, 4> packGrassData(const glm::vec4& data);

}  // namespace verdure

#endif  // VERDURE_RENDER_PACKED_GRASS_H_
