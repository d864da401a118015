#include "render/grass_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "motion/motion_tables.h"
#include "render/fullscreen.h"
#include "render/look.h"
#include "scene/camera.h"
#include "scene/terrain_levels.h"

namespace verdure {
namespace {

constexpr std::uint32_t kGrassVertex[] = {
#include "shaders/terrain.vert.inc"
};
constexpr std::uint32_t kGrassFragment[] = {
#include "shaders/grass_pass.frag.inc"
};
constexpr std::uint32_t kVelocity[] = {
#include "shaders/terrain_velocity.frag.inc"
};
constexpr std::uint32_t kDepthRangeFragment[] = {
#include "shaders/depth_range.frag.inc"
};
constexpr vk::Format kRangeFormat = vk::Format::eR32G32Sfloat;

/// Floor of x / step, and what is left.
std::pair<std::int64_t, double> cellOf(double x, double step) {
  const double cell = std::floor(x / step);
  return {static_cast<std::int64_t>(cell), x - cell * step};
}

TerrainLevels levelsOf(const Terrain& terrain, const glm::vec2& range, float radius) {
  TerrainLevels levels;
  levels.finest_m = std::max(std::min(terrain.spacing_m.x, terrain.spacing_m.y), 0.5f);
  levels.cells = static_cast<int>(kTerrainCells);
  levels.radius_m = std::min(radius, 0x1p19f * levels.finest_m);
  levels.heights = range;
  return levels;
}

/// Plain white and flat stand in where there is no grass.
std::vector<std::vector<gpu::MipLevel>> plainLayers() {
  return {{gpu::MipLevel{1, 1, {255, 255, 255, 255}}}, {gpu::MipLevel{1, 1, {255, 255, 255, 255}}}};
}

}  // namespace

GpuTerrain::GpuTerrain(const gpu::Device& device, PackedTerrain packed,
                       const gpu::SetLayout& layout)
    : terrain_(std::move(packed.terrain)), range_(heightRange(terrain_)) {
  level_ = range_.x == range_.y;
  // Shells rise above the ground, by more where that is curved: terrain.vert.
  for (const PackedGrass& layer : packed.layers)
    range_.y = std::max(range_.y, heightRange(terrain_).y + 2.0f * layer.uniforms.shell.x);
  constexpr auto kStorage = vk::BufferUsageFlagBits::eStorageBuffer;
  gpu::Upload upload(device);
  heights_ = upload.buffer(std::span<const float>(terrain_.heights), kStorage);
  const auto sampler = [&device](vk::SamplerAddressMode upwards) {
    return device.raii().createSampler({.magFilter = vk::Filter::eLinear,
                                        .minFilter = vk::Filter::eLinear,
                                        .mipmapMode = vk::SamplerMipmapMode::eLinear,
                                        .addressModeU = vk::SamplerAddressMode::eRepeat,
                                        .addressModeV = upwards,
                                        .maxLod = VK_LOD_CLAMP_NONE});
  };
  samplers_.push_back(sampler(vk::SamplerAddressMode::eClampToEdge));
  samplers_.push_back(sampler(vk::SamplerAddressMode::eRepeat));
  const bool bare = packed.layers.empty();
  if (bare) {
    PackedGrass& none = packed.layers.emplace_back();
    none.slice_colors = none.slice_data = none.ground_colors = none.ground_data = none.far_colors =
        plainLayers();
    none.cover = CoverMap{1, 1, glm::vec2(0.0f), glm::vec2(1.0f), {1.0f}};
  }
  for (PackedGrass& source : packed.layers) {
    Layer& layer = layers_.emplace_back();
    layer.grass = !bare;
    const vk::Format srgb = vk::Format::eR8G8B8A8Srgb, linear = vk::Format::eR8G8B8A8Unorm;
    layer.slice_colors = upload.textureArray(source.slice_colors, srgb);
    layer.slice_data = upload.textureArray(source.slice_data, linear);
    layer.ground_colors = upload.textureArray(source.ground_colors, srgb);
    layer.ground_data = upload.textureArray(source.ground_data, linear);
    layer.far_colors = upload.textureArray(source.far_colors, srgb);
    layer.cover = upload.buffer(std::span<const float>(source.cover.values), kStorage);
    layer.uniforms =
        gpu::makeBuffer(device, sizeof(shared::GrassUniforms),
                        vk::BufferUsageFlagBits::eUniformBuffer, gpu::MemoryUse::kToGpu);
    for (auto* pictures : {&source.slice_colors, &source.slice_data, &source.ground_colors,
                           &source.ground_data, &source.far_colors})
      pictures->clear();
    layer.packed = std::move(source);
  }
  upload.finish();
  // An upload leaves buffers as vertex input.
  device.submit([&](const vk::raii::CommandBuffer& commands) {
    const auto readable = [&commands](const gpu::Buffer& buffer) {
      for (const gpu::Use use :
           {gpu::Use::kVertexStorage, gpu::Use::kFragmentStorage, gpu::Use::kComputeStorage})
        gpu::bufferBarrier(commands, *buffer.buffer, gpu::Use::kTransferTarget, use);
    };
    readable(heights_);
    for (const Layer& layer : layers_) readable(layer.cover);
  });
  for (Layer& layer : layers_) {
    layer.set.emplace(device, layout);
    layer.set->setBuffer(0, layer.uniforms);
    layer.set->setTexture(1, *layer.slice_colors, *samplers_[0]);
    layer.set->setTexture(2, *layer.slice_data, *samplers_[0]);
    layer.set->setTexture(3, *layer.ground_colors, *samplers_[1]);
    layer.set->setTexture(4, *layer.ground_data, *samplers_[1]);
    layer.set->setBuffer(5, heights_);
    layer.set->setBuffer(6, layer.cover);
    layer.set->setTexture(8, *layer.far_colors, *samplers_[0]);
  }
}

GrassPass::GrassPass(const gpu::Device& device, vk::DescriptorSetLayout frame_set)
    : device_(&device),
      set_layout_(
          device,
          {vk::DescriptorType::eUniformBuffer, vk::DescriptorType::eCombinedImageSampler,
           vk::DescriptorType::eCombinedImageSampler, vk::DescriptorType::eCombinedImageSampler,
           vk::DescriptorType::eCombinedImageSampler, vk::DescriptorType::eStorageBuffer,
           vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eCombinedImageSampler,
           vk::DescriptorType::eCombinedImageSampler},
          vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment |
              vk::ShaderStageFlagBits::eCompute),
      depth_layout_(device, {vk::DescriptorType::eCombinedImageSampler},
                    vk::ShaderStageFlagBits::eFragment),
      layout_(gpu::makePipelineLayout(device, std::array{frame_set, *set_layout_.layout})),
      depth_pipeline_layout_(gpu::makePipelineLayout(device, std::array{*depth_layout_.layout})),
      depth_pipeline_(makeFullscreenPipeline(device, kDepthRangeFragment, *depth_pipeline_layout_,
                                             kRangeFormat)),
      depth_set_(device, depth_layout_),
      nearest_(
          gpu::makeSampler(device, vk::Filter::eNearest, vk::SamplerAddressMode::eClampToEdge)) {}

gpu::Constants GrassPass::constantsOf(const GpuTerrain& terrain, std::size_t layer,
                                      const Terms& terms, const DrawKind& kind,
                                      bool from_eye) const {
  DrawKind grass = kind;
  grass.transmission = terms.transmission;
  gpu::Constants constants = termConstants(terms, grass);
  constants.insert(constants.end(), {terrain.layers_[layer].grass, layer == 0, kTerrainCells,
                                     terrain.layers_[layer].packed.medium, from_eye});
  return constants;
}

void GrassPass::prepare(GpuTerrain& terrain, const View& view, const gpu::Texture& depth,
                        bool new_depth, const DrawKind& kind, float radius) {
  if (new_depth || !range_) {
    using Usage = vk::ImageUsageFlagBits;
    range_.reset();
    range_ = gpu::makeTexture(*device_, {.format = kRangeFormat,
                                         .width = depth.request.width,
                                         .height = depth.request.height,
                                         .usage = Usage::eColorAttachment | Usage::eSampled});
    depth_set_.setTexture(0, depth, *nearest_);
  }
  const float aspect = static_cast<float>(view.width) / static_cast<float>(view.height);
  const TerrainLevels levels = levelsOf(terrain.terrain_, terrain.range_, radius);
  // At least one for each vertex: the validation layer takes as many for read, although these are
  // instances.
  if (terrain.nodes_.size == 0)
    terrain.nodes_ = gpu::makeBuffer(
        *device_,
        std::max<std::size_t>(mostTerrainNodes(levels), 6 * kTerrainCells * kTerrainCells) *
            sizeof(shared::TerrainNode),
        vk::BufferUsageFlagBits::eVertexBuffer, gpu::MemoryUse::kToGpu);
  std::vector<shared::TerrainNode> nodes =
      selectTerrainNodes(levels, view.camera.eye, clipFromWorld(view.camera, aspect));
  const std::size_t room = terrain.nodes_.size / sizeof(shared::TerrainNode);
  if (nodes.size() > room)  // another radius
    terrain.nodes_ =
        gpu::makeBuffer(*device_, nodes.size() * sizeof(shared::TerrainNode),
                        vk::BufferUsageFlagBits::eVertexBuffer, gpu::MemoryUse::kToGpu);
  std::memcpy(terrain.nodes_.memory.mapped(), nodes.data(),
              nodes.size() * sizeof(shared::TerrainNode));
  nodes_ = static_cast<std::uint32_t>(nodes.size());

  const glm::vec3& eye = view.camera.eye;
  const glm::vec2 eye_place(eye.x, eye.z);
  const float ground = terrain.terrain_.heightAt(eye_place);
  for (std::size_t i = 0; i < terrain.layers_.size(); ++i) {
    GpuTerrain::Layer& layer = terrain.layers_[i];
    layer.set->setTexture(7, *range_, *nearest_);
    shared::GrassUniforms u = layer.packed.uniforms;
    const Terrain& t = terrain.terrain_;
    u.terrain = glm::vec4(t.corner - eye_place, t.spacing_m);
    layer.holds_eye = layer.grass && eye.y > ground && eye.y < ground + u.placing.y;
    u.terrain_size = glm::vec4(t.width, t.height, layer.holds_eye, layer.packed.ends_at_depth);
    u.terrain_range = glm::vec4(terrain.range_, eye.y, terrain.level_);
    const CoverMap& cover = layer.packed.cover;
    u.cover =
        glm::vec4(cover.corner - eye_place, glm::vec2(cover.width, cover.height) / cover.size_m);
    if (layer.grass) {
      u.texels.w =
          2.0f * std::tan(0.5f * view.camera.vertical_fov) / static_cast<float>(view.height);
      const glm::dvec4 rows(u.rows);
      const double at_u = rows.x * double{eye.x} + rows.y * double{eye.z};
      const double at_v = rows.z * double{eye.x} + rows.w * double{eye.z};
      const auto [plane_u, past_u] = cellOf(at_u, double{u.shell.y});
      const auto [plane_v, past_v] = cellOf(at_v, double{u.shell.z});
      const auto [tile_u, past_tile_u] = cellOf(at_u, double{u.shell.w});
      const auto [tile_v, past_tile_v] = cellOf(at_v, double{u.shell.w});
      u.eye = glm::vec4(past_u, past_v, past_tile_u, past_tile_v);
      u.eye_cell =
          glm::uvec4(static_cast<std::uint32_t>(plane_u), static_cast<std::uint32_t>(plane_v),
                     static_cast<std::uint32_t>(tile_u), static_cast<std::uint32_t>(tile_v));
      u.moment = momentOf(view.wind, view.seconds, shared::kWindNoise_m);
      const shared::MotionMoment ripples = momentOf(view.wind, view.seconds, shared::kWindRipple_m);
      u.scroll = glm::vec4(u.moment.drift.x, u.moment.drift.y, ripples.drift.x, ripples.drift.y);
    }
    std::memcpy(layer.uniforms.memory.mapped(), &u, sizeof(u));
    addPipeline(constantsOf(terrain, i, view.terms, kind, false));
    if (layer.holds_eye) addPipeline(constantsOf(terrain, i, view.terms, kind, true));
  }
}

gpu::GraphicsRequest GrassPass::requestOf(gpu::SpirV fragment,
                                          const gpu::Constants& constants) const {
  return {
      .vertex = kGrassVertex,
      .fragment = fragment,
      .constants = constants,
      .layout = *layout_,
      .bindings = {{.binding = 0,
                    .stride = sizeof(shared::TerrainNode),
                    .inputRate = vk::VertexInputRate::eInstance}},
      .attributes = {{.location = 0, .binding = 0, .format = vk::Format::eR32G32B32A32Sfloat},
                     {.location = 1, .binding = 0, .format = vk::Format::eR32Sfloat, .offset = 16}},
      .depth = FrameLayout::kDepth};
}

void GrassPass::addPipeline(const gpu::Constants& constants) {
  if (pipelines_.contains(constants)) return;
  gpu::GraphicsRequest request = requestOf(kGrassFragment, constants);
  request.color = FrameLayout::kColor;
  request.samples = FrameLayout::kSamples;
  request.blend = gpu::Blend::kOver;
  pipelines_.emplace(constants, gpu::makeGraphicsPipeline(*device_, request));
}

void GrassPass::prepareVelocity(const GpuTerrain& terrain, vk::Format format) {
  const gpu::Constants constants = constantsOf(terrain, 0, {}, {}, false);
  if (velocity_.contains(constants)) return;
  gpu::GraphicsRequest request = requestOf(kVelocity, constants);
  request.color = format;
  velocity_.emplace(constants, gpu::makeGraphicsPipeline(*device_, request));
}

void GrassPass::recordVelocity(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frame_set,
                               const GpuTerrain& terrain) const {
  commands.bindVertexBuffers(0, {*terrain.nodes_.buffer}, {0});
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics,
                        *velocity_.at(constantsOf(terrain, 0, {}, {}, false)));
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout_, 0,
                              {frame_set, **terrain.layers_[0].set}, nullptr);
  commands.draw(6 * kTerrainCells * kTerrainCells, nodes_, 0, 0);
}

