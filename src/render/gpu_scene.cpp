#include <algorithm>

#include "render/packed_light.h"
#include "render/scene.h"
#include "render/terms.h"

namespace verdure {

GpuScene::GpuScene(const gpu::Device& device, PackedScene packed, const SceneLayouts& layouts)
    : has_crown_normals_(!packed.crown_normals.empty()),
      moving_items_(packed.motions.items),
      places_(packed.instances),
      draws_(packed.draws),
      grounds_(packed.grounds),
      rest_bounds_(packed.bounds),
      bounds_(packed.bounds),
      ground_(packed.ground),
      ground_height_(packed.ground_height),
      leaf_tint_(packed.leaf_tint) {
  using Usage = vk::BufferUsageFlagBits;
  gpu::Upload upload(device);
  const auto vertices = [&upload](const auto& data) {
    return upload.buffer(std::span(data), Usage::eVertexBuffer);
  };
  positions_ = vertices(packed.positions);
  leaf_normals_ = vertices(packed.leaf_normals);
  crown_normals_ = vertices(packed.crown_normals);
  uvs_ = vertices(packed.uvs);
  instances_ = upload.buffer(std::span(std::as_const(packed.instances)),
                             Usage::eVertexBuffer | Usage::eStorageBuffer);
  indices_ = upload.buffer(std::span(std::as_const(packed.indices)), Usage::eIndexBuffer);
  transfer_.emplace(device, upload, packed.transfers, packed.positions.size(), layouts.transfer);
  any_items_ = std::any_of(draws_.begin(), draws_.end(),
                           [](const Draw& draw) { return !draw.forest.has_value(); });
  if (packed.forest) {
    std::vector<vk::DrawIndexedIndirectCommand> trees;
    for (const Draw& draw : draws_)
      if (draw.forest)
        trees.push_back({.indexCount = draw.index_count,
                         .firstIndex = draw.first_index,
                         .vertexOffset = draw.vertex_offset});
    forest_.emplace(device, upload, std::move(*packed.forest), trees, layouts.forest);
  }
  motion_.emplace(device, upload, packed.motions, instances_, forest(), layouts.motion);
  for (Draw& draw : draws_) {
    can_move_.push_back(draw.moving);
    draw.moving = false;
  }
  for (std::size_t i = 0; i < packed.textures.size(); ++i)
    textures_.push_back(upload.texture(packed.textures[i].levels, packed.texture_is_linear[i]
                                                                      ? vk::Format::eR8G8B8A8Unorm
                                                                      : vk::Format::eR8G8B8A8Srgb));
  for (const PackedLeafArray& leaf : packed.leaf_arrays)
    leaf_arrays_.push_back(upload.textureArray(
        leaf.layers, leaf.linear ? vk::Format::eR8G8B8A8Unorm : vk::Format::eR8G8B8A8Srgb));
  upload.finish();
  if (packed.terrain) terrain_.emplace(device, std::move(*packed.terrain), layouts.grass);

  for (int clamp = 0; clamp < 4; ++clamp) {
    const auto mode = [](bool edge) {
      return edge ? vk::SamplerAddressMode::eClampToEdge : vk::SamplerAddressMode::eRepeat;
    };
    samplers_.push_back(
        device.raii().createSampler({.magFilter = vk::Filter::eLinear,
                                     .minFilter = vk::Filter::eLinear,
                                     .mipmapMode = vk::SamplerMipmapMode::eLinear,
                                     .addressModeU = mode((clamp & 1) != 0),
                                     .addressModeV = mode((clamp & 2) != 0),
                                     .anisotropyEnable = device.maxAnisotropy() > 1.0f,
                                     .maxAnisotropy = std::min(device.maxAnisotropy(), 8.0f),
                                     .maxLod = VK_LOD_CLAMP_NONE}));
  }

  if (packed.materials.empty()) return;
  const auto count = static_cast<std::uint32_t>(packed.materials.size());
  const vk::DescriptorPoolSize size{.type = vk::DescriptorType::eCombinedImageSampler,
                                    .descriptorCount = 7 * count};
  pool_ = device.raii().createDescriptorPool(
      {.flags = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
       .maxSets = count,
       .poolSizeCount = 1,
       .pPoolSizes = &size});
  const std::vector<vk::DescriptorSetLayout> set_layouts(count, layouts.material);
  material_sets_ = vk::raii::DescriptorSets(
      device.raii(), vk::DescriptorSetAllocateInfo{.descriptorPool = *pool_,
                                                   .descriptorSetCount = count,
                                                   .pSetLayouts = set_layouts.data()});
  for (std::uint32_t i = 0; i < count; ++i) {
    const MaterialSlot& slot = packed.materials[i];
    const auto describe = [&](const gpu::Texture& texture, const std::array<bool, 2>& clamp) {
      return vk::DescriptorImageInfo{
          .sampler = *samplers_[(clamp[0] ? 1u : 0u) + (clamp[1] ? 2u : 0u)],
          .imageView = *texture.view,
          .imageLayout = vk::ImageLayout::eShaderReadOnlyOptimal};
    };
    const vk::DescriptorImageInfo base = describe(textures_[slot.base_color], slot.base_clamp);
    const vk::DescriptorImageInfo normal = describe(textures_[slot.normal_map], slot.normal_clamp);
    const vk::DescriptorImageInfo thickness =
        describe(textures_[slot.thickness_map], slot.thickness_clamp);
    const vk::DescriptorImageInfo colors =
        describe(leaf_arrays_[slot.leaf_colors], slot.base_clamp);
    const vk::DescriptorImageInfo vectors =
        describe(leaf_arrays_[slot.leaf_vectors], slot.base_clamp);
    const vk::DescriptorImageInfo share =
        describe(textures_[slot.transmission_share], slot.share_clamp);
    const vk::DescriptorImageInfo tint =
        describe(textures_[slot.transmission_color], slot.tint_clamp);
    std::vector<vk::WriteDescriptorSet> writes;
    for (const vk::DescriptorImageInfo* info :
         {&base, &normal, &thickness, &colors, &vectors, &share, &tint})
      writes.push_back({.dstSet = *material_sets_[i],
                        .dstBinding = static_cast<std::uint32_t>(writes.size()),
                        .descriptorCount = 1,
                        .descriptorType = vk::DescriptorType::eCombinedImageSampler,
                        .pImageInfo = info});
    device.raii().updateDescriptorSets(writes, nullptr);
  }
}

bool GpuScene::setLight(const gpu::Device& device, const PackedLight& light) {
  const auto bytes = [](const std::vector<PackedNormal>& normals) {
    return normals.size() * sizeof(PackedNormal);
  };
  if (!has_crown_normals_ || bytes(light.leaf_normals) != leaf_normals_.size ||
      bytes(light.crown_normals) != crown_normals_.size)
    return false;
  gpu::Upload upload(device);
  const auto vertices = [&upload](const std::vector<PackedNormal>& normals) {
    return upload.buffer(std::span(normals), vk::BufferUsageFlagBits::eVertexBuffer);
  };
  leaf_normals_ = vertices(light.leaf_normals);
  crown_normals_ = vertices(light.crown_normals);
  upload.finish();
  return true;
}

void GpuScene::setWind(const Wind& wind, const std::optional<Wind>& last) {
  Wind strongest = wind;
  if (last) {
    strongest.speed = std::max(wind.speed, last->speed);
    strongest.gusts = std::max(wind.gusts, last->gusts);
  }
  const bool blows = strongest.speed > 0.0f && !moving_items_.empty();
  if (forest_) forest_->setWind(blows ? std::optional(strongest) : std::nullopt);
  for (std::size_t i = 0; i < draws_.size(); ++i) draws_[i].moving = blows && can_move_[i];
  if (!blows) {
    bounds_ = rest_bounds_;
    bounds_wind_.reset();
    return;
  }
  if (bounds_wind_ && bounds_wind_->speed == strongest.speed &&
      bounds_wind_->gusts == strongest.gusts)
    return;
  bounds_wind_ = strongest;
  bounds_ = rest_bounds_;
  for (const PackedMotion& item : moving_items_) {
    const Bounds box = movedBounds(*item.tables, strongest);
    for (std::uint32_t k = 0; k < item.instances; ++k)
      growBounds(box, places_[item.first_instance + k], bounds_);
  }
}

Bounds GpuScene::casterBounds(const glm::vec3& eye) const {
  if (!forest_) return bounds_;
  const Bounds trees = forest_->casterBounds(eye);
  if (!any_items_) return trees;
  return {glm::min(bounds_.min, trees.min), glm::max(bounds_.max, trees.max)};
}

void GpuScene::bindVertices(const vk::raii::CommandBuffer& commands, NormalSource normals) const {
  const bool crown = normals == NormalSource::kCrown && has_crown_normals_;
  const gpu::Buffer& normal_stream = crown ? crown_normals_ : leaf_normals_;
  commands.bindVertexBuffers(0,
                             {*positions_.buffer, *normal_stream.buffer, *uvs_.buffer,
                              *instances_.buffer, *transfer_->light().buffer},
                             {0, 0, 0, 0, 0});
  commands.bindIndexBuffer(*indices_.buffer, 0, vk::IndexType::eUint32);
}

void GpuScene::record(const vk::raii::CommandBuffer& commands, vk::PipelineLayout layout,
                      vk::DescriptorSet frame_set, const Draw& draw, std::uint32_t view) const {
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, layout, 0,
                              {frame_set, *material_sets_[draw.material], motion_->vertexSet()},
                              nullptr);
  commands.pushConstants<shared::DrawUniforms>(layout, vk::ShaderStageFlagBits::eFragment, 0,
                                               draw.uniforms);
  if (draw.forest) {
    commands.bindVertexBuffers(3, forest_->seats(), forest_->seatOffset(view));
    forest_->draw(commands, *draw.forest, view);
    commands.bindVertexBuffers(3, *instances_.buffer, vk::DeviceSize{0});
    return;
  }
  commands.drawIndexed(draw.index_count, draw.instance_count, draw.first_index, draw.vertex_offset,
                       draw.first_instance);
}

