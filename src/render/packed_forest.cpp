#include "render/packed_forest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "base/parallel.h"
#include "shared/color.h"
#include "verdure/error.h"

namespace verdure {
namespace {

static_assert(sizeof(Placement) == sizeof(shared::ForestPlace));

/// A level is drawn until the leaves of the next are as small as this, pixels.
constexpr float kGrainPixels = 2.2f;
/// And the last one until a texel of the impostor is.
constexpr float kImpostorPixels = 1.25f;

/// Interleaves the bits of x and z (Morton 1966): neighbours on the curve are neighbours.
std::uint64_t curvePlace(std::uint32_t x, std::uint32_t z) {
  const auto spread = [](std::uint64_t v) {
    v = (v | (v << 16)) & 0x0000ffff0000ffffull;
    v = (v | (v << 8)) & 0x00ff00ff00ff00ffull;
    v = (v | (v << 4)) & 0x0f0f0f0f0f0f0f0full;
    v = (v | (v << 2)) & 0x3333333333333333ull;
    return (v | (v << 1)) & 0x5555555555555555ull;
  };
  return spread(x) | (spread(z) << 1);
}

void check(const Forest& forest) {
  for (std::size_t k = 0; k < forest.kinds.size(); ++k)
    if (forest.kinds[k].plant == nullptr)
      throw Error("forest", fmt::format("kind {} has no plant", k), "set ForestKind::plant");
  if (!(forest.detail > 0.0f && forest.detail <= 100.0f))
    throw Error("forest", fmt::format("a detail of {}", forest.detail), "choose above 0 to 100");
  for (std::size_t i = 0; i < forest.places.size(); ++i) {
    const Placement& place = forest.places[i];
    const glm::vec3& p = place.position;
    if (place.plant >= forest.kinds.size())
      throw Error("forest", fmt::format("tree {} is of kind {}", i, place.plant),
                  fmt::format("there are {} kinds", forest.kinds.size()));
    if (!(place.scale > 0.0f) || !std::isfinite(p.x + p.y + p.z + place.angle + place.scale))
      throw Error("forest", fmt::format("tree {} stands nowhere", i),
                  "give it a finite place and a scale above 0");
  }
}

/// One view's picture and its mips. All values are means, so those of mips are, too.
std::vector<gpu::MipLevel> mipsOf(const Image& atlas, int column, int row, int texels, bool srgb) {
  const auto side = static_cast<std::size_t>(texels);
  std::vector<glm::vec4> level(side * side);
  for (std::size_t y = 0; y < side; ++y)
    for (std::size_t x = 0; x < side; ++x) {
      const std::uint8_t* p =
          atlas.at(column * texels + static_cast<int>(x), row * texels + static_cast<int>(y));
      glm::vec4& t = level[y * side + x];
      for (int c = 0; c < 4; ++c) {
        const float value = static_cast<float>(p[c]) / 255.0f;
        t[c] = srgb && c < 3 ? shared::linearFromSrgb(value) : value;
      }
    }
  std::vector<gpu::MipLevel> mips;
  for (std::size_t size = side;; size /= 2) {
    gpu::MipLevel& mip = mips.emplace_back();
    mip.width = mip.height = static_cast<std::uint32_t>(size);
    for (const glm::vec4& t : level)
      for (int c = 0; c < 4; ++c)
        mip.rgba.push_back(toByte(srgb && c < 3 ? shared::srgbFromLinear(t[c]) : t[c]));
    if (size == 1) return mips;
    const std::size_t half = size / 2;
    std::vector<glm::vec4> coarse(half * half);
    for (std::size_t y = 0; y < half; ++y)
      for (std::size_t x = 0; x < half; ++x)
        coarse[y * half + x] =
            0.25f * (level[2 * y * size + 2 * x] + level[2 * y * size + 2 * x + 1] +
                     level[(2 * y + 1) * size + 2 * x] + level[(2 * y + 1) * size + 2 * x + 1]);
    level = std::move(coarse);
  }
}

PackedImpostor packImpostor(const Impostor& impostor, const std::string& name) {
  PackedImpostor packed;
  const int texels = impostor.texels, side = impostor.views * texels;
  bool good =
      impostor.views >= 2 && texels >= 16 && (texels & (texels - 1)) == 0 && impostor.radius > 0.0f;
  for (const Image* image : {&impostor.color, &impostor.normal, &impostor.light})
    good = good && image->width == side && image->height == side;
  if (!good)
    throw Error(name, "its impostor has other pictures than it says", "make one with makeLevels()");
  packed.views = impostor.views;
  packed.texels = texels;
  packed.sphere = glm::vec4(impostor.center, impostor.radius);
  packed.crown = glm::vec4(impostor.crown_center, impostor.extinction);
  packed.radii = glm::vec4(impostor.crown_radii, 0.0f);
  const auto count = static_cast<std::size_t>(impostor.views * impostor.views);
  for (auto* layers : {&packed.color, &packed.normal, &packed.light}) layers->resize(count);
  parallelFor(count, 1, [&](std::size_t view) {
    const int column = static_cast<int>(view) % impostor.views,
              row = static_cast<int>(view) / impostor.views;
    packed.color[view] = mipsOf(impostor.color, column, row, texels, true);
    packed.normal[view] = mipsOf(impostor.normal, column, row, texels, false);
    packed.light[view] = mipsOf(impostor.light, column, row, texels, false);
  });
  return packed;
}

float leafWidth(const Plant& plant) {
  double area = 0.0;
  for (const Leaf& leaf : plant.leaves) area += leaf.area;
  if (plant.leaves.empty()) return 0.02f * bounds(plant).size().y;
  return static_cast<float>(std::sqrt(area / static_cast<double>(plant.leaves.size())));
}

/// Of shared::mirroredByLeaves(): area of the leaves' shadow from above over that from the side.
float uprightness(const Plant& plant) {
  glm::dvec3 shadow(0.0);
  for (const Mesh& mesh : plant.meshes) {
    if (mesh.kind != PartKind::kFoliage) continue;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const glm::vec3& a = mesh.positions[mesh.indices[i]];
      shadow += glm::dvec3(glm::abs(glm::cross(mesh.positions[mesh.indices[i + 1]] - a,
                                               mesh.positions[mesh.indices[i + 2]] - a)));
    }
  }
  const double aside = 0.5 * (shadow.x + shadow.z);
  return aside > 0.0 ? static_cast<float>(std::clamp(shadow.y / aside, 0.2, 5.0)) : 1.0f;
}

PackedForestKind packKind(const ForestKind& kind) {
  PackedForestKind packed;
  const Plant& plant = *kind.plant;
  packed.box = bounds(plant);
  packed.sphere = glm::vec4(packed.box.center(), 0.5f * glm::length(packed.box.size()));
  const float width = leafWidth(plant);
  packed.grain_m.push_back(width);
  if (kind.levels == nullptr) return packed;
  if (kind.levels->meshes.size() + 1 > shared::kMostForestLevels)
    throw Error(plant.name, fmt::format("has {} coarser levels", kind.levels->meshes.size()),
                fmt::format("make at most {}", shared::kMostForestLevels - 1));
  for (const PlantLevel& level : kind.levels->meshes) {
    if (level.meshes.size() != plant.meshes.size() || level.sources.size() != plant.meshes.size())
      throw Error(plant.name, "its levels belong to another plant", "make them with makeLevels()");
    packed.grain_m.push_back(width * level.leaf_growth);
  }
  packed.impostor = packImpostor(kind.levels->impostor, plant.name);
  packed.impostor.radii.w = uprightness(plant);
  return packed;
}

}  // namespace

