#include "render/packed_transfer.h"

#include <algorithm>
#include <glm/gtc/packing.hpp>

#include "base/parallel.h"
#include "verdure/error.h"

namespace verdure {
namespace {

constexpr int kLeastBands = 2;

std::uint32_t coefficients(int bands) {
  return static_cast<std::uint32_t>(bands * bands);
}

std::uint32_t pairs(int bands) {
  return (coefficients(bands) + 1) / 2;
}

/// Three channels of one vector, two halves to a word.
void packVector(std::span<const std::uint16_t> halves, int bands, std::size_t v,
                std::uint32_t*& word) {
  const std::uint32_t count = coefficients(bands);
  for (std::uint32_t c = 0; c < 3; ++c)
    for (std::uint32_t i = 0; i < count; i += 2) {
      const auto half = [&](std::uint32_t k) -> std::uint32_t {
        return k < count ? halves[(v * count + k) * 3 + c] : 0u;
      };
      *word++ = half(i) | half(i + 1) << 16;
    }
}

glm::vec3 vectorLight(std::span<const std::uint16_t> halves, int bands, std::size_t v,
                      const glm::vec2* weights) {
  const std::uint32_t count = coefficients(bands);
  glm::vec3 sum(0.0f);
  for (int c = 0; c < 3; ++c)
    for (std::uint32_t i = 0; i < count; ++i)
      sum[c] +=
          glm::unpackHalf1x16(halves[(v * count + i) * 3 + static_cast<std::size_t>(c)]) *
          weights[static_cast<std::uint32_t>(c) * pairs(bands) + i / 2][static_cast<int>(i % 2)];
  return sum;
}

}  // namespace

void packTransfer(const TransferVectors& vectors, int bands, int bounce_bands, std::size_t vertices,
                  std::uint32_t first_vertex, std::size_t most_words, const std::string& where,
                  std::vector<PackedTransfer>& out) {
  if (bands < kLeastBands || bands > kMaxBands || bounce_bands < 0 ||
      bounce_bands > kMostBounceBands)
    throw Error(where, "its transfer vectors have a number of bands that cannot be",
                "compute them again");
  const bool two_sided = !vectors.back.empty();
  const auto fits = [vertices](const std::vector<std::uint16_t>& halves, int n, bool wanted) {
    return halves.size() == (wanted ? vertices * coefficients(n) * 3 : 0);
  };
  if (!fits(vectors.front, bands, true) || !fits(vectors.back, bands, two_sided) ||
      !fits(vectors.front_bounced, bounce_bands, true) ||
      !fits(vectors.back_bounced, bounce_bands, two_sided))
    throw Error(where, "has not one transfer vector for each vertex",
                "compute them for this plant");
  shared::TransferUniforms uniforms{};
  uniforms.pairs = pairs(bands);
  uniforms.bounce_pairs = pairs(bounce_bands);
  uniforms.first_weight = skyWeightsAt(bands);
  uniforms.first_bounce_weight = sunWeightsAt(bounce_bands);
  uniforms.two_sided = two_sided ? 1 : 0;
  const std::size_t words =
      std::size_t{3} * (uniforms.pairs + uniforms.bounce_pairs) * (two_sided ? 2 : 1);
  const std::size_t at_once = std::max<std::size_t>(most_words / words, 1);
  for (std::size_t begin = 0; begin < vertices; begin += at_once) {
    PackedTransfer part{uniforms, {}};
    const std::size_t count = std::min(at_once, vertices - begin);
    part.uniforms.count = static_cast<std::uint32_t>(count);
    part.uniforms.first_vertex = first_vertex + static_cast<std::uint32_t>(begin);
    part.words.resize(count * words);
    parallelFor(count, 1024, [&](std::size_t i) {
      std::uint32_t* word = part.words.data() + i * words;
      packVector(vectors.front, bands, begin + i, word);
      packVector(vectors.front_bounced, bounce_bands, begin + i, word);
      if (!two_sided) return;
      packVector(vectors.back, bands, begin + i, word);
      packVector(vectors.back_bounced, bounce_bands, begin + i, word);
    });
    out.push_back(std::move(part));
  }
}

std::vector<glm::vec2> packWeights(const Harmonics& sky, const Harmonics& sun) {
  std::vector<glm::vec2> packed(sunWeightsAt(kMostBounceBands + 1), glm::vec2(0.0f));
  const auto put = [&packed](std::uint32_t at, int bands, const Harmonics& from) {
    for (std::uint32_t c = 0; c < 3; ++c)
      for (std::uint32_t i = 0; i < coefficients(bands); ++i)
        packed[at + c * pairs(bands) + i / 2][static_cast<int>(i % 2)] =
            from.weights[i][static_cast<int>(c)];
  };
  for (int n = kLeastBands; n <= kMaxBands; ++n) put(skyWeightsAt(n), n, sky);
  for (int n = 1; n <= kMostBounceBands; ++n) put(sunWeightsAt(n), n, sun);
  return packed;
}

std::uint32_t skyWeightsAt(int bands) {
  std::uint32_t at = 0;
  for (int n = kLeastBands; n < bands; ++n) at += 3 * pairs(n);
  return at;
}

std::uint32_t sunWeightsAt(int bounce_bands) {
  std::uint32_t at = skyWeightsAt(kMaxBands + 1);
  for (int n = 1; n < bounce_bands; ++n) at += 3 * pairs(n);
  return at;
}

glm::vec3 transferLight(const TransferVectors& vectors, int bands, int bounce_bands, std::size_t v,
                        std::span<const glm::vec2> weights) {
  glm::vec3 sum = vectorLight(vectors.front, bands, v, weights.data() + skyWeightsAt(bands));
  if (bounce_bands > 0)
    sum += vectorLight(vectors.front_bounced, bounce_bands, v,
                       weights.data() + sunWeightsAt(bounce_bands));
  return glm::max(sum, glm::vec3(0.0f));
}

}  // namespace verdure
