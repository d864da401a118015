#include "render/inspect_pass.h"

#include "shared/tone.h"

namespace verdure {
namespace {

constexpr std::uint32_t kInspectVertex[] = {
#include "shaders/inspect_pass.vert.inc"
};
constexpr std::uint32_t kInspectFragment[] = {
#include "shaders/inspect_pass.frag.inc"
};

std::pair<bool, gpu::Constants> keyOf(const Draw& draw, const Terms& terms, Inspection what) {
  const bool leaf_normals = terms.normal == NormalSource::kLeaf || !draw.baked;
  gpu::Constants constants = termConstants(terms, {.flip_normal = draw.foliage && leaf_normals,
                                                   .alpha_test = draw.alpha_test,
                                                   .foliage = draw.foliage,
                                                   .moving = draw.moving,
                                                   .forest = draw.forest.has_value()});
  constants.push_back(static_cast<std::uint32_t>(what));
  return {draw.transfer, constants};
}

}  // namespace

void InspectPass::prepare(const gpu::Device& device, const FrameLayout& layout,
                          const GpuScene& scene, const Terms& terms, Inspection what) {
  for (const Draw& draw : scene.draws()) {
    if (!draw.seen) continue;
    auto key = keyOf(draw, terms, what);
    if (pipelines_.contains(key)) continue;
    std::vector<vk::VertexInputAttributeDescription> attributes = GpuScene::attributes();
    std::erase_if(attributes, [](const auto& attribute) {  // no light from transfer vectors
      return attribute.location == 6 || attribute.location == 7;
    });
    vk::raii::Pipeline pipeline =
        gpu::makeGraphicsPipeline(device, {.vertex = kInspectVertex,
                                           .fragment = kInspectFragment,
                                           .constants = key.second,
                                           .layout = *layout.pipeline,
                                           .bindings = GpuScene::bindings(draw.transfer),
                                           .attributes = std::move(attributes),
                                           .color = FrameLayout::kColor,
                                           .depth = FrameLayout::kDepth,
                                           .samples = FrameLayout::kSamples});
    pipelines_.emplace(std::move(key), std::move(pipeline));
  }
}

void InspectPass::record(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
                         vk::DescriptorSet frame_set, const GpuScene& scene, const Terms& terms,
                         Inspection what) const {
  if (scene.draws().empty()) return;
  scene.bindVertices(commands, terms.normal);
  for (const Draw& draw : scene.draws()) {
    if (!draw.seen) continue;
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics,
                          *pipelines_.at(keyOf(draw, terms, what)));
    scene.recordSeen(commands, *layout.pipeline, frame_set, draw);
  }
}

View inspectedView(const View& view, Inspection what) {
  View inspected = view;
  // With a white of 1 the tone curve is the identity; frame units over units are 1.
  inspected.exposure = {.ev = 0.0f, .key = shared::meteredLuminance(0.0f), .white = 1.0f};
  inspected.bloom = 0.0f;
  inspected.background = glm::vec3(0.05f);
  inspected.style = Style::kPhoto;
  if (what == Inspection::kLayers) inspected.terms.shadow_source = ShadowSource::kDepthLayers;
  if (what == Inspection::kBranchLevel && !(inspected.wind.speed > 0.0f))
    inspected.wind.speed = 1e-4f;  // what bends knows its branch
  return inspected;
}

}  // namespace verdure
