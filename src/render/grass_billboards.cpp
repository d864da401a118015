#include "render/grass_billboards.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "base/progress.h"
#include "scene/camera.h"

namespace verdure {
namespace {

constexpr std::uint32_t kGrassGroundVertex[] = {
#include "shaders/terrain.vert.inc"
};
constexpr std::uint32_t kGrassGroundFragment[] = {
#include "shaders/grass_ground.frag.inc"
};
constexpr std::uint32_t kGrassBillboardsVertex[] = {
#include "shaders/grass_billboards.vert.inc"
};
constexpr std::uint32_t kGrassBillboardsFragment[] = {
#include "shaders/grass_billboards.frag.inc"
};

/// As in grass_billboards.vert.
struct Billboard {
  std::int32_t plane = 0;
  std::uint32_t axis = 0;
  float begin = 0.0f, end = 0.0f;
};
static_assert(sizeof(Billboard) == 16);

/// Slices one behind the other in a pixel, from which on grass_pass.frag takes them as a medium.
constexpr float kMostInPixel = 1.5f;

/// Where that is, in the mean of all directions, for an eye at a height above level ground, m.
float discreteRadius(const shared::GrassUniforms& u, float eye_height) {
  const float per_metre = 2.0f / glm::pi<float>() * (1.0f / u.shell.y + 1.0f / u.shell.z);
  return std::sqrt(kMostInPixel * std::max(eye_height, 0.1f) / (u.texels.w * per_metre));
}

/// The slices of one layer about the eye.
class Slices {
 public:
  Slices(const shared::GrassUniforms& u, const Terrain& terrain, const Camera& camera, float aspect,
         float radius)
      : u_(u), terrain_(terrain), eye_(camera.eye), radius_(radius) {
    clip_from_world_ = clipFromWorld(camera, aspect);
    for (const int axis : {0, 1}) {
      const int reach = static_cast<int>(std::ceil(radius / spacing(axis))) + 1;
      for (int plane = -reach; plane <= reach; ++plane) {
        const float past = shared::slicePlace(plane, axis == 0 ? u.eye_cell.x : u.eye_cell.y,
                                              u.placing.x, static_cast<std::uint32_t>(axis)) *
                               spacing(axis) -
                           (axis == 0 ? u.eye.x : u.eye.y);
        places_[axis].push_back({plane, past});
        before_[axis] += past < 0.0f ? 1 : 0;
      }
    }
  }

