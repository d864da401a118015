#include "render/gpu_forest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "motion/motion_texture.h"
#include "scene/camera.h"
#include "scene/terrain_horizon.h"
#include "shared/frame.h"
#include "shared/horizon.h"
#include "verdure/error.h"

namespace verdure {
namespace {

constexpr std::uint32_t kCount[] = {
#include "shaders/forest_count.comp.inc"
};
constexpr std::uint32_t kScan[] = {
#include "shaders/forest_scan.comp.inc"
};
constexpr std::uint32_t kList[] = {
#include "shaders/forest_list.comp.inc"
};
constexpr std::uint32_t kDepthTiles[] = {
#include "shaders/depth_tiles.comp.inc"
};

/// Trees farther from the eye cast no shadow, m.
constexpr float kShadowRange_m = 400.0f;
/// By which steps the bounds of what casts shadows follow the eye, m.
constexpr float kCasterStep_m = 64.0f;
/// Of a sun that is lower, shadows end before they reach the ground.
constexpr float kLeastSun = 0.01f;
constexpr std::uint32_t kDrawWords = 5, kFarWords = 4, kMotionWords = 6;
constexpr std::uint32_t kSeatBytes = 64;

/// As in forest_set.glsl.
struct ChoiceJob {
  std::uint32_t first_view, place_count, cluster_count, class_count, draw_count, kind_count,
      first_far_command, first_motion_command, motion_seats;
};

/// dot(xyz, p) + w: distance from the plane where a row of clip coordinates, times p, is 0.
glm::vec4 planeOf(const glm::vec4& row) {
  return row / std::max(glm::length(glm::vec3(row)), 1e-20f);
}

glm::vec4 rowOf(const glm::mat4& m, int row) {
  return {m[0][row], m[1][row], m[2][row], m[3][row]};
}

}  // namespace

ForestLayouts::ForestLayouts(const gpu::Device& device)
    : choice(device,
             {vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer,
              vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer,
              vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer,
              vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer,
              vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer,
              vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer,
              vk::DescriptorType::eStorageBuffer},
             vk::ShaderStageFlagBits::eCompute),
      impostor(
          device,
          {vk::DescriptorType::eCombinedImageSampler, vk::DescriptorType::eCombinedImageSampler,
           vk::DescriptorType::eCombinedImageSampler, vk::DescriptorType::eStorageBuffer,
           vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer,
           vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer,
           vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer},
          vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment) {}

GpuForest::GpuForest(const gpu::Device& device, gpu::Upload& upload, PackedForest packed,
                     std::span<const vk::DrawIndexedIndirectCommand> draws,
                     const ForestLayouts& layouts)
    : device_(&device),
      packed_(std::move(packed)),
      draw_count_(static_cast<std::uint32_t>(draws.size())) {
  using Usage = vk::BufferUsageFlagBits;
  constexpr auto kStorage = Usage::eStorageBuffer;
  const auto kinds = static_cast<std::uint32_t>(packed_.kinds.size());
  const auto places = static_cast<std::uint32_t>(packed_.places.size());
  const auto clusters = static_cast<std::uint32_t>(packed_.clusters.size());
  const auto stored = [&](const auto& data) {
    return upload.buffer(std::span(std::as_const(data)), kStorage);
  };
  places_ = stored(packed_.places);
  clusters_ = stored(packed_.clusters);
  draw_classes_ = stored(packed_.draw_classes);

  std::vector<std::uint32_t> commands;
  for (std::uint32_t view = 0; view < kViews; ++view)
    for (const vk::DrawIndexedIndirectCommand& draw : draws)
      for (const std::uint32_t word : {draw.indexCount, 0u, draw.firstIndex,
                                       static_cast<std::uint32_t>(draw.vertexOffset), 0u})
        commands.push_back(word);
  for (std::uint32_t i = 0; i < kViews * kinds; ++i)
    for (const std::uint32_t word : {shared::kImpostorVertices, 0u, 0u, 0u})
      commands.push_back(word);
  commands.resize(commands.size() + kMotionWords * kinds, 0u);
  commands_ = upload.buffer(std::span(std::as_const(commands)), kStorage | Usage::eIndirectBuffer);

  const auto make = [&](std::size_t bytes, gpu::MemoryUse use = gpu::MemoryUse::kDevice,
                        vk::BufferUsageFlags more = {}) {
    if (bytes > device.limits().maxStorageBufferRange)
      throw Error(device.name(),
                  "a forest of " + std::to_string(places) + " trees takes " +
                      std::to_string(bytes >> 20) + " MiB at once, more than this device reads",
                  "plant fewer trees");
    return gpu::makeBuffer(device, bytes, kStorage | more, use);
  };
  kind_data_.resize(kinds);
  kind_buffer_ = make(kinds * sizeof(shared::ForestKindData), gpu::MemoryUse::kToGpu);
  views_ = make(kViews * sizeof(shared::ForestView), gpu::MemoryUse::kToGpu);
  counts_ = make(std::size_t{kViews} * packed_.classes * clusters * 4);
  ranges_ =
      make(std::size_t{kViews} * packed_.classes * sizeof(glm::uvec2), gpu::MemoryUse::kFromGpu);
  slots_ = make(std::size_t{places} * 4);
  horizon_ = make(std::size_t{shared::kHorizonTurns} * shared::kHorizonRings * sizeof(float),
                  gpu::MemoryUse::kToGpu);

  // Trees whose kind has no levels are meshes anywhere.
  std::uint32_t always = 0;
  for (const shared::ForestPlace& place : packed_.places)
    always += packed_.kinds[place.kind].impostor.views == 0 ? 1 : 0;
  std::uint32_t seat = kinds * packed_.motion_seats, far = 0;
  const std::uint32_t meshes = std::min(packed_.most_meshes, places);
  for (std::uint32_t v = 0; v < kViews; ++v) {
    shared::ForestView& view = view_data_[v];
    view.first_seat = v == kMotionView ? 0 : seat;
    // Where levels give way to each other, a tree is drawn as both.
    const bool picture = v == kPicture || v == kBehind;
    view.seats = v == kMotionView ? 0 : (picture ? 2 : 1) * meshes + (v == kBehind ? 0 : always);
    view.first_far = far;
    view.fars = v == kMotionView || v == kPicture ? 0
                : v == kBehind                    ? places
                                                  : std::min(places, kMostForestCasters);
    view.fades = picture ? 1 : 0;
    view.part = v == kPicture  ? shared::kForestFront
                : v == kBehind ? shared::kForestBehind
                               : shared::kForestAll;
    view.motion = v == kMotionView ? 1 : 0;
    seat += view.seats;
    far += view.fars;
  }
  seats_ = make(std::size_t{seat} * kSeatBytes, gpu::MemoryUse::kDevice, Usage::eVertexBuffer);
  fars_ = make(std::size_t{far} * 4);

  set_.emplace(device, layouts.choice);
  std::uint32_t binding = 0;
  for (const gpu::Buffer* buffer :
       {&places_, &clusters_, &kind_buffer_, &views_, &counts_, &ranges_, &commands_,
        &draw_classes_, &seats_, &fars_, &slots_, &horizon_})
    set_->setBuffer(binding++, *buffer);

  low_ = glm::vec3(std::numeric_limits<float>::max());
  high_ = -low_;
  for (const shared::ForestPlace& place : packed_.places) {
    low_ = glm::min(low_, {place.x, place.y, place.z});
    high_ = glm::max(high_, {place.x, place.y, place.z});
  }
  sampler_ = gpu::makeSampler(device, vk::Filter::eLinear, vk::SamplerAddressMode::eClampToEdge);
  impostor_data_.resize(kinds);
  impostors_ = make(kinds * sizeof(shared::ImpostorKind), gpu::MemoryUse::kToGpu);
  for (PackedForestKind& kind : packed_.kinds) {
    shared::ImpostorKind& data = impostor_data_[kinds_.size()];
    data.sphere = kind.impostor.sphere;
    data.leaf = kind.leaf;
    data.crown = kind.impostor.crown;
    data.radii = kind.impostor.radii;
    data.meshes = static_cast<std::uint32_t>(kind.grain_m.size());
    data.views = static_cast<std::uint32_t>(kind.impostor.views);
    Kind& made = kinds_.emplace_back();
    if (kind.impostor.views == 0) continue;
    made.color = upload.textureArray(kind.impostor.color, vk::Format::eR8G8B8A8Srgb);
    made.normal = upload.textureArray(kind.impostor.normal, vk::Format::eR8G8B8A8Unorm);
    made.light = upload.textureArray(kind.impostor.light, vk::Format::eR8G8B8A8Unorm);
    kind.impostor.color = kind.impostor.normal = kind.impostor.light = {};
    made.set.emplace(device, layouts.impostor);
    made.set->setTexture(0, *made.color, *sampler_);
    made.set->setTexture(1, *made.normal, *sampler_);
    made.set->setTexture(2, *made.light, *sampler_);
    made.set->setBuffer(3, places_);
    made.set->setBuffer(4, fars_);
    made.set->setBuffer(5, ranges_);
    made.set->setBuffer(6, impostors_);
    for (const std::uint32_t unused : {7u, 8u, 9u}) made.set->setBuffer(unused, places_);
  }
  setWind(std::nullopt);
}

void GpuForest::setMotion(const PackedMotions& packed, const gpu::Buffer& beams,
                          const gpu::Buffer& drives, std::span<const gpu::Buffer> texels) {
  for (std::size_t k = 0; k < kinds_.size(); ++k) {
    const int index = packed_.kinds[k].motion_item;
    if (index < 0) continue;
    const PackedMotion& item = packed.items[static_cast<std::size_t>(index)];
    shared::ForestKindData& data = kind_data_[k];
    data.beams = static_cast<std::uint32_t>(item.tables->beams.size());
    data.leaves = static_cast<std::uint32_t>(item.tables->leaves.size());
    data.beam_base = item.amplitude_base - item.first_beam;
    data.leaf_base = item.turn_base - item.first_leaf;
    impostor_data_[k].beam = item.first_beam;
    if (!kinds_[k].set || item.tables->beams.empty()) continue;
    kinds_[k].set->setBuffer(7, beams);
    kinds_[k].set->setBuffer(8, drives);
    kinds_[k].set->setBuffer(9, texels[static_cast<std::size_t>(index)]);
  }
}

void GpuForest::setWind(const std::optional<Wind>& wind) {
  wind_ = wind;
  moves_ = wind.has_value() && packed_.motion_seats > 0;
  tallest_m_ = 0.0f;
  largest_ = {glm::vec3(0.0f), glm::vec3(0.0f)};
  for (std::size_t k = 0; k < kind_data_.size(); ++k) {
    const PackedForestKind& kind = packed_.kinds[k];
    shared::ForestKindData& data = kind_data_[k];
    Bounds box = kind.box;
    if (moves_ && kind.tables != nullptr) {
      const Bounds moved = movedBounds(*kind.tables, *wind);
      box = {glm::min(box.min, moved.min), glm::max(box.max, moved.max)};
    }
    data.sphere = glm::vec4(box.center(), 0.5f * glm::length(box.size()));
    data.half_height = 0.5f * box.size().y;
    data.half_width = 0.5f * glm::length(glm::vec2(box.size().x, box.size().z));
    data.moves = moves_ && kind.tables != nullptr ? 1 : 0;
    const glm::vec2 aside = glm::max(glm::abs(glm::vec2(box.min.x, box.min.z)),
                                     glm::abs(glm::vec2(box.max.x, box.max.z)));
    const float around = glm::length(aside);
    largest_.min =
        glm::min(largest_.min, packed_.largest_scale * glm::vec3(-around, box.min.y, -around));
    largest_.max =
        glm::max(largest_.max, packed_.largest_scale * glm::vec3(around, box.max.y, around));
    tallest_m_ = std::max(
        tallest_m_, packed_.largest_scale * (glm::length(glm::vec3(data.sphere)) + data.sphere.w));
  }
}

void GpuForest::look(const View& view, std::span<const Cascade> cascades, const Terrain* terrain,
                     float lowest, bool hides) {
  const glm::vec3& eye = view.camera.eye;
  if (terrain != nullptr && horizon_eye_ != eye) {
    const std::vector<float> horizon = terrainHorizon(*terrain, eye);
    std::memcpy(horizon_.memory.mapped(), horizon.data(), horizon.size() * sizeof(float));
    horizon_eye_ = eye;
  }
  const float pixels_per_m =
      static_cast<float>(view.height) / (2.0f * std::tan(0.5f * view.camera.vertical_fov));
  float reach = 0.0f;  // of trees that move
  for (std::size_t k = 0; k < kind_data_.size(); ++k) {
    const PackedForestKind& kind = packed_.kinds[k];
    shared::ForestKindData& data = kind_data_[k];
    data.reach = levelReach(kind, pixels_per_m, packed_.detail);
    data.first_class = kind.first_class;
    data.meshes = static_cast<std::uint32_t>(kind.grain_m.size());
    data.has_impostor = kind.impostor.views > 0 ? 1 : 0;
    if (data.moves != 0)
      reach = std::max(reach, data.has_impostor != 0 ? data.reach.w * packed_.largest_scale
                                                     : std::numeric_limits<float>::max());
    shared::ImpostorKind& far = impostor_data_[k];
    far.reach = data.reach;
    far.moves = data.moves != 0 && data.beams > 0 ? 1 : 0;
    if (far.moves != 0) {
      far.moment = momentOf(view.wind, view.seconds, kind.tables->wind_extent);
      far.whole = motionTime(view.seconds).whole;
      const Wind& last_wind = view.last ? view.last->wind : view.wind;
      const double last_seconds = view.last ? view.last->seconds : view.seconds;
      far.last_moment = momentOf(last_wind, last_seconds, kind.tables->wind_extent);
      far.last_whole = motionTime(last_seconds).whole;
    }
  }
  std::memcpy(impostors_.memory.mapped(), impostor_data_.data(),
              impostor_data_.size() * sizeof(shared::ImpostorKind));
  std::memcpy(kind_buffer_.memory.mapped(), kind_data_.data(),
              kind_data_.size() * sizeof(shared::ForestKindData));

  // A tree's place may be its sphere's radius off its middle, from which its level is chosen.
  const float meshes =
      std::max(distanceOfNearest(packed_, eye, std::min(packed_.most_meshes, kMostForestMeshes)) -
                   tallest_m_,
               0.0f);
  const float casters =
      std::min(kShadowRange_m,
               std::max(distanceOfNearest(packed_, eye, kMostForestCasters) - tallest_m_, 0.0f));
  const float aspect = static_cast<float>(view.width) / static_cast<float>(view.height);
  const glm::mat4 clip = clipFromWorld(view.camera, aspect);
  const glm::vec4 all(0.0f, 0.0f, 0.0f, 1.0f);
  view_count_ = 1 + static_cast<std::uint32_t>(cascades.size());
  for (std::uint32_t v = 0; v < kViews; ++v) {
    shared::ForestView& data = view_data_[v];
    data.eye = glm::vec4(eye, meshes);
    data.farthest = v == kMotionView ? reach : std::numeric_limits<float>::max();
    const bool picture = v == kPicture || v == kBehind;
    data.horizon = picture && terrain != nullptr ? 1 : 0;
    data.hides = v == kBehind && hides && !all_ ? 1 : 0;
    data.clip = clip;
    data.width = static_cast<std::uint32_t>(view.width);
    data.height = static_cast<std::uint32_t>(view.height);
    for (glm::vec4& plane : data.planes) plane = all;
    if (picture) {
      const glm::vec4 w = rowOf(clip, 3);
      int i = 0;
      for (const int axis : {0, 1})
        for (const float sign : {1.0f, -1.0f})
          data.planes[i++] = planeOf(w + sign * rowOf(clip, axis));
      data.planes[i] = planeOf(w);
    } else if (v < view_count_) {
      const glm::mat4& map = cascades[v - 1].shadow_from_world;
      const glm::vec4 one(0.0f, 0.0f, 0.0f, 1.0f);
      int i = 0;
      for (const int axis : {0, 1}) {
        data.planes[i++] = planeOf(rowOf(map, axis));
        data.planes[i++] = planeOf(one - rowOf(map, axis));
      }
      data.planes[i] = planeOf(one - rowOf(map, 2));  // nothing behind the map's end casts into it
      data.farthest = casters;
      const glm::vec3& sun = view.daylight.sun.direction;
      data.shades = all_ ? 0 : 1;
      data.blur = shared::kWidestShadow * cascades[v - 1].texel_m;
      data.shade = glm::vec4(-sun / std::max(sun.y, kLeastSun), std::min(lowest, low_.y));
    }
  }
  std::memcpy(views_.memory.mapped(), view_data_.data(), sizeof(view_data_));
  const std::size_t tiles = std::size_t{shared::depthTiles(view_data_[kBehind].width)} *
                            shared::depthTiles(view_data_[kBehind].height);
  const std::size_t bytes = (tiles + tiles / 64) * sizeof(float);
  if (depth_tiles_.size == bytes) return;
  depth_tiles_ = gpu::makeBuffer(*device_, bytes, vk::BufferUsageFlagBits::eStorageBuffer,
                                 gpu::MemoryUse::kDevice);
  set_->setBuffer(12, depth_tiles_);
}

Bounds GpuForest::casterBounds(const glm::vec3& eye) const {
  const glm::vec3 step = glm::round(eye / kCasterStep_m) * kCasterStep_m;
  const float reach = kShadowRange_m + kCasterStep_m;
  Bounds box;
  box.min = glm::min(glm::max(low_, step - reach), high_) + largest_.min;
  box.max = glm::max(glm::min(high_, step + reach), low_) + largest_.max;
  box.min.y = low_.y + largest_.min.y;
  box.max.y = high_.y + largest_.max.y;
  return box;
}

vk::DeviceSize GpuForest::seatOffset(std::uint32_t view) const {
  return vk::DeviceSize{view_data_[view].first_seat} * kSeatBytes;
}

void GpuForest::draw(const vk::raii::CommandBuffer& commands, std::uint32_t number,
                     std::uint32_t view) const {
  commands.drawIndexedIndirect(*commands_.buffer,
                               vk::DeviceSize{view * draw_count_ + number} * kDrawWords * 4, 1,
                               kDrawWords * 4);
}

void GpuForest::drawFar(const vk::raii::CommandBuffer& commands, std::uint32_t kind,
                        std::uint32_t view) const {
  const auto kinds = static_cast<std::uint32_t>(packed_.kinds.size());
  commands.drawIndirect(
      *commands_.buffer,
      vk::DeviceSize{kViews * draw_count_ * kDrawWords + (view * kinds + kind) * kFarWords} * 4, 1,
      kFarWords * 4);
}

vk::DeviceSize GpuForest::motionCommand(std::uint32_t kind) const {
  const auto kinds = static_cast<std::uint32_t>(packed_.kinds.size());
  return vk::DeviceSize{kViews * (draw_count_ * kDrawWords + kinds * kFarWords) +
                        kind * kMotionWords} *
         4;
}

std::pair<std::uint32_t, std::uint32_t> GpuForest::counts() const {
  std::vector<glm::uvec2> ranges(std::size_t{kViews} * packed_.classes);
  std::memcpy(ranges.data(), ranges_.memory.mapped(), ranges.size() * sizeof(glm::uvec2));
  std::pair<std::uint32_t, std::uint32_t> sum(0, 0);
  for (const std::uint32_t view : {kPicture, kBehind})
    for (const PackedForestKind& kind : packed_.kinds) {
      const std::size_t meshes = kind.grain_m.size(),
                        first = std::size_t{view} * packed_.classes + kind.first_class;
      for (std::size_t i = 0; i < meshes; ++i) sum.first += ranges[first + i].y;
      sum.second += ranges[first + meshes].y;
    }
  return sum;
}

std::size_t GpuForest::bytes() const {
  std::size_t sum = 0;
  for (const gpu::Buffer* buffer : {&places_, &clusters_, &counts_, &seats_, &fars_, &slots_})
    sum += buffer->size;
  return sum;
}

ForestPass::ForestPass(const gpu::Device& device)
    : layouts_(device),
      tiles_set_layout_(
          device, {vk::DescriptorType::eCombinedImageSampler, vk::DescriptorType::eStorageBuffer},
          vk::ShaderStageFlagBits::eCompute),
      layout_(gpu::makePipelineLayout(device, std::array{*layouts_.choice.layout},
                                      vk::ShaderStageFlagBits::eCompute, sizeof(ChoiceJob))),
      tiles_layout_(gpu::makePipelineLayout(device, std::array{*tiles_set_layout_.layout},
                                            vk::ShaderStageFlagBits::eCompute, 0)),
      count_(gpu::makeComputePipeline(device, kCount, *layout_)),
      scan_(gpu::makeComputePipeline(device, kScan, *layout_)),
      list_(gpu::makeComputePipeline(device, kList, *layout_)),
      tiles_(gpu::makeComputePipeline(device, kDepthTiles, *tiles_layout_)),
      tiles_set_(device, tiles_set_layout_),
      sampler_(
          gpu::makeSampler(device, vk::Filter::eNearest, vk::SamplerAddressMode::eClampToEdge)) {}

void ForestPass::prepare(const GpuForest& forest, const gpu::Texture& depth) {
  tiles_set_.setTexture(0, depth, *sampler_);
  tiles_set_.setBuffer(1, forest.depth_tiles_);
}

void ForestPass::begin(const vk::raii::CommandBuffer& commands, const GpuForest& forest) const {
  using gpu::Use;
  const auto turn = [&commands](const gpu::Buffer& buffer, Use from, Use to) {
    gpu::bufferBarrier(commands, *buffer.buffer, from, to);
  };
  turn(forest.commands_, Use::kIndirect, Use::kComputeStorage);
  turn(forest.seats_, Use::kVertexInput, Use::kComputeStorage);
  for (const gpu::Buffer* buffer : {&forest.fars_, &forest.ranges_})
    turn(*buffer, Use::kVertexStorage, Use::kComputeStorage);
  // What moves trees reads seats, too.
  for (const gpu::Buffer* buffer :
       {&forest.counts_, &forest.slots_, &forest.seats_, &forest.ranges_})
    turn(*buffer, Use::kComputeStorage, Use::kComputeStorage);
}

void ForestPass::choose(const vk::raii::CommandBuffer& commands, const GpuForest& forest,
                        std::uint32_t first_view, std::uint32_t views) const {
  using gpu::Use;
  const auto settle = [&commands](const gpu::Buffer& buffer) {
    gpu::bufferBarrier(commands, *buffer.buffer, Use::kComputeStorage, Use::kComputeStorage);
  };
  const auto kinds = static_cast<std::uint32_t>(forest.packed_.kinds.size());
  const std::uint32_t far_commands = GpuForest::kViews * forest.draw_count_ * kDrawWords;
  const ChoiceJob job{.first_view = first_view,
                      .place_count = static_cast<std::uint32_t>(forest.packed_.places.size()),
                      .cluster_count = static_cast<std::uint32_t>(forest.packed_.clusters.size()),
                      .class_count = forest.packed_.classes,
                      .draw_count = forest.draw_count_,
                      .kind_count = kinds,
                      .first_far_command = far_commands,
                      .first_motion_command = far_commands + GpuForest::kViews * kinds * kFarWords,
                      .motion_seats = forest.packed_.motion_seats};
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout_, 0, {**forest.set_},
                              nullptr);
  commands.pushConstants<ChoiceJob>(*layout_, vk::ShaderStageFlagBits::eCompute, 0, job);
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *count_);
  commands.dispatch(job.cluster_count, views, 1);
  settle(forest.counts_);
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *scan_);
  commands.dispatch(views, 1, 1);
  settle(forest.counts_);
  settle(forest.ranges_);
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *list_);
  commands.dispatch(job.cluster_count, views, 1);
  settle(forest.counts_);
  settle(forest.ranges_);
}