void GpuScene::recordSeen(const vk::raii::CommandBuffer& commands, vk::PipelineLayout layout,
                          vk::DescriptorSet frame_set, const Draw& draw) const {
  record(commands, layout, frame_set, draw, GpuForest::kPicture);
  if (draw.forest) record(commands, layout, frame_set, draw, GpuForest::kBehind);
}

std::vector<vk::VertexInputBindingDescription> GpuScene::bindings(bool transfer) {
  return {
      {.binding = 0, .stride = sizeof(glm::vec3)},
      {.binding = 1, .stride = sizeof(PackedNormal)},
      {.binding = 2, .stride = sizeof(glm::vec2)},
      {.binding = 3, .stride = sizeof(PackedInstance), .inputRate = vk::VertexInputRate::eInstance},
      {.binding = 4, .stride = transfer ? 16u : 0u}};
}

std::vector<vk::VertexInputAttributeDescription> GpuScene::attributes() {
  using Format = vk::Format;
  return {{.location = 0, .binding = 0, .format = Format::eR32G32B32Sfloat},
          {.location = 1, .binding = 1, .format = Format::eR16G16B16A16Snorm},
          {.location = 2, .binding = 2, .format = Format::eR32G32Sfloat},
          {.location = 3, .binding = 3, .format = Format::eR32G32B32A32Sfloat, .offset = 0},
          {.location = 4, .binding = 3, .format = Format::eR32G32B32A32Sfloat, .offset = 16},
          {.location = 5, .binding = 3, .format = Format::eR32G32B32A32Sfloat, .offset = 32},
          {.location = 6, .binding = 4, .format = Format::eR16G16B16A16Sfloat, .offset = 0},
          {.location = 7, .binding = 4, .format = Format::eR16G16B16A16Sfloat, .offset = 8},
          {.location = 8, .binding = 3, .format = Format::eR32G32B32A32Uint, .offset = 48}};
}

gpu::Constants GpuScene::shapeConstants(const Draw& draw) {
  return termConstants({}, {.alpha_test = draw.alpha_test, .moving = draw.moving});
}

std::vector<vk::VertexInputAttributeDescription> GpuScene::shapeAttributes() {
  std::vector<vk::VertexInputAttributeDescription> shape = attributes();
  std::erase_if(shape, [](const auto& attribute) {
    return attribute.location == 1 || attribute.location == 6 || attribute.location == 7;
  });
  return shape;
}

}  // namespace verdure