  /// A tile long, by the distances of their middles.
  std::vector<Billboard> ofTiles() const {
    std::vector<std::pair<float, Billboard>> found;
    for (const int axis : {0, 1}) {
      const float tile = u_.shell.w, past_tile = axis == 0 ? u_.eye.w : u_.eye.z;
      for (const auto& [plane, past] : places_[axis]) {
        const float half = std::sqrt(std::max(radius_ * radius_ - past * past, 0.0f));
        const int first = static_cast<int>(std::floor((past_tile - half) / tile));
        const int last = static_cast<int>(std::ceil((past_tile + half) / tile));
        for (int i = first; i < last; ++i) {
          const float begin = static_cast<float>(i) * tile,
                      middle = begin + 0.5f * tile - past_tile;
          const float distance = past * past + middle * middle;
          if (distance > radius_ * radius_) continue;
          const Billboard quad{plane, static_cast<std::uint32_t>(axis), begin, begin + tile};
          if (seen(axis, past, begin - past_tile, begin + tile - past_tile))
            found.push_back({distance, quad});
        }
      }
    }
    std::sort(found.begin(), found.end(),
              [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<Billboard> sorted;
    for (const auto& [distance, quad] : found) sorted.push_back(quad);
    return sorted;
  }

  /// From crossing to crossing. A ray from the eye passes them in the order of how many slices
  /// stand before them.
  std::vector<Billboard> ofCrossings() const {
    std::vector<std::pair<std::size_t, Billboard>> found;
    std::vector<std::uint32_t> starts;
    for (const int axis : {0, 1}) {
      const auto& others = places_[1 - axis];
      const float past_tile = axis == 0 ? u_.eye.w : u_.eye.z;
      for (std::size_t i = 0; i < places_[axis].size(); ++i) {
        const auto& [plane, past] = places_[axis][i];
        for (std::size_t k = 0; k + 1 < others.size(); ++k) {
          const float begin = others[k].second, end = others[k + 1].second;
          const float middle = 0.5f * (begin + end);
          if (past * past + middle * middle > radius_ * radius_ || !seen(axis, past, begin, end))
            continue;
          const std::size_t rank =
              slicesBefore(i, before_[axis]) + gapsBefore(k, before_[1 - axis]);
          found.push_back(
              {rank,
               {plane, static_cast<std::uint32_t>(axis), begin + past_tile, end + past_tile}});
          if (starts.size() < rank + 2) starts.resize(rank + 2, 0);
          ++starts[rank];
        }
      }
    }
    // The largest rank first.
    std::uint32_t start = 0;
    for (std::size_t rank = starts.size(); rank-- > 0;) start += std::exchange(starts[rank], start);
    std::vector<Billboard> sorted(found.size());
    for (const auto& [rank, quad] : found) sorted[starts[rank]++] = quad;
    return sorted;
  }

 private:
  float spacing(int axis) const { return axis == 0 ? u_.shell.y : u_.shell.z; }

  /// Of the slices of an axis, between the eye and number i; `before`: how many are behind it.
  static std::size_t slicesBefore(std::size_t i, std::size_t before) {
    return i < before ? before - 1 - i : i - before;
  }
  /// Between the eye and the gap behind number k.
  static std::size_t gapsBefore(std::size_t k, std::size_t before) {
    return k + 1 < before ? before - 1 - k : k + 1 - before;
  }

  /// Whether the polygon may be in the picture; places across and along, from the eye.
  bool seen(int axis, float across, float begin, float end) const {
    std::array<int, 5> outside{};
    for (const float along : {begin, end}) {
      const glm::vec2 at = axis == 0 ? glm::vec2(across, along) : glm::vec2(along, across);
      const glm::vec2 place =
          at.x * glm::vec2(u_.rows.x, u_.rows.y) + at.y * glm::vec2(u_.rows.z, u_.rows.w);
      const float ground = terrain_.heightAt(place + glm::vec2(eye_.x, eye_.z)) - eye_.y;
      for (const float height : {0.0f, u_.placing.y}) {
        const glm::vec4 clip =
            clip_from_world_ * glm::vec4(place.x, ground + height, place.y, 0.0f);
        outside[0] += clip.x < -clip.w ? 1 : 0;
        outside[1] += clip.x > clip.w ? 1 : 0;
        outside[2] += clip.y < -clip.w ? 1 : 0;
        outside[3] += clip.y > clip.w ? 1 : 0;
        outside[4] += clip.w <= 0.0f ? 1 : 0;
      }
    }
    return std::find(outside.begin(), outside.end(), 4) == outside.end();
  }

  const shared::GrassUniforms& u_;
  const Terrain& terrain_;
  glm::vec3 eye_;
  float radius_;
  glm::mat4 clip_from_world_{1.0f};
  std::array<std::vector<std::pair<int, float>>, 2> places_;  ///< number, place from the eye, m
  std::array<std::size_t, 2> before_{};                       ///< of them, on the eye's lower side
};

}  // namespace

GrassBillboards::GrassBillboards(const gpu::Device& device, vk::DescriptorSetLayout frame_set,
                                 const gpu::SetLayout& grass_set)
    : device_(&device),
      quad_layout_(device, {vk::DescriptorType::eStorageBuffer}, vk::ShaderStageFlagBits::eVertex),
      layout_(gpu::makePipelineLayout(
          device, std::array{frame_set, *grass_set.layout, *quad_layout_.layout})),
      quad_set_(device, quad_layout_) {}

void GrassBillboards::prepare(const GpuTerrain& terrain, const View& view, const DrawKind& kind,
                              const BillboardTrial& trial) {
  const GpuTerrain::Layer& layer = terrain.layers_.at(0);
  shared::GrassUniforms u;
  std::memcpy(&u, layer.uniforms.memory.mapped(), sizeof(u));
  const glm::vec3& eye = view.camera.eye;
  radius_m_ = trial.radius_m > 0.0f
                  ? trial.radius_m
                  : discreteRadius(u, eye.y - terrain.terrain_.heightAt({eye.x, eye.z}));
  const float aspect = static_cast<float>(view.width) / static_cast<float>(view.height);
  const Timer timer;
  const Slices slices(u, terrain.terrain_, view.camera, aspect, radius_m_);
  const std::vector<Billboard> quads = trial.cut ? slices.ofCrossings() : slices.ofTiles();
  sort_ms_ = timer.seconds() * 1e3;
  count_ = static_cast<std::uint32_t>(quads.size());
  const std::size_t bytes = quads.size() * sizeof(Billboard);
  if (quads_.size < std::max<std::size_t>(bytes, 1)) {
    quads_ = gpu::makeBuffer(*device_, bytes, vk::BufferUsageFlagBits::eStorageBuffer,
                             gpu::MemoryUse::kToGpu);
    quad_set_.setBuffer(0, quads_);
  }
  std::memcpy(quads_.memory.mapped(), quads.data(), bytes);

  DrawKind grass = kind;
  grass.transmission = view.terms.transmission;
  gpu::Constants constants = termConstants(view.terms, grass);
  constants.insert(constants.end(), {false, true, kTerrainCells, false});
  auto found = pipelines_.find(constants);
  if (found == pipelines_.end()) {
    gpu::GraphicsRequest ground{
        .vertex = kGrassGroundVertex,
        .fragment = kGrassGroundFragment,
        .constants = constants,
        .layout = *layout_,
        .bindings = {{.binding = 0,
                      .stride = sizeof(shared::TerrainNode),
                      .inputRate = vk::VertexInputRate::eInstance}},
        .attributes =
            {{.location = 0, .binding = 0, .format = vk::Format::eR32G32B32A32Sfloat},
             {.location = 1, .binding = 0, .format = vk::Format::eR32Sfloat, .offset = 16}},
        .color = FrameLayout::kColor,
        .depth = FrameLayout::kDepth,
        .samples = FrameLayout::kSamples};
    gpu::GraphicsRequest slice{.vertex = kGrassBillboardsVertex,
                               .fragment = kGrassBillboardsFragment,
                               .constants = constants,
                               .layout = *layout_,
                               .color = FrameLayout::kColor,
                               .depth = FrameLayout::kDepth,
                               .samples = FrameLayout::kSamples,
                               .depth_write = false,
                               .blend = gpu::Blend::kOver};
    found = pipelines_
                .emplace(constants, std::pair(gpu::makeGraphicsPipeline(*device_, ground),
                                              gpu::makeGraphicsPipeline(*device_, slice)))
                .first;
  }
  drawn_ = &found->second;
}

void GrassBillboards::record(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frame_set,
                             const GpuTerrain& terrain, std::uint32_t nodes) const {
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout_, 0,
                              {frame_set, **terrain.layers_.at(0).set, *quad_set_}, nullptr);
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *drawn_->first);
  commands.bindVertexBuffers(0, {*terrain.nodes_.buffer}, {0});
  commands.draw(6 * kTerrainCells * kTerrainCells, nodes, 0, 0);
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *drawn_->second);
  commands.draw(6 * count_, 1, 0, 0);
}

}  // namespace verdure
