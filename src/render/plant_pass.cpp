#include "render/plant_pass.h"

namespace verdure {
namespace {

constexpr std::uint32_t kPlantVertex[] = {
#include "shaders/plant_pass.vert.inc"
};
constexpr std::uint32_t kPlantFragment[] = {
#include "shaders/plant_pass.frag.inc"
};

gpu::Constants constantsOf(const Draw& draw, const Terms& terms, const DrawKind& kind) {
  // A plant without baked light has its leaf normals in either stream: they are turned over.
  const bool leaf_normals = terms.normal == NormalSource::kLeaf || !draw.baked;
  // Without what the light needs it is lit as well as can be: unbaked, the coefficient is 1.
  const AmbientSource wanted = terms.ambient_source;
  const bool lacking = (wanted == AmbientSource::kTransfer && !draw.transfer) ||
                       (wanted == AmbientSource::kLeafVisibility && !draw.visibility);
  const AmbientSource source = lacking ? AmbientSource::kBaked : wanted;
  return termConstants(terms,
                       {.ambient_source = source,
                        .formula_sky = kind.formula_sky && draw.forest,
                        .background = kind.background && draw.forest,
                        .transmission = draw.foliage && terms.transmission,
                        .flip_normal = draw.foliage && leaf_normals,
                        .alpha_test = draw.alpha_test,
                        .normal_map = draw.normal_map,
                        .foliage = draw.foliage,
                        .scattering = draw.foliage && terms.scattering,
                        .thickness_map = draw.foliage && terms.scattering && draw.thickness_map,
                        .leaf = draw.leaf_maps && terms.textures ? terms.leaf : LeafModel::kColor,
                        .stated_transmission = draw.stated_transmission && terms.textures,
                        .moving = draw.moving,
                        .forest = draw.forest.has_value()});
}

/// Two vertex layouts: see GpuScene::bindings().
std::pair<bool, gpu::Constants> keyOf(const Draw& draw, const Terms& terms, const DrawKind& kind) {
  return {draw.transfer, constantsOf(draw, terms, kind)};
}

}  // namespace

void PlantPass::prepare(const gpu::Device& device, const FrameLayout& layout, const GpuScene& scene,
                        const Terms& terms, const DrawKind& kind) {
  for (const Draw& draw : scene.draws()) {
    if (!draw.seen) continue;
    auto key = keyOf(draw, terms, kind);
    if (pipelines_.contains(key)) continue;
    vk::raii::Pipeline pipeline =
        gpu::makeGraphicsPipeline(device, {.vertex = kPlantVertex,
                                           .fragment = kPlantFragment,
                                           .constants = key.second,
                                           .layout = *layout.pipeline,
                                           .bindings = GpuScene::bindings(draw.transfer),
                                           .attributes = GpuScene::attributes(),
                                           .color = FrameLayout::kColor,
                                           .depth = FrameLayout::kDepth,
                                           .samples = FrameLayout::kSamples});
    pipelines_.emplace(std::move(key), std::move(pipeline));
  }
}

void PlantPass::record(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
                       vk::DescriptorSet frame_set, const GpuScene& scene, const Terms& terms,
                       const DrawKind& kind, bool behind) const {
  if (scene.draws().empty()) return;
  scene.bindVertices(commands, terms.normal);
  for (const Draw& draw : scene.draws()) {
    if (!draw.seen || (behind && !draw.forest)) continue;
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics,
                          *pipelines_.at(keyOf(draw, terms, kind)));
    scene.record(commands, *layout.pipeline, frame_set, draw,
                 behind ? GpuForest::kBehind : GpuForest::kPicture);
  }
}

}  // namespace verdure
