#include "render/grass_blades.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "grass/plant_ribbons.h"
#include "scene/camera.h"

namespace verdure {
namespace {

constexpr std::uint32_t kChoice[] = {
#include "shaders/grass_blades.comp.inc"
};
constexpr std::uint32_t kGrassBladesVertex[] = {
#include "shaders/grass_blades.vert.inc"
};
constexpr std::uint32_t kGrassBladesFragment[] = {
#include "shaders/grass_blades.frag.inc"
};
constexpr std::uint32_t kGroupSize = 64;  // as in grass_blades.comp
constexpr std::uint32_t kBladeIndices = 6 * shared::kBladeSegments;

gpu::Constants constantsOf(const Terms& terms, const DrawKind& kind) {
  DrawKind grass = kind;
  grass.transmission = terms.transmission;
  return termConstants(terms, grass);
}

std::vector<std::uint16_t> stripIndices() {
  std::vector<std::uint16_t> indices;
  for (std::uint32_t segment = 0; segment < shared::kBladeSegments; ++segment)
    for (const std::uint32_t corner : {0u, 1u, 2u, 2u, 1u, 3u})
      indices.push_back(static_cast<std::uint16_t>(2 * segment + corner));
  return indices;
}

}  // namespace

GrassBlades::GrassBlades(const gpu::Device& device, vk::DescriptorSetLayout frame_set,
                         const gpu::SetLayout& grass_set)
    : device_(&device),
      set_layout_(device,
                  {vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer,
                   vk::DescriptorType::eStorageBuffer},
                  vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eCompute),
      choice_layout_(gpu::makePipelineLayout(
          device, std::array{frame_set, *grass_set.layout, *set_layout_.layout},
          vk::ShaderStageFlagBits::eCompute, sizeof(shared::BladeJob))),
      layout_(gpu::makePipelineLayout(
          device, std::array{frame_set, *grass_set.layout, *set_layout_.layout})),
      choice_(gpu::makeComputePipeline(device, kChoice, *choice_layout_)) {
  gpu::Upload upload(device);
  const std::vector<std::uint16_t> indices = stripIndices();
  indices_ = upload.buffer(std::span(indices), vk::BufferUsageFlagBits::eIndexBuffer);
  upload.finish();
}

void GrassBlades::prepare(const GpuTerrain& terrain, const View& view, const DrawKind& kind) {
  if (layers_.empty()) {
    gpu::Upload upload(*device_);
    for (std::size_t i = 0; i < terrain.layers_.size(); ++i) {
      const PackedGrass& packed = terrain.layers_[i].packed;
      if (!(packed.uniforms.blades.y > 0.0f)) continue;
      Layer& layer = layers_.emplace_back();
      layer.index = i;
      std::vector<shared::GrassRibbonPart> all_parts;
      std::size_t ribbons = 0;
      for (std::size_t k = 0; k < packed.plants.size(); ++k) {
        const GrassPlant& plant = packed.plants[k];
        const std::vector<shared::GrassRibbonPart> parts = ribbonParts(plant);
        shared::BladeJob job{};
        job.cell_m = 1.0f / std::sqrt(plant.per_m2);
        job.cells =
            2 * static_cast<std::uint32_t>(std::ceil(packed.uniforms.blades.y / job.cell_m));
        const PlantBounds reach = plantBounds(plant);
        job.reach_m = std::max(reach.aside_m, reach.height_m);
        job.kind = static_cast<std::uint32_t>(k);
        job.first_part = static_cast<std::uint32_t>(all_parts.size());
        job.parts = static_cast<std::uint32_t>(parts.size());
        for (const shared::GrassRibbonPart& part : parts)
          ribbons += std::size_t{part.kind.z} * job.cells * job.cells;
        layer.jobs.push_back(job);
        all_parts.insert(all_parts.end(), parts.begin(), parts.end());
      }
      constexpr auto kStorage = vk::BufferUsageFlagBits::eStorageBuffer;
      layer.parts = upload.buffer(std::span<const shared::GrassRibbonPart>(all_parts), kStorage);
      layer.blades = gpu::makeBuffer(*device_, ribbons * sizeof(shared::GrassBlade), kStorage,
                                     gpu::MemoryUse::kDevice);
      layer.draw = gpu::makeBuffer(*device_, sizeof(vk::DrawIndexedIndirectCommand),
                                   kStorage | vk::BufferUsageFlagBits::eIndirectBuffer |
                                       vk::BufferUsageFlagBits::eTransferDst,
                                   gpu::MemoryUse::kDevice);
      layer.set.emplace(*device_, set_layout_);
      layer.set->setBuffer(0, layer.parts);
      layer.set->setBuffer(1, layer.blades);
      layer.set->setBuffer(2, layer.draw);
    }
    upload.finish();
  }
  const float aspect = static_cast<float>(view.width) / static_cast<float>(view.height);
  const glm::mat4 clip_from_world = clipFromWorld(view.camera, aspect);
  const glm::vec3& eye = view.camera.eye;
  for (Layer& layer : layers_)
    for (shared::BladeJob& job : layer.jobs) {
      job.clip_from_eye = clip_from_world;
      const glm::dvec2 cell = glm::floor(glm::dvec2(eye.x, eye.z) / double{job.cell_m});
      job.past = glm::vec2(glm::dvec2(eye.x, eye.z) - cell * double{job.cell_m});
      job.eye_cell = glm::uvec2(static_cast<std::uint32_t>(static_cast<std::int64_t>(cell.x)),
                                static_cast<std::uint32_t>(static_cast<std::int64_t>(cell.y)));
    }
  gpu::Constants constants = constantsOf(view.terms, kind);
  if (layers_.empty() || pipelines_.contains(constants)) return;
  vk::raii::Pipeline pipeline =
      gpu::makeGraphicsPipeline(*device_, {.vertex = kGrassBladesVertex,
                                           .fragment = kGrassBladesFragment,
                                           .constants = constants,
                                           .layout = *layout_,
                                           .color = FrameLayout::kColor,
                                           .depth = FrameLayout::kDepth,
                                           .samples = FrameLayout::kSamples});
  pipelines_.emplace(std::move(constants), std::move(pipeline));
}

void GrassBlades::recordChoice(const vk::raii::CommandBuffer& commands,
                               const GpuTerrain& terrain) const {
  for (const Layer& layer : layers_) {
    const vk::DrawIndexedIndirectCommand none{.indexCount = kBladeIndices};
    gpu::bufferBarrier(commands, *layer.draw.buffer, gpu::Use::kIndirect,
                       gpu::Use::kTransferTarget);
    commands.updateBuffer<vk::DrawIndexedIndirectCommand>(*layer.draw.buffer, 0, none);
    gpu::bufferBarrier(commands, *layer.draw.buffer, gpu::Use::kTransferTarget,
                       gpu::Use::kComputeStorage);
    gpu::bufferBarrier(commands, *layer.blades.buffer, gpu::Use::kVertexStorage,
                       gpu::Use::kComputeStorage);
    gpu::bufferBarrier(commands, *layer.parts.buffer, gpu::Use::kVertexInput,
                       gpu::Use::kComputeStorage);
    gpu::bufferBarrier(commands, *layer.parts.buffer, gpu::Use::kVertexInput,
                       gpu::Use::kVertexStorage);
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, *choice_);
    commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *choice_layout_, 1,
                                {**terrain.layers_[layer.index].set, **layer.set}, nullptr);
    for (const shared::BladeJob& job : layer.jobs) {
      commands.pushConstants<shared::BladeJob>(*choice_layout_, vk::ShaderStageFlagBits::eCompute,
                                               0, job);
      commands.dispatch((job.cells * job.cells + kGroupSize - 1) / kGroupSize, 1, 1);
    }
    gpu::bufferBarrier(commands, *layer.blades.buffer, gpu::Use::kComputeStorage,
                       gpu::Use::kVertexStorage);
    gpu::bufferBarrier(commands, *layer.draw.buffer, gpu::Use::kComputeStorage,
                       gpu::Use::kIndirect);
  }
}

void GrassBlades::record(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frame_set,
                         const GpuTerrain& terrain, const Terms& terms,
                         const DrawKind& kind) const {
  if (layers_.empty()) return;
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *pipelines_.at(constantsOf(terms, kind)));
  commands.bindIndexBuffer(*indices_.buffer, 0, vk::IndexType::eUint16);
  for (const Layer& layer : layers_) {
    commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout_, 0,
                                {frame_set, **terrain.layers_[layer.index].set, **layer.set},
                                nullptr);
    commands.drawIndexedIndirect(*layer.draw.buffer, 0, 1, sizeof(vk::DrawIndexedIndirectCommand));
  }
}

}  // namespace verdure
