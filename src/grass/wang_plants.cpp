#include "grass/wang_plants.h"

#include <cmath>

#include "base/parallel.h"
#include "base/random.h"
#include "shared/grass.h"

namespace verdure {
namespace {

/// Plants drawn uniformly over [0, width) x [0, depth) that `stays(root, extent)` lets stand;
/// `stays` may move the root.
template <class Stays>
std::vector<DrawnRibbon> scatter(const Planting& planting, std::uint64_t list, float width,
                                 float depth, const Stays& stays) {
  std::vector<DrawnRibbon> all, one;
  for (std::size_t kind = 0; kind < planting.plants.size(); ++kind) {
    const std::vector<shared::GrassRibbonPart> parts = ribbonParts(planting.plants[kind]);
    Random random(hash(planting.seed ^ hash(list)), hash(kind));
    const float expected = planting.plants[kind].per_m2 * planting.density * width * depth;
    const int count = static_cast<int>(std::floor(expected + random.uniform()));
    for (int i = 0; i < count; ++i) {
      glm::vec3 root(random.uniform(0.0f, width), 0.0f, random.uniform(0.0f, depth));
      one.clear();
      appendRibbons(parts, random.next(), one);
      RibbonExtent extent;
      for (const DrawnRibbon& r : one) extend(extent, r.ribbon);
      if (!stays(root, extent)) continue;
      for (DrawnRibbon& r : one) {
        r.ribbon.root += root;
        all.push_back(r);
      }
    }
  }
  return all;
}

void appendMoved(const std::vector<DrawnRibbon>& from, const glm::vec3& offset,
                 std::vector<DrawnRibbon>& to) {
  for (DrawnRibbon r : from) {
    r.ribbon.root += offset;
    to.push_back(r);
  }
}

/// Whether a plant at x in [0, tile) stays clear of both borders.
bool within(float x, float reach, float tile) {
  return x >= reach && tile - x >= reach;
}

/// Whether a plant at x in [0, tile) crosses a border in the tile's middle; moves x to be relative
/// to that.
bool crosses(float& x, float reach, float tile) {
  x -= 0.5f * tile;
  return std::abs(x) < reach;
}

}  // namespace

StripPlants plantStrip(const Planting& planting, float depth_m) {
  const float tile = planting.tile_m;
  StripPlants strip;
  strip.tile_m = tile;
  for (std::size_t i = 0; i < strip.tiles.size(); ++i)
    strip.tiles[i] =
        scatter(planting, i, tile, depth_m,
                [&](glm::vec3& root, const RibbonExtent& e) { return within(root.x, e.x, tile); });
  for (std::size_t i = 0; i < strip.borders.size(); ++i)
    strip.borders[i] =
        scatter(planting, 4 + i, tile, depth_m,
                [&](glm::vec3& root, const RibbonExtent& e) { return crosses(root.x, e.x, tile); });
  return strip;
}

std::vector<DrawnRibbon> plantsOfStrip(const StripPlants& strip,
                                       const std::vector<std::uint32_t>& borders, bool ends) {
  std::vector<DrawnRibbon> all;
  for (std::size_t i = 0; i < borders.size(); ++i) {
    const glm::vec3 offset(static_cast<float>(i) * strip.tile_m, 0.0f, 0.0f);
    if (ends || i + 1 < borders.size()) appendMoved(strip.borders[borders[i]], offset, all);
    if (i + 1 < borders.size())
      appendMoved(strip.tiles[shared::wangColumn(borders[i], borders[i + 1])], offset, all);
  }
  return all;
}

std::vector<DrawnRibbon> plantSquare(const Planting& planting) {
  const float tile = planting.tile_m;
  // 16 tiles, 2 borders between columns, 2 between rows, 1 corner.
  std::array<std::vector<DrawnRibbon>, 21> lists;
  parallelFor(lists.size(), 1, [&](std::size_t i) {
    const bool column_border = i == 16 || i == 17 || i == 20;
    const bool row_border = i >= 18;
    lists[i] = scatter(planting, 100 + i, tile, tile, [&](glm::vec3& root, const RibbonExtent& e) {
      const bool x = column_border ? crosses(root.x, e.x, tile) : within(root.x, e.x, tile);
      const bool z = row_border ? crosses(root.z, e.z, tile) : within(root.z, e.z, tile);
      return x && z;
    });
  });
  std::vector<DrawnRibbon> all;
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 4; ++i) {
      const glm::vec3 offset(static_cast<float>(i) * tile, 0.0f, static_cast<float>(j) * tile);
      appendMoved(lists[4 * j + i], offset, all);
      appendMoved(lists[16 + kWangBorders[i]], offset, all);
      appendMoved(lists[18 + kWangBorders[j]], offset, all);
      appendMoved(lists[20], offset, all);
    }
  return all;
}

}  // namespace verdure
