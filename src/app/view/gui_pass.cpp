#include "app/view/gui_pass.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <glm/glm.hpp>

namespace verdure::app {
namespace {

constexpr std::uint32_t kVertex[] = {
#include "shaders/gui.vert.inc"
};
constexpr std::uint32_t kFragment[] = {
#include "shaders/gui.frag.inc"
};

constexpr vk::IndexType kIndexType =
    sizeof(ImDrawIdx) == 2 ? vk::IndexType::eUint16 : vk::IndexType::eUint32;

struct GuiPlace {
  glm::vec2 origin, clip_per_pixel;
};

vk::Rect2D scissorOf(const ImVec4& clip, const ImDrawData& data, const vk::Extent2D& size) {
  const ImVec2& origin = data.DisplayPos;
  const ImVec2& scale = data.FramebufferScale;
  const auto limit = [](float value, std::uint32_t most) {
    return static_cast<std::int32_t>(std::clamp(value, 0.0f, static_cast<float>(most)));
  };
  const std::int32_t x = limit((clip.x - origin.x) * scale.x, size.width);
  const std::int32_t y = limit((clip.y - origin.y) * scale.y, size.height);
  const std::int32_t right = std::max(limit((clip.z - origin.x) * scale.x, size.width), x);
  const std::int32_t bottom = std::max(limit((clip.w - origin.y) * scale.y, size.height), y);
  return {
      .offset = {x, y},
      .extent = {static_cast<std::uint32_t>(right - x), static_cast<std::uint32_t>(bottom - y)}};
}

/// At least as large as asked for.
void grow(const gpu::Device& device, std::size_t bytes, vk::BufferUsageFlags usage,
          gpu::Buffer& buffer) {
  if (buffer.size >= bytes) return;
  buffer = {};
  buffer = gpu::makeBuffer(device, bytes + bytes / 2, usage, gpu::MemoryUse::kToGpu);
}

}  // namespace

GuiPass::GuiPass(const gpu::Device& device, vk::Format target)
    : device_(&device),
      set_layout_(device, {vk::DescriptorType::eCombinedImageSampler},
                  vk::ShaderStageFlagBits::eFragment),
      layout_(gpu::makePipelineLayout(device, std::array{*set_layout_.layout},
                                      vk::ShaderStageFlagBits::eVertex, sizeof(GuiPlace))),
      sampler_(
          gpu::makeSampler(device, vk::Filter::eLinear, vk::SamplerAddressMode::eClampToEdge)) {
  pipeline_ =
      gpu::makeGraphicsPipeline(device, {.vertex = kVertex,
                                         .fragment = kFragment,
                                         .layout = *layout_,
                                         .bindings = {{.binding = 0, .stride = sizeof(ImDrawVert)}},
                                         .attributes = {{.location = 0,
                                                         .format = vk::Format::eR32G32Sfloat,
                                                         .offset = offsetof(ImDrawVert, pos)},
                                                        {.location = 1,
                                                         .format = vk::Format::eR32G32Sfloat,
                                                         .offset = offsetof(ImDrawVert, uv)},
                                                        {.location = 2,
                                                         .format = vk::Format::eR8G8B8A8Unorm,
                                                         .offset = offsetof(ImDrawVert, col)}},
                                         .color = target,
                                         .blend = gpu::Blend::kOver});
  ImGuiIO& io = ImGui::GetIO();
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  unsigned char* texels = nullptr;
  int width = 0, height = 0;
  io.Fonts->GetTexDataAsRGBA32(&texels, &width, &height);
  gpu::MipLevel level{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
  level.rgba.assign(texels, texels + std::size_t{level.width} * level.height * 4);
  gpu::Upload upload(device);
  gpu::Texture font = upload.texture({&level, 1}, vk::Format::eR8G8B8A8Unorm);
  upload.finish();
  font_ = add(std::move(font));
  io.Fonts->SetTexID(font_.get());
}

std::unique_ptr<GuiTexture> GuiPass::add(gpu::Texture texture) const {
  auto added =
      std::make_unique<GuiTexture>(std::move(texture), gpu::DescriptorSet(*device_, set_layout_));
  added->set.setTexture(0, added->texture, *sampler_);
  return added;
}

void GuiPass::upload(const ImDrawData& data) {
  using Usage = vk::BufferUsageFlagBits;
  const auto vertex_count = static_cast<std::size_t>(data.TotalVtxCount);
  const auto index_count = static_cast<std::size_t>(data.TotalIdxCount);
  grow(*device_, vertex_count * sizeof(ImDrawVert), Usage::eVertexBuffer, vertices_);
  grow(*device_, index_count * sizeof(ImDrawIdx), Usage::eIndexBuffer, indices_);
  std::size_t vertex = 0, index = 0;
  for (int n = 0; n < data.CmdListsCount; ++n) {
    const ImDrawList& list = *data.CmdLists[n];
    const auto bytes = [](const auto& vector) {
      return static_cast<std::size_t>(vector.size_in_bytes());
    };
    std::memcpy(vertices_.memory.mapped() + vertex, list.VtxBuffer.Data, bytes(list.VtxBuffer));
    std::memcpy(indices_.memory.mapped() + index, list.IdxBuffer.Data, bytes(list.IdxBuffer));
    vertex += bytes(list.VtxBuffer);
    index += bytes(list.IdxBuffer);
  }
}

void GuiPass::record(const vk::raii::CommandBuffer& commands, const gpu::Swapchain::Target& target,
                     const ImDrawData& data) {
  const vk::RenderingAttachmentInfo color{
      .imageView = target.view,
      .imageLayout = vk::ImageLayout::eColorAttachmentOptimal,
      .loadOp = vk::AttachmentLoadOp::eClear,
      .storeOp = vk::AttachmentStoreOp::eStore,
      .clearValue = vk::ClearValue(vk::ClearColorValue(std::array{0.08f, 0.08f, 0.08f, 1.0f}))};
  commands.beginRendering({.renderArea = {.extent = target.size},
                           .layerCount = 1,
                           .colorAttachmentCount = 1,
                           .pColorAttachments = &color});
  if (data.TotalIdxCount > 0) {
    upload(data);
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *pipeline_);
    commands.bindVertexBuffers(0, {*vertices_.buffer}, {0});
    commands.bindIndexBuffer(*indices_.buffer, 0, kIndexType);
    const float width = static_cast<float>(target.size.width);
    const float height = static_cast<float>(target.size.height);
    commands.setViewport(0, vk::Viewport{.width = width, .height = height, .maxDepth = 1.0f});
    commands.pushConstants<GuiPlace>(
        *layout_, vk::ShaderStageFlagBits::eVertex, 0,
        GuiPlace{{data.DisplayPos.x, data.DisplayPos.y},
                 {2.0f / data.DisplaySize.x, 2.0f / data.DisplaySize.y}});
    std::uint32_t first_index = 0;
    std::int32_t first_vertex = 0;
    for (int n = 0; n < data.CmdListsCount; ++n) {
      const ImDrawList& list = *data.CmdLists[n];
      for (const ImDrawCmd& command : list.CmdBuffer) {
        if (command.UserCallback != nullptr) continue;
        const vk::Rect2D scissor = scissorOf(command.ClipRect, data, target.size);
        if (scissor.extent.width == 0 || scissor.extent.height == 0) continue;
        const auto* texture = static_cast<const GuiTexture*>(command.GetTexID());
        commands.setScissor(0, scissor);
        commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout_, 0, {*texture->set},
                                    nullptr);
        commands.drawIndexed(command.ElemCount, 1, first_index + command.IdxOffset,
                             first_vertex + static_cast<std::int32_t>(command.VtxOffset), 0);
      }
      first_index += static_cast<std::uint32_t>(list.IdxBuffer.Size);
      first_vertex += list.VtxBuffer.Size;
    }
  }
  commands.endRendering();
}

}  // namespace verdure::app
