#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "base/parallel.h"
#include "base/random.h"
#include "base/tile_noise.h"
#include "leaf/fill_outside.h"
#include "leaf/grown_leaf.h"

namespace verdure {
namespace {

constexpr float kTwigLength = 92, kTwigRadius = 2.0f;
constexpr float kSheath = 5;     ///< brown foot of a pair of needles
constexpr float kLayer = 0.45f;  ///< half the depth that all rods share, mm: pressed flat

}  // namespace

std::vector<Rod> makeRods(std::uint32_t seed) {
  Random random(hash(seed ^ 0x70696e65ull));
  std::vector<Rod> rods;
  Rod twig;
  twig.part = Rod::Part::kTwig;
  const float sway = random.vary(4.0f);
  const auto axis = [&](float y) {
    const float t = y / kTwigLength;
    return glm::vec2(sway * t * t, y);
  };
  for (int k = 0; k <= 46; ++k) {
    const float y = kTwigLength * static_cast<float>(k) / 46;
    twig.points.push_back(axis(y));
    // A bud at the end.
    const float bud = std::exp(-std::pow((y - kTwigLength + 5) / 3.2f, 2.0f));
    const float end = std::sqrt(std::max(1 - std::pow(y / kTwigLength, 24.0f), 0.01f));
    twig.radii.push_back((kTwigRadius * (1 - 0.35f * y / kTwigLength) + 1.1f * bud) * end);
  }
  twig.length = kTwigLength;
  rods.push_back(twig);

  const int pairs = 84;
  for (int k = 0; k < pairs; ++k) {
    const float t = (static_cast<float>(k) + random.uniform()) / static_cast<float>(pairs);
    const float root = 3 + (kTwigLength - 5) * t;
    // Pairs stand in a spiral; towards the end of the shoot they lean forward.
    const float around = 2.39996f * static_cast<float>(k) + random.vary(0.25f);
    const float lean = glm::mix(0.95f, 0.30f, t * t) + random.vary(0.14f);
    const float length = random.uniform(44, 58) * (1 - 0.18f * t);
    const float turned = random.uniform(0, glm::pi<float>());
    for (const float sign : {-1.0f, 1.0f}) {
      const float open = 0.085f + random.uniform(0, 0.05f);
      const float a = lean + sign * open * std::cos(turned);
      const float b = around + sign * open * std::sin(turned) / std::max(std::sin(lean), 0.3f);
      const float curve = random.vary(0.10f);
      Rod needle;
      needle.height = std::clamp(std::sin(b), -0.98f, 0.98f);
      needle.shade = random.uniform(0.86f, 1.12f);
      needle.old = random.uniform();
      needle.length = length;
      const float radius = random.uniform(0.58f, 0.72f);
      const int steps = 14;
      glm::vec2 p = axis(root) + 0.6f * kTwigRadius * glm::vec2(std::cos(b), 0);
      for (int i = 0; i <= steps; ++i) {
        const float u = static_cast<float>(i) / static_cast<float>(steps);
        needle.points.push_back(p);
        const float tip = std::sqrt(std::clamp((1 - u) / 0.16f, 0.0f, 1.0f));
        needle.radii.push_back(
            std::max(radius * (0.82f + 0.18f * std::min(u / 0.1f, 1.0f)) * tip, 0.06f));
        const float now = a + curve * u * u - 0.10f * u;
        p += length / static_cast<float>(steps) *
             glm::vec2(std::sin(now) * std::cos(b), std::cos(now));
      }
      rods.push_back(needle);
    }
  }
  // From the nearest to the farthest.
  std::stable_sort(rods.begin(), rods.end(),
                   [](const Rod& a, const Rod& b) { return a.height > b.height; });
  return rods;
}

namespace {

/// Where a texel lies on a rod.
struct Place {
  float cover = 0;   ///< of the texel, [0, 1]
  float across = 0;  ///< distance from the axis by the radius
  float along = 0;   ///< mm from the foot
  float radius = 0;
};

Place placeOn(const Rod& rod, const glm::vec2& p, float mm) {
  Place best;
  float inside = -1e30f, before = 0;
  for (std::size_t i = 0; i + 1 < rod.points.size(); ++i) {
    const glm::vec2 ab = rod.points[i + 1] - rod.points[i], ap = p - rod.points[i];
    const float length2 = glm::dot(ab, ab), length = std::sqrt(length2);
    const float t = std::clamp(glm::dot(ap, ab) / std::max(length2, 1e-9f), 0.0f, 1.0f);
    const float d = glm::length(ap - t * ab);
    const float r = glm::mix(rod.radii[i], rod.radii[i + 1], t);
    if (r - d > inside) {
      inside = r - d;
      best.across = std::min(d / r, 1.0f);
      best.along = before + t * length;
      best.radius = r;
    }
    before += length;
  }
  best.cover = std::clamp(inside / mm + 0.5f, 0.0f, 1.0f);
  return best;
}

struct Paint {
  glm::vec3 front, back, through;
};

Paint paintRod(const Rod& rod, const Place& place, const LeafSpecies& species, float age,
               float noise) {
  const float spring = 1 - glm::smoothstep(0.0f, 0.34f, age);
  Pigments pigments = mix(species.summer, species.spring, spring);
  // Needles live for years: only the oldest yellow in autumn, from the tip.
  const float tip = place.along / rod.length;
  const float onset = 0.68f + 1.0f * rod.old - 0.18f * tip;
  pigments = mix(pigments, species.autumn, glm::smoothstep(0.0f, 0.35f, age - onset));
  pigments.chlorophyll *= rod.shade * (1 + 0.25f * noise);
  pigments.chlorophyll *= 1 + 0.09f * std::cos(place.across * 9.4f);  // rows of stomata
  const float dry = glm::smoothstep(0.0f, 0.2f, age - onset - 0.12f + 0.25f * tip);
  pigments = mix(pigments, {0.02f, 0.3f, 0, 1.1f}, 0.8f * dry);
  // A yellow point, a brown sheath.
  pigments.carotenoid += 0.5f * glm::smoothstep(0.955f, 1.0f, tip);
  const float sheath = 1 - glm::smoothstep(0.75f * kSheath, kSheath, place.along);
  pigments = mix(pigments, {0.02f, 0.15f, 0.05f, 0.85f + 0.6f * noise}, sheath);
  if (rod.part == Rod::Part::kTwig) {
    pigments = species.stalk;
    pigments.tannin *= 1 + 0.8f * noise;
    pigments.chlorophyll *= 1 + 0.8f * noise;
  }
  const glm::vec3 depth = absorbance(pigments);
  Paint paint{reflected(depth, 1.0f, 0.01f),
              reflected(depth, species.back_path, 0.02f) + species.back_bloom,
              transmitted(depth, 1.15f)};
  const float wax = rod.part == Rod::Part::kNeedle ? 1 - sheath : 0.0f;
  paint.front += wax * glm::vec3(0.006f, 0.010f, 0.016f);  // bluish
  paint.back += wax * glm::vec3(0.006f, 0.010f, 0.016f);
  if (rod.part == Rod::Part::kTwig) paint.through *= 0.1f;
  // Thickest along the axis.
  paint.through *= 1 - 0.35f * (1 - place.across * place.across);
  return paint;
}

}  // namespace

LeafSet paintShoot(const GrownLeaf& leaf, const LeafSpecies& species, const LeafFrame& frame,
                   const LeafGrowOptions& options) {
  const float mm = frame.mmPerTexel();
  const auto n = static_cast<std::size_t>(options.size);
  LeafSet set;
  set.width = set.height = options.size;
  set.mm_per_texel = mm;
  set.opacity.resize(n * n);
  set.thickness_mm.resize(n * n);
  for (LeafSide* side : {&set.front, &set.back}) {
    side->albedo.resize(n * n);
    side->translucency.resize(n * n);
    side->relief_mm.resize(n * n);
  }

  // Rods by tiles, still from the nearest on.
  constexpr std::size_t kTile = 16;
  const std::size_t tiles = (n + kTile - 1) / kTile;
  std::vector<std::vector<const Rod*>> near(tiles * tiles);
  for (const Rod& rod : leaf.rods)
    for (std::size_t ty = 0; ty < tiles; ++ty)
      for (std::size_t tx = 0; tx < tiles; ++tx) {
        const glm::vec2 center = frame.toMm((glm::vec2(tx, ty) + 0.5f) * static_cast<float>(kTile));
        const float reach = 0.71f * kTile * mm + 1.5f * mm;
        for (std::size_t i = 0; i + 1 < rod.points.size(); ++i) {
          const glm::vec2 a = rod.points[i], ab = rod.points[i + 1] - a;
          const float t =
              std::clamp(glm::dot(center - a, ab) / std::max(glm::dot(ab, ab), 1e-9f), 0.0f, 1.0f);
          if (glm::length(center - a - t * ab) < reach + std::max(rod.radii[i], rod.radii[i + 1])) {
            near[ty * tiles + tx].push_back(&rod);
            break;
          }
        }
      }

  const int grain = std::max(2, static_cast<int>(frame.extent_mm / 1.4f));
  const auto own = static_cast<std::uint32_t>(hash(options.seed + 160));
  std::vector<glm::vec3> reliefs(n * n);  // front, back
  parallelFor(tiles, 1, [&](std::size_t ty) {
    std::vector<std::pair<const Rod*, Place>> hit;
    for (std::size_t y = ty * kTile; y < std::min((ty + 1) * kTile, n); ++y)
      for (std::size_t x = 0; x < n; ++x) {
        const std::size_t i = y * n + x;
        const glm::vec2 texel(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        const glm::vec2 p = frame.toMm(texel);
        hit.clear();
        float clear = 1;
        for (const Rod* rod : near[ty * tiles + x / kTile]) {
          const Place place = placeOn(*rod, p, mm);
          if (place.cover <= 0) continue;
          hit.emplace_back(rod, place);
          clear *= 1 - place.cover;
        }
        set.opacity[i] = 1 - clear;
        if (hit.empty()) continue;
        const glm::vec2 uv = texel / static_cast<float>(n);
        const float noise = fractalNoise(uv.x, uv.y, grain, grain, 2, own) - 0.5f;
        // Each side sees its own nearest rods.
        const auto compose = [&](bool front, LeafSide& side, float& relief) {
          glm::vec3 color(0), through(0);
          float left = 1, height = 0;
          for (std::size_t k = 0; k < hit.size() && left > 1e-4f; ++k) {
            const auto& [rod, place] = hit[front ? k : hit.size() - 1 - k];
            const Paint paint = paintRod(*rod, place, species, options.age, noise);
            const float weight = left * place.cover;
            const float round =
                place.radius * std::sqrt(std::max(1 - place.across * place.across, 0.04f));
            color += weight * (front ? paint.front : paint.back);
            through += weight * paint.through;
            height += weight * (round + (front ? kLayer : -kLayer) * rod->height);
            left -= weight;
          }
          const float all_weight = 1 - left;
          side.albedo[i] = glm::clamp(color / all_weight, 0.0f, 1.0f);
          side.translucency[i] = glm::clamp(through / all_weight, 0.0f, 1.0f);
          relief = height / all_weight;
        };
        compose(true, set.front, reliefs[i].x);
        compose(false, set.back, reliefs[i].y);
        // At the tips the layers may be farther apart than the needle is thick.
        const float lack = std::max(0.12f - reliefs[i].x - reliefs[i].y, 0.0f);
        reliefs[i].x += 0.5f * lack;
        reliefs[i].y += 0.5f * lack;
      }
  });
  fillOutside(reliefs, insideOf(set), options.size, options.size);
  for (std::size_t i = 0; i < n * n; ++i) {
    set.front.relief_mm[i] = reliefs[i].x;
    set.back.relief_mm[i] = reliefs[i].y;
    set.thickness_mm[i] = reliefs[i].x + reliefs[i].y;
  }
  setNormals(set.front, options.size, mm);
  setNormals(set.back, options.size, mm);
  return set;
}

}  // namespace verdure
