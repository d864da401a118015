#ifndef VERDURE_APP_VIEW_GUI_PASS_H_
#define VERDURE_APP_VIEW_GUI_PASS_H_

#include <imgui.h>

#include <memory>

#include "gpu/descriptors.h"
#include "gpu/pipeline.h"
#include "gpu/swapchain.h"

namespace verdure::app {

/// A picture that the panels may show: its address is its ImTextureID.
struct GuiTexture {
  gpu::Texture texture;  ///< in use kFragmentSampled when panels are drawn
  gpu::DescriptorSet set;
};

/// Draws what Dear ImGui asks for, with dynamic rendering: the library's own way wants a render
/// pass and the loader linked.
class GuiPass {
 public:
  /// Takes the fonts of the current ImGui context, which must outlive it.
  GuiPass(const gpu::Device& device, vk::Format target);

  std::unique_ptr<GuiTexture> add(gpu::Texture texture) const;
  /// Clears the target and draws. The GPU must be done with the last call's.
  void record(const vk::raii::CommandBuffer& commands, const gpu::Swapchain::Target& target,
              const ImDrawData& data);

 private:
  void upload(const ImDrawData& data);

  const gpu::Device* device_;
  gpu::SetLayout set_layout_;
  vk::raii::PipelineLayout layout_ = nullptr;
  vk::raii::Pipeline pipeline_ = nullptr;
  vk::raii::Sampler sampler_ = nullptr;
  std::unique_ptr<GuiTexture> font_;
  gpu::Buffer vertices_, indices_;
};

}  // namespace verdure::app

#endif  // VERDURE_APP_VIEW_GUI_PASS_H_
