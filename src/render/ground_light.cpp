#include "render/ground_light.h"

#include <algorithm>
#include <limits>

#include "base/parallel.h"

namespace verdure {
namespace {

/// A grid of light, bilinear between its points.
struct Grid {
  int size = 0;
  std::vector<glm::vec3> light;

  /// `at` in steps from the first point; `open` outside, and towards it near the edge.
  glm::vec3 sample(const glm::vec2& at, const glm::vec3& open) const {
    constexpr float kFade = 0.1f;  // of the grid's side
    const float last = static_cast<float>(size - 1);
    if (!(at.x >= 0.0f && at.y >= 0.0f && at.x <= last && at.y <= last)) return open;
    const glm::vec2 inside =
        glm::smoothstep(glm::vec2(0.0f), glm::vec2(kFade), 0.5f - glm::abs(at / last - 0.5f));
    const glm::ivec2 low = glm::min(glm::ivec2(at), glm::ivec2(std::max(size - 2, 0)));
    const glm::ivec2 high = glm::min(low + 1, glm::ivec2(size - 1));
    const glm::vec2 f = at - glm::vec2(low);
    const auto point = [this](int x, int y) {
      return light[static_cast<std::size_t>(y) * static_cast<std::size_t>(size) +
                   static_cast<std::size_t>(x)];
    };
    const glm::vec3 here =
        glm::mix(glm::mix(point(low.x, low.y), point(high.x, low.y), f.x),
                 glm::mix(point(low.x, high.y), point(high.x, high.y), f.x), f.y);
    return glm::mix(open, here, inside.x * inside.y);
  }
};

Grid evaluate(const PackedGround& ground, const std::vector<glm::vec2>& weights) {
  Grid grid{ground.transfer.size, {}};
  const auto points = static_cast<std::size_t>(grid.size) * static_cast<std::size_t>(grid.size);
  grid.light.resize(points);
  parallelFor(points, 256, [&](std::size_t i) {
    grid.light[i] =
        transferLight(ground.transfer.vectors, ground.bands, ground.bounce_bands, i, weights);
  });
  return grid;
}

}  // namespace

GroundLight::GroundLight(const gpu::Device& device) : map_(device, kMostTexels, kMostTexels) {}

void GroundLight::update(const std::vector<PackedGround>& grounds, int scene_id,
                         const std::vector<glm::vec2>& weights, const glm::vec3& open) {
  if (scene_id == scene_id_ && weights == weights_) return;
  scene_id_ = scene_id;
  weights_ = weights;
  place_ = glm::vec3(0.0f);
  glm::vec2 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
  for (const PackedGround& ground : grounds)
    for (const glm::vec2& place : ground.places) {
      const glm::vec2 corner = place + ground.transfer.corner;
      const float side = ground.transfer.step * static_cast<float>(ground.transfer.size - 1);
      low = glm::min(low, corner);
      high = glm::max(high, corner + side);
    }
  if (low.x >= high.x) return;
  const float side = std::max(high.x - low.x, high.y - low.y);
  place_ = glm::vec3(low, 1.0f / side);

  std::vector<Grid> grids;
  for (const PackedGround& ground : grounds) grids.push_back(evaluate(ground, weights));
  const glm::vec3 safe_open = glm::max(open, glm::vec3(1e-12f));
  parallelFor(kMostTexels, 8, [&](std::size_t row) {
    for (int column = 0; column < kMostTexels; ++column) {
      const glm::vec2 at =
          low + (glm::vec2(column, row) + 0.5f) * (side / static_cast<float>(kMostTexels));
      glm::vec3 light = open;
      for (std::size_t g = 0; g < grids.size(); ++g)
        for (const glm::vec2& place : grounds[g].places) {
          const GroundTransfer& transfer = grounds[g].transfer;
          light *= grids[g].sample((at - place - transfer.corner) / transfer.step, safe_open) /
                   safe_open;
        }
      map_.set(column, static_cast<int>(row), light);
    }
  });
  copied_ = false;
}

void GroundLight::record(const vk::raii::CommandBuffer& commands) {
  if (!copied_) map_.record(commands);
  copied_ = true;
}

}  // namespace verdure