PackedForest packForest(const Forest& forest) {
  check(forest);
  PackedForest packed;
  packed.detail = forest.detail;
  for (const ForestKind& kind : forest.kinds) {
    PackedForestKind& added = packed.kinds.emplace_back(packKind(kind));
    added.first_class = packed.classes;
    packed.classes += static_cast<std::uint32_t>(added.grain_m.size()) + 1;
  }
  if (packed.classes > shared::kMostForestClasses)
    throw Error("forest", fmt::format("has {} kinds of plants", forest.kinds.size()),
                fmt::format("use at most {}", shared::kMostForestClasses / 4));

  const std::size_t count = forest.places.size();
  glm::vec2 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
  for (const Placement& place : forest.places) {
    const glm::vec2 p(place.position.x, place.position.z);
    low = glm::min(low, p);
    high = glm::max(high, p);
    packed.largest_scale = std::max(packed.largest_scale, place.scale);
  }
  const glm::vec2 size = glm::max(high - low, glm::vec2(1e-6f));
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order(count);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3& p = forest.places[i].position;
    const glm::vec2 at = (glm::vec2(p.x, p.z) - low) / size * 1048575.0f;
    order[i] = {curvePlace(static_cast<std::uint32_t>(at.x), static_cast<std::uint32_t>(at.y)),
                static_cast<std::uint32_t>(i)};
  }
  std::sort(order.begin(), order.end());
  packed.places.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    std::memcpy(&packed.places[i], &forest.places[order[i].second], sizeof(Placement));

  for (std::size_t first = 0; first < count; first += shared::kForestGroup) {
    const std::size_t end = std::min<std::size_t>(first + shared::kForestGroup, count);
    Bounds box{glm::vec3(std::numeric_limits<float>::max()),
               glm::vec3(std::numeric_limits<float>::lowest())};
    for (std::size_t i = first; i < end; ++i) {
      const shared::ForestPlace& p = packed.places[i];
      box.min = glm::min(box.min, {p.x, p.y, p.z});
      box.max = glm::max(box.max, {p.x, p.y, p.z});
    }
    packed.clusters.emplace_back(box.center(), 0.5f * glm::length(box.size()));
  }
  return packed;
}

float distanceOfNearest(const PackedForest& forest, const glm::vec3& eye, std::uint32_t most) {
  if (forest.places.size() <= most) return std::numeric_limits<float>::max();
  std::vector<float> distances(forest.places.size());
  parallelFor(distances.size(), 1 << 14, [&](std::size_t i) {
    const shared::ForestPlace& place = forest.places[i];
    distances[i] = glm::length(glm::vec3(place.x, place.y, place.z) - eye);
  });
  std::nth_element(distances.begin(), distances.begin() + most, distances.end());
  return distances[most];
}

glm::vec4 levelReach(const PackedForestKind& kind, float pixels_per_m, float detail) {
  constexpr float kEverywhere = 1e30f;
  glm::vec4 reach(kEverywhere);
  if (kind.impostor.views == 0) return reach;
  const float texel_m = 2.0f * kind.impostor.sphere.w / static_cast<float>(kind.impostor.texels);
  const float last = detail * pixels_per_m * texel_m / kImpostorPixels;
  reach = glm::vec4(last);
  for (std::size_t i = 1; i < kind.grain_m.size(); ++i)
    reach[static_cast<int>(i) - 1] =
        std::min(detail * pixels_per_m * kind.grain_m[i] / kGrainPixels, last);
  return reach;
}

}  // namespace verdure
