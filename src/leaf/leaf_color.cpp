#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/tile_noise.h"
#include "leaf/grown_leaf.h"

namespace verdure {

void paintLeaf(const BladeFields& fields, const Blemishes& blemishes, const LeafSpecies& species,
               const LeafGrowOptions& options, LeafSet& set) {
  const LeafFrame& frame = fields.frame;
  const auto n = static_cast<std::size_t>(frame.size);
  const auto cells = [&](float size_mm) {
    return std::max(2, static_cast<int>(frame.extent_mm / size_mm));
  };
  const int patches = cells(14), mottle = cells(2.2f), grain = cells(0.28f),
            areoles = cells(species.areole_mm);
  const auto own = static_cast<std::uint32_t>(hash(options.seed + 120));
  Random random(hash(options.seed ^ 0x636f6c6f72ull));
  // Leaves of a tree differ in how dark they are and in when they turn.
  const float dark = random.uniform(0.93f, 1.07f), late = random.vary(0.03f);
  std::vector<float> glow = fields.ridge.height;  // along veins the tissue is paler
  blur(glow, frame.size, 0.35f / frame.mmPerTexel());

  for (LeafSide* side : {&set.front, &set.back}) {
    side->albedo.resize(n * n);
    side->translucency.resize(n * n);
  }
  const float spring = 1 - glm::smoothstep(0.0f, 0.34f, options.age);
  parallelFor(n, 4, [&](std::size_t row) {
    for (std::size_t x = 0; x < n; ++x) {
      const std::size_t i = row * n + x;
      if (fields.edge[i] < -3 * frame.mmPerTexel()) continue;  // filled later
      const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(n);
      const float v = (static_cast<float>(row) + 0.5f) / static_cast<float>(n);
      const float slow = fractalNoise(u, v, patches, patches, 3, own) - 0.5f;
      const float spotty = fractalNoise(u, v, mottle, mottle, 2, own + 3) - 0.5f;
      const float fine = valueNoise(u, v, grain, grain, own + 6) - 0.5f;
      const Cell cell = cellNoise(u, v, areoles, areoles, own + 9);
      const float field = glm::smoothstep(0.02f, 0.35f, cell.border);
      const float blade = 1 - fields.stalk[i];

      // Autumn begins at the margin and far from the veins.
      const float inside = std::clamp(fields.edge[i] / fields.edge_reach, 0.0f, 1.0f);
      const float by_vein = std::exp(-fields.major[i] / (0.5f * species.quilt_reach_mm));
      const float onset =
          0.57f + late + 0.07f * inside + 0.06f * by_vein - 0.22f * slow - 0.06f * spotty;
      const float turned = glm::smoothstep(0.0f, 0.30f, options.age - onset);
      Pigments pigments = mix(species.summer, species.spring, spring);
      pigments = mix(pigments, species.autumn, turned);
      pigments.chlorophyll *= dark * (1 + 0.30f * slow + 0.14f * spotty + 0.12f * fine) *
                              (0.90f + 0.12f * field + 0.10f * (cell.value - 0.5f));
      pigments.anthocyanin *= 1 + 0.7f * slow + 0.3f * spotty + 0.15f * fine;
      pigments.carotenoid *= 1 + 0.2f * slow;

      // Veins have little of all pigments.
      const float vein = fields.ridge.tone[i];
      const float halo = 1 - std::exp(-glow[i] / 0.12f);
      const float lack = species.vein_contrast * std::max(vein, 0.38f * halo) * blade;
      const Pigments full = pigments;
      pigments.chlorophyll *= 1 - lack;
      pigments.anthocyanin *= 1 - 0.7f * lack;
      pigments.carotenoid *= 1 - 0.35f * lack;
      // The midrib's foot still has the stalk's colours.
      const float thick =
          glm::smoothstep(0.35f, 0.85f, fields.ridge.height[i] / fields.stalk_radius);
      Pigments stalk = species.stalk;
      stalk.chlorophyll *= 1 - 0.8f * glm::smoothstep(0.65f, 1.0f, options.age);
      pigments = mix(pigments, stalk, std::max(1 - blade, 0.7f * thick));
      pigments.tannin += vein * blade * (0.03f + 0.22f * turned);

      // Dead tissue: brown, darker where it borders on the living.
      const float brown = blemishes.brown[i];
      const float rim = 4 * brown * (1 - brown);
      pigments = mix(pigments, {0.04f, 0.25f, 0.0f, 1.0f + 0.3f * spotty + 0.25f * fine}, brown);
      pigments.tannin += 0.5f * rim * blade;

      const glm::vec3 depth = absorbance(pigments);
      // What the front's smooth surface throws back is its gloss, not its albedo.
      glm::vec3 front = reflected(depth, 1.0f, 0.008f);
      glm::vec3 back = reflected(depth, species.back_path, 0.018f) + species.back_bloom;
      back = glm::mix(back, glm::vec3(glm::dot(back, glm::vec3(0.3f, 0.6f, 0.1f))), 0.08f);
      // At the back veins stand out pale.
      back *= 1 + 0.18f * vein * blade;
      // Against the light veins are thick and dark, down to the finest.
      glm::vec3 through =
          transmitted(glm::mix(absorbance(full), depth, std::max(1 - blade, brown)), 1);
      const float thread = vein * (2 - vein);
      const float shade = 1 - (0.60f * thread + 0.08f * halo) * blade -
                          0.07f * (1 - field) * blade - 0.45f * fields.stalk[i];
      const glm::vec3 wooden(1.0f, 0.93f, 0.75f);
      through *= shade * glm::mix(glm::vec3(1), wooden, vein);
      through *= 1 - 0.45f * brown;
      set.front.albedo[i] = glm::clamp(front, 0.0f, 1.0f);
      set.back.albedo[i] = glm::clamp(back, 0.0f, 1.0f);
      set.front.translucency[i] = glm::clamp(0.97f * through, 0.0f, 1.0f);
      set.back.translucency[i] = glm::clamp(through, 0.0f, 1.0f);
    }
  });
}

}  // namespace verdure