void GrassPass::recordDepthRange(const vk::raii::CommandBuffer& commands,
                                 const gpu::Texture& depth) const {
  const vk::ImageAspectFlags aspect = vk::ImageAspectFlagBits::eDepth;
  const vk::ImageAspectFlags color = vk::ImageAspectFlagBits::eColor;
  gpu::imageBarrier(commands, *depth.image, aspect, gpu::Use::kDepthAttachment,
                    gpu::Use::kFragmentSampled);
  gpu::imageBarrier(commands, *range_->image, color, gpu::Use::kUndefined,
                    gpu::Use::kColorAttachment);
  drawFullscreen(commands, *range_->view, {range_->request.width, range_->request.height},
                 depth_pipeline_, *depth_pipeline_layout_, *depth_set_);
  gpu::imageBarrier(commands, *range_->image, color, gpu::Use::kColorAttachment,
                    gpu::Use::kFragmentSampled);
  gpu::imageBarrier(commands, *depth.image, aspect, gpu::Use::kFragmentSampled,
                    gpu::Use::kDepthAttachment);
}

void GrassPass::record(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frame_set,
                       const GpuTerrain& terrain, const Terms& terms, const DrawKind& kind) const {
  commands.bindVertexBuffers(0, {*terrain.nodes_.buffer}, {0});
  for (std::size_t i = 0; i < terrain.layers_.size(); ++i) {
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics,
                          *pipelines_.at(constantsOf(terrain, i, terms, kind, false)));
    commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout_, 0,
                                {frame_set, **terrain.layers_[i].set}, nullptr);
    commands.draw(6 * kTerrainCells * kTerrainCells, nodes_, 0, 0);
    if (!terrain.layers_[i].holds_eye) continue;
    // The shell's upper side is not seen by rays that go down from within it.
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics,
                          *pipelines_.at(constantsOf(terrain, i, terms, kind, true)));
    commands.draw(6 * kTerrainCells * kTerrainCells, nodes_, 0, 0);
  }
}

}  // namespace verdure
