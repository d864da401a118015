#ifndef VERDURE_GPU_BARRIER_H_
#define VERDURE_GPU_BARRIER_H_

#include "gpu/vulkan.h"

namespace verdure::gpu {

inline constexpr vk::ImageAspectFlags kColorAspect = vk::ImageAspectFlagBits::eColor;

/// The ways verdure uses images and buffers on the GPU. A barrier between two of them is complete:
/// stages, accesses and layouts all follow from the use.
enum class Use {
  kUndefined,        ///< contents may be lost; nothing is pending (fresh, or behind a fence)
  kTransferTarget,   ///< copied to
  kTransferSource,   ///< copied from
  kColorAttachment,  ///< drawn to, blended or resolved to
  kDepthAttachment,  ///< depth-tested and written
  kFragmentSampled,  ///< sampled in a fragment shader
  kDrawSampled,      ///< sampled in vertex and fragment shaders
  kComputeSampled,   ///< sampled in a compute shader
  kVertexInput,      ///< vertex and index buffer
  kVertexStorage,    ///< storage buffer that a vertex shader reads
  kComputeStorage,   ///< storage buffer of a compute shader, read and written
  kIndirect,         ///< buffer that an indirect draw reads
  kFragmentStorage,  ///< storage buffer that a fragment shader reads
  kHostRead,         ///< read on the CPU after a fence
  kAcquired,         ///< of a swapchain, to be drawn to; its contents may be lost
  kPresented,        ///< of a swapchain, handed to the window
};

struct UseInfo {
  vk::PipelineStageFlags2 stages;
  vk::AccessFlags2 access;
  vk::ImageLayout layout;  ///< eUndefined for uses that only buffers have
};

UseInfo useInfo(Use use);

/// All mips and layers of an image go from one use to another.
void imageBarrier(const vk::raii::CommandBuffer& commands, vk::Image image,
                  vk::ImageAspectFlags aspect, Use from, Use to);

/// A whole buffer goes from one use to another.
void bufferBarrier(const vk::raii::CommandBuffer& commands, vk::Buffer buffer, Use from, Use to);

}  // namespace verdure::gpu

#endif  // VERDURE_GPU_BARRIER_H_
