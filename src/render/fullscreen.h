#ifndef VERDURE_RENDER_FULLSCREEN_H_
#define VERDURE_RENDER_FULLSCREEN_H_

#include "gpu/descriptors.h"
#include "gpu/pipeline.h"

namespace verdure {

/// A pipeline that runs a fragment shader once for each pixel of a target.
vk::raii::Pipeline makeFullscreenPipeline(const gpu::Device& device, gpu::SpirV fragment,
                                          vk::PipelineLayout layout, vk::Format target,
                                          const gpu::Constants& constants = {});

/// Fills `target` and leaves it as kColorAttachment; push constants are the caller's.
void drawFullscreen(const vk::raii::CommandBuffer& commands, const gpu::Texture& target,
                    const vk::raii::Pipeline& pipeline, vk::PipelineLayout layout,
                    vk::DescriptorSet set);

/// The same of one layer; its image must be kColorAttachment.
void drawFullscreen(const vk::raii::CommandBuffer& commands, vk::ImageView target,
                    vk::Extent2D size, const vk::raii::Pipeline& pipeline,
                    vk::PipelineLayout layout, vk::DescriptorSet set);

}  // namespace verdure

#endif  // VERDURE_RENDER_FULLSCREEN_H_
