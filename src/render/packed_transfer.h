#ifndef VERDURE_RENDER_PACKED_TRANSFER_H_
#define VERDURE_RENDER_PACKED_TRANSFER_H_

#include <cstdint>
#include <span>
#include <vector>

#include "shared/frame.h"
#include "verdure/harmonics.h"
#include "verdure/transfer.h"

namespace verdure {

constexpr int kMostBounceBands = 3;

/// Some vertices of a mesh with their transfer vectors as transfer_pass.comp reads them: for each
/// vertex front, then back; each: red, green, blue by the sky, then by the sun, the coefficients
/// two to a word. `uniforms.first_vertex` counts from the scene's first vertex.
struct PackedTransfer {
  shared::TransferUniforms uniforms{};
  std::vector<std::uint32_t> words;
};

/// Packs a mesh's vectors into parts of at most `most_words` words (at least one vertex each).
/// `where` names the mesh. Throws Error where the lengths do not fit `vertices` and the bands.
void packTransfer(const TransferVectors& vectors, int bands, int bounce_bands, std::size_t vertices,
                  std::uint32_t first_vertex, std::size_t most_words, const std::string& where,
                  std::vector<PackedTransfer>& out);

/// Weights of the sky and of the sun for every number of bands, as transfer_pass.comp reads them:
/// pairs of coefficients of red, then green, then blue. Vectors of more bands than the sky has find
/// zeros.
std::vector<glm::vec2> packWeights(const Harmonics& sky, const Harmonics& sun);
std::uint32_t skyWeightsAt(int bands);  ///< index of the pairs for vectors of these bands
std::uint32_t sunWeightsAt(int bounce_bands);

/// Irradiance / pi of vector v of some, the same sum as the shader's.
glm::vec3 transferLight(const TransferVectors& vectors, int bands, int bounce_bands, std::size_t v,
                        std::span<const glm::vec2> weights);

}  // namespace verdure

#endif  // VERDURE_RENDER_PACKED_TRANSFER_H_
