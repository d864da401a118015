#include "scene/terrain_levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace verdure {
namespace {

using shared::TerrainNode;

/// The planes left, right, below, above and behind of a picture; inside, dot with (p, 1) is >= 0.
std::array<glm::vec4, 5> sidePlanes(const glm::mat4& clip_from_world) {
  const glm::mat4 rows = glm::transpose(clip_from_world);
  return {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1], rows[3]};
}

class NodeSelection {
 public:
  NodeSelection(const TerrainLevels& levels, const glm::vec3& eye, const glm::mat4& clip_from_world)
      : levels_(levels),
        eye_(eye),
        planes_(sidePlanes(clip_from_world)),
        finest_side_(finestCell(levels) * static_cast<float>(levels.cells)),
        coarsest_(coarsestLevel(levels)) {}

  static float finestCell(const TerrainLevels& levels) {
    return std::exp2(std::floor(std::log2(levels.finest_m)));
  }

  /// The first level that reaches as far as is drawn.
  static int coarsestLevel(const TerrainLevels& levels) {
    float reach = kNodeReach * finestCell(levels) * static_cast<float>(levels.cells);
    int level = 0;
    for (; reach < levels.radius_m; reach *= 2.0f) ++level;
    return level;
  }

  std::vector<TerrainNode> select() {
    // The root is made of four squares of one level, the nearest lattice point in their middle. A
    // side of twice the radius lets them cover it wherever the eye is.
    int level = coarsest_;
    while (sideOf(level) < 2.0f * levels_.radius_m) ++level;
    const float side = sideOf(level);
    const glm::vec2 middle = side * glm::round(glm::vec2(eye_.x, eye_.z) / side);
    visit(middle - side, level + 1);
    return std::move(nodes_);
  }

 private:
  float sideOf(int level) const { return std::ldexp(finest_side_, level); }

  /// A node and what it consists of, farthest first.
  void visit(const glm::vec2& corner, int level) {
    const float side = sideOf(level);
    const float aside = distanceAside(corner, side);
    if (aside >= levels_.radius_m || !isInPicture(corner, side)) return;
    const float over = std::max(levels_.heights.x - eye_.y, eye_.y - levels_.heights.y);
    const bool split =
        level > coarsest_ || (level > 0 && std::max(aside, over) < kNodeReach * sideOf(level - 1));
    if (!split) {
      nodes_.push_back(nodeAt(corner, level));
      return;
    }
    // The half without the eye is behind the half with it: no ray from the eye comes back.
    const float half = 0.5f * side;
    const float far_x = eye_.x < corner.x + half ? half : 0.0f;
    const float far_z = eye_.z < corner.y + half ? half : 0.0f;
    for (const float x : {far_x, half - far_x})
      for (const float z : {far_z, half - far_z}) visit(corner + glm::vec2(x, z), level - 1);
  }

  /// The least terrainDistance() over a node, without heights.
  float distanceAside(const glm::vec2& corner, float side) const {
    const glm::vec2 eye(eye_.x, eye_.z);
    const glm::vec2 outside = glm::max(corner - eye, eye - (corner + side));
    return std::max({outside.x, outside.y, 0.0f});
  }

  /// Whether a node's box is inside of each plane at least in part.
  bool isInPicture(const glm::vec2& corner, float side) const {
    const glm::vec3 low(corner.x, levels_.heights.x, corner.y);
    const glm::vec3 high(corner.x + side, levels_.heights.y, corner.y + side);
    return std::ranges::all_of(planes_, [&](const glm::vec4& plane) {
      const glm::vec3 innermost =
          glm::mix(low, high, glm::greaterThanEqual(glm::vec3(plane), glm::vec3(0.0f)));
      return glm::dot(glm::vec3(plane), innermost) + plane.w >= 0.0f;
    });
  }

  /// Neighbours of a finer node must not slide where they meet: those places are at most the finer
  /// level's reach and a node's side away. Its own vertices must be at their ends where they meet a
  /// coarser node: at its reach or beyond. A cell's width on both sides keeps rounding out of it.
  TerrainNode nodeAt(const glm::vec2& corner, int level) const {
    const float side = sideOf(level), cell = side / static_cast<float>(levels_.cells);
    if (level == coarsest_) {
      const float never = std::numeric_limits<float>::max();
      return {corner, cell, never, never};
    }
    return {corner, cell, (0.5f * kNodeReach + 1.0f) * side + 0.5f * cell,
            kNodeReach * side - 0.5f * cell};
  }

  const TerrainLevels& levels_;
  const glm::vec3 eye_;
  const std::array<glm::vec4, 5> planes_;
  const float finest_side_;
  const int coarsest_;
  std::vector<TerrainNode> nodes_;
};

}  // namespace

std::vector<TerrainNode> selectTerrainNodes(const TerrainLevels& levels, const glm::vec3& eye,
                                            const glm::mat4& clip_from_world) {
  return NodeSelection(levels, eye, clip_from_world).select();
}

std::size_t mostTerrainNodes(const TerrainLevels& levels) {
  // Nodes of a level are quarters of the next level's that are nearer than its own reach: a square
  // of so many of their sides, and one more that it cuts. Of the coarsest, those that the drawn
  // square cuts, which is smaller than its reach.
  constexpr std::size_t kSplit = (kNodeReach + 1) * (kNodeReach + 1);
  return 4 * kSplit * static_cast<std::size_t>(NodeSelection::coarsestLevel(levels) + 1);
}

glm::vec2 heightRange(const Terrain& terrain) {
  const auto [low, high] = std::ranges::minmax(terrain.heights);
  return {low, high};
}

glm::vec2 terrainSlope(const Terrain& terrain, int x, int z) {
  const auto height = [&terrain](int i, int j) {
    return terrain.heights[static_cast<std::size_t>(j) * static_cast<std::size_t>(terrain.width) +
                           static_cast<std::size_t>(i)];
  };
  const int left = std::max(x - 1, 0), right = std::min(x + 1, terrain.width - 1);
  const int back = std::max(z - 1, 0), front = std::min(z + 1, terrain.height - 1);
  return {(height(right, z) - height(left, z)) /
              (static_cast<float>(right - left) * terrain.spacing_m.x),
          (height(x, front) - height(x, back)) /
              (static_cast<float>(front - back) * terrain.spacing_m.y)};
}

std::vector<glm::vec2> terrainSlopes(const Terrain& terrain) {
  const auto width = static_cast<std::size_t>(terrain.width);
  std::vector<glm::vec2> slopes(terrain.heights.size());
  parallelFor(static_cast<std::size_t>(terrain.height), 16, [&](std::size_t z) {
    for (std::size_t x = 0; x < width; ++x)
      slopes[z * width + x] = terrainSlope(terrain, static_cast<int>(x), static_cast<int>(z));
  });
  return slopes;
}

}  // namespace verdure
