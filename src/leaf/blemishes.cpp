#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/tile_noise.h"
#include "leaf/grown_leaf.h"

namespace verdure {
namespace {

/// Something that appears at an age and grows from nothing.
struct Spot {
  glm::vec2 center;  ///< texels
  float radius;      ///< mm, at this age
  bool hole;
};

float growth(float age, float birth) {
  return std::sqrt(std::clamp((age - birth) / 0.35f, 0.0f, 1.0f));
}

std::vector<Spot> spotsOf(const GrownLeaf& leaf, const LeafFrame& frame,
                          const LeafGrowOptions& options) {
  // Leaves of other species with the same seed have other spots.
  Random random(hash(options.seed ^ 0x73706f7473ull ^ (std::uint64_t{leaf.veins.size()} << 32)));
  const float area = static_cast<float>(std::abs(polygonArea(leaf.form.outline)));
  const float scale = std::clamp(std::sqrt(area) / 35, 0.4f, 1.4f);
  std::vector<Spot> spots;
  const auto add = [&](const glm::vec2& mm, float birth, float radius, bool hole) {
    const float r = radius * scale * growth(options.age, birth);
    if (r > 0) spots.push_back({frame.toTexel(mm), r, hole});
  };
  // Later ones are born at any age, so all are drawn, whatever the age.
  for (int k = 0; k < 46; ++k) {
    const VeinNode& near = leaf.veins[random.below(static_cast<std::uint32_t>(leaf.veins.size()))];
    const glm::vec2 at = near.position + glm::vec2(random.vary(1.0f), random.vary(1.0f));
    const float birth = 0.25f + 0.75f * std::sqrt(random.uniform());
    const float size = random.uniform();
    const bool stalk = near.position.y < leaf.form.blade_base + 2;
    if (k < 40) {
      if (!stalk) add(at, birth, 0.2f + 1.0f * size * size * size, false);
    } else if (k < 43 && !stalk) {
      add(at, 0.40f + 0.60f * random.uniform(), 1.0f + 2.2f * size * size, true);
    }
  }
  // Bites out of the margin.
  for (int k = 0; k < 3; ++k) {
    const glm::vec2 at =
        leaf.form.outline[random.below(static_cast<std::uint32_t>(leaf.form.outline.size()))];
    const float birth = 0.40f + 0.9f * random.uniform(), size = random.uniform();
    if (at.y > leaf.form.blade_base + 4) add(at, birth, 1.2f + 2.5f * size * size, true);
  }
  return spots;
}

}  // namespace

Blemishes blemish(const GrownLeaf& leaf, const BladeFields& fields, const LeafSpecies& species,
                  const LeafGrowOptions& options) {
  const LeafFrame& frame = fields.frame;
  const auto side = static_cast<std::size_t>(frame.size);
  const float far = 1e3f, mm = frame.mmPerTexel();
  Blemishes result{std::vector<float>(side * side, far), std::vector<float>(side * side)};
  const std::vector<Spot> spots = spotsOf(leaf, frame, options);
  const int coarse = std::max(2, static_cast<int>(frame.extent_mm / 9));
  const int fine = std::max(2, static_cast<int>(frame.extent_mm / 1.1f));
  const auto seed = static_cast<std::uint32_t>(hash(options.seed + 40));
  parallelFor(side, 4, [&](std::size_t row) {
    for (std::size_t x = 0; x < side; ++x) {
      const std::size_t i = row * side + x;
      const glm::vec2 p(static_cast<float>(x) + 0.5f, static_cast<float>(row) + 0.5f);
      const float u = p.x / static_cast<float>(side), v = p.y / static_cast<float>(side);
      if (fields.edge[i] < -2 * mm) continue;
      const float rough = fractalNoise(u, v, fine, fine, 2, seed) - 0.5f;
      const float slow = fractalNoise(u, v, coarse, coarse, 3, seed + 7) - 0.5f;
      float hole = far, brown = 0;
      for (const Spot& spot : spots) {
        const glm::vec2 away = (p - spot.center) * mm;
        const float reach = 2 * spot.radius + 1.5f;
        if (glm::dot(away, away) > reach * reach) continue;
        const float d = glm::length(away) * (1 + 0.9f * rough) - spot.radius;
        if (spot.hole)
          hole = std::min(hole, d);
        else
          brown = std::max(brown, 1 - glm::smoothstep(-0.35f * spot.radius, 0.12f, d));
      }
      // What chews leaves spares strong veins; the rim dies.
      hole = std::max(hole, 0.45f - fields.major[i] + 0.4f * rough);
      if (hole < 3) brown = std::max(brown, 0.9f * std::exp(-std::max(hole, 0.0f) / 0.35f));
      // The margin dries, teeth first.
      const float depth = fields.edge[i] / fields.edge_reach;
      const float onset = 0.80f + (1.5f * depth - 1.0f * slow - 0.25f * rough) /
                                      std::max(species.edge_browning, 0.05f) * 0.55f;
      brown = std::max(brown, glm::smoothstep(0.0f, 0.24f, options.age - std::max(onset, 0.42f)));
      // A blotch where the slow noise is high, late.
      brown = std::max(
          brown,
          0.9f * glm::smoothstep(0.0f, 0.10f, options.age - 1.12f + 0.75f * slow + 0.10f * rough));
      const float blade = 1 - fields.stalk[i];
      result.hole[i] = fields.stalk[i] > 0.02f ? std::max(hole, 0.2f) : hole;
      result.brown[i] = brown * blade;
    }
  });
  return result;
}

}  // namespace verdure