void ForestPass::end(const vk::raii::CommandBuffer& commands, const GpuForest& forest) const {
  using gpu::Use;
  const auto turn = [&commands](const gpu::Buffer& buffer, Use to) {
    gpu::bufferBarrier(commands, *buffer.buffer, Use::kComputeStorage, to);
  };
  turn(forest.commands_, Use::kIndirect);
  turn(forest.seats_, Use::kVertexInput);
  turn(forest.seats_, Use::kComputeStorage);  // for their motion
  for (const gpu::Buffer* buffer : {&forest.fars_, &forest.ranges_})
    turn(*buffer, Use::kVertexStorage);
  turn(forest.ranges_, Use::kHostRead);
}

void ForestPass::record(const vk::raii::CommandBuffer& commands, const GpuForest& forest) const {
  using gpu::Use;
  // An upload leaves buffers as vertex input.
  for (const gpu::Buffer* buffer : {&forest.places_, &forest.clusters_, &forest.draw_classes_}) {
    gpu::bufferBarrier(commands, *buffer->buffer, Use::kVertexInput, Use::kComputeStorage);
    gpu::bufferBarrier(commands, *buffer->buffer, Use::kVertexInput, Use::kVertexStorage);
  }
  gpu::bufferBarrier(commands, *forest.commands_.buffer, Use::kVertexInput, Use::kComputeStorage);
  begin(commands, forest);
  if (forest.moves()) {  // first: what is drawn reads where its motion is
    choose(commands, forest, GpuForest::kMotionView, 1);
    gpu::bufferBarrier(commands, *forest.slots_.buffer, Use::kComputeStorage, Use::kComputeStorage);
  }
  choose(commands, forest, 0, forest.view_count_);
  if (!forest.hides()) choose(commands, forest, GpuForest::kBehind, 1);
  end(commands, forest);
}

void ForestPass::recordBehind(const vk::raii::CommandBuffer& commands, const GpuForest& forest,
                              const gpu::Texture& depth) const {
  using gpu::Use;
  gpu::imageBarrier(commands, *depth.image, vk::ImageAspectFlagBits::eDepth, Use::kDepthAttachment,
                    Use::kComputeSampled);
  gpu::bufferBarrier(commands, *forest.depth_tiles_.buffer, Use::kComputeStorage,
                     Use::kComputeStorage);
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *tiles_);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *tiles_layout_, 0, {*tiles_set_},
                              nullptr);
  const shared::ForestView& view = forest.view_data_[GpuForest::kBehind];
  commands.dispatch(shared::depthTiles(view.width) / 8, shared::depthTiles(view.height) / 8, 1);
  gpu::bufferBarrier(commands, *forest.depth_tiles_.buffer, Use::kComputeStorage,
                     Use::kComputeStorage);
  gpu::imageBarrier(commands, *depth.image, vk::ImageAspectFlagBits::eDepth, Use::kComputeSampled,
                    Use::kDepthAttachment);
  begin(commands, forest);
  choose(commands, forest, GpuForest::kBehind, 1);
  end(commands, forest);
}

}  // namespace verdure
