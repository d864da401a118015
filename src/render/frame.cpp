#include "render/frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "render/look.h"
#include "scene/camera.h"
#include "scene/ground_texture.h"
#include "shared/tone.h"
#include "verdure/error.h"

namespace verdure {
namespace {

constexpr vk::ImageAspectFlags kDepthAspect = vk::ImageAspectFlagBits::eDepth;

gpu::SetLayout makeFrameSet(const gpu::Device& device) {
  using Type = vk::DescriptorType;
  using Stage = vk::ShaderStageFlagBits;
  const Type image = Type::eCombinedImageSampler;
  return {device,
          {Type::eUniformBuffer, image, image, image, image, image, image, image},
          Stage::eVertex | Stage::eFragment};
}

vk::raii::DescriptorSetLayout makeMaterialSet(const gpu::Device& device) {
  using Type = vk::DescriptorType;
  return gpu::makeSetLayout(device,
                            std::array{Type::eCombinedImageSampler, Type::eCombinedImageSampler,
                                       Type::eCombinedImageSampler, Type::eCombinedImageSampler,
                                       Type::eCombinedImageSampler, Type::eCombinedImageSampler,
                                       Type::eCombinedImageSampler},
                            vk::ShaderStageFlagBits::eFragment);
}

/// What the ground and the sky are drawn with; each plant has more.
DrawKind kindOf(const View& view) {
  const Sky* sky = view.daylight.sky.get();
  return {.ambient_source = view.terms.ambient_source,
          .formula_sky = sky != nullptr && sky->formula() != nullptr,
          .background = view.background.has_value()};
}

/// Weights for transfer vectors, in frame units.
std::vector<glm::vec2> transferWeights(const FrameLight& light, float angular_radius, float units) {
  const auto prepared = [units](const Harmonics& h) {
    Harmonics mirrored = mirroredAtHorizon(h);
    for (glm::vec3& weight : mirrored.weights) weight *= units;
    return mirrored;
  };
  return packWeights(
      prepared(light.sky),
      prepared(diskHarmonics(light.to_sun, angular_radius, light.sun_disk, kMostBounceBands)));
}

}  // namespace

FrameLayout::FrameLayout(const gpu::Device& device, vk::DescriptorSetLayout motion_set)
    : frame_set(makeFrameSet(device)),
      material_set(makeMaterialSet(device)),
      pipeline(gpu::makePipelineLayout(device,
                                       std::array{*frame_set.layout, *material_set, motion_set},
                                       vk::ShaderStageFlagBits::eFragment,
                                       sizeof(shared::DrawUniforms), sizeof(std::uint32_t))) {}

FrameDrawer::FrameDrawer(const gpu::Device& device)
    : device_(&device),
      forest_pass_(device),
      motion_pass_(device),
      layout_(device, *motion_pass_.layouts().vertex.layout),
      impostor_pass_(device, *layout_.frame_set.layout, forest_pass_.layouts()),
      transfer_pass_(device),
      shadow_pass_(),
      blocker_pass_(device),
      grass_pass_(device, *layout_.frame_set.layout),
      grass_blades_(device, *layout_.frame_set.layout, grass_pass_.setLayout()),
      grass_billboards_(device, *layout_.frame_set.layout, grass_pass_.setLayout()),
      exposure_pass_(device),
      bloom_pass_(device),
      tone_pass_(device),
      timers_(device, 5),
      frame_set_(device, layout_.frame_set),
      sky_image_(device),
      ground_light_(device) {
  gpu::Upload upload(device);
  ground_texture_ =
      upload.texture(buildColorMips(makeGroundTexture(look::kGroundTextureSize), {}).levels,
                     vk::Format::eR8G8B8A8Srgb);
  ground_noise_ = upload.texture(buildLinearMips(makeGroundNoise(look::kGroundNoiseSize)).levels,
                                 vk::Format::eR8G8B8A8Unorm);
  upload.finish();
  // No anisotropic filter: ground_pass.frag takes several taps along a grazing footprint itself.
  using Beyond = vk::SamplerAddressMode;
  ground_sampler_ = gpu::makeSampler(device, vk::Filter::eLinear, Beyond::eRepeat);
  edge_sampler_ = gpu::makeSampler(device, vk::Filter::eLinear, Beyond::eClampToEdge);
  foliage_sampler_ = device.raii().createSampler({.magFilter = vk::Filter::eLinear,
                                                  .minFilter = vk::Filter::eLinear,
                                                  .addressModeU = Beyond::eClampToEdge,
                                                  .addressModeV = Beyond::eClampToEdge});
  texel_sampler_ = gpu::makeSampler(device, vk::Filter::eNearest, Beyond::eClampToEdge);
  sky_sampler_ = device.raii().createSampler({.magFilter = vk::Filter::eLinear,
                                              .minFilter = vk::Filter::eLinear,
                                              .addressModeU = Beyond::eRepeat,
                                              .addressModeV = Beyond::eClampToEdge});
  // Bilinear comparison where the device has it for this format; else half-shadows have steps.
  const bool smooth =
      bool(device.physical().getFormatProperties(FrameLayout::kDepth).optimalTilingFeatures &
           vk::FormatFeatureFlagBits::eSampledImageFilterLinear);
  const vk::Filter filter = smooth ? vk::Filter::eLinear : vk::Filter::eNearest;
  shadow_sampler_ = device.raii().createSampler({.magFilter = filter,
                                                 .minFilter = filter,
                                                 .addressModeU = Beyond::eClampToEdge,
                                                 .addressModeV = Beyond::eClampToEdge,
                                                 .compareEnable = true,
                                                 .compareOp = vk::CompareOp::eLessOrEqual});
  uniforms_ = gpu::makeBuffer(device, sizeof(shared::FrameUniforms),
                              vk::BufferUsageFlagBits::eUniformBuffer, gpu::MemoryUse::kToGpu);
  frame_set_.setBuffer(0, uniforms_);
  frame_set_.setTexture(2, ground_texture_, *ground_sampler_);
  frame_set_.setTexture(3, ground_noise_, *ground_sampler_);
  frame_set_.setTexture(5, ground_light_.texture(), *edge_sampler_);
}

void FrameDrawer::checkView(const View& view) const {
  const vk::PhysicalDeviceLimits& limits = device_->limits();
  const auto most = static_cast<int>(
      std::min({limits.maxFramebufferWidth, limits.maxFramebufferHeight, limits.maxImageDimension2D,
                limits.maxViewportDimensions[0], limits.maxViewportDimensions[1], 1u << 20}));
  const auto check = [most](const char* what, int value, int least) {
    if (value < least || value > most)
      throw Error("view",
                  std::string(what) + " is " + std::to_string(value) + ", not between " +
                      std::to_string(least) + " and the device's " + std::to_string(most),
                  "choose another size");
  };
  check("width", view.width, 1);
  check("height", view.height, 1);
  check("shadow_map_size", view.shadow_map_size, 16);
  const auto demand = [](bool good, const char* what, const char* range) {
    if (!good) throw Error("view", std::string(what) + " is out of range", range);
  };
  demand(view.shadow_cascades >= 0 && view.shadow_cascades <= shared::kMostCascades,
         "shadow_cascades", "choose 1 to 4, or 0 for as many as the view needs");
  demand(view.sky_bands >= 2 && view.sky_bands <= kMaxBands, "sky_bands", "choose 2 to 7");
  demand(view.exposure.key > 0.0f && std::isfinite(view.exposure.key), "exposure.key",
         "choose a number above 0");
  const float white = view.exposure.white.value_or(1.0f);
  demand(white > 0.0f && std::isfinite(white), "exposure.white", "choose a number above 0");
  demand(!view.exposure.ev || std::abs(*view.exposure.ev) <= 40.0f, "exposure.ev",
         "choose -40 to 40");
  demand(view.bloom >= 0.0f && view.bloom <= 1.0f, "bloom", "choose 0 to 1");
  if (view.hdr && view.style != Style::kPhoto)
    throw Error("view", "a drawn style has no light to give", "ask for hdr with Style::kPhoto");
  demand(view.visibility_exponent > 0.0f && std::isfinite(view.visibility_exponent),
         "visibility_exponent", "choose a number above 0");
  demand(std::isfinite(view.seconds) && (!view.last || std::isfinite(view.last->seconds)),
         "seconds", "give a finite time");
  checkWind(view.wind);
  if (view.last) checkWind(view.last->wind);
  const glm::vec3& sun = view.daylight.sun.direction;
  demand(std::abs(glm::length(sun) - 1.0f) < 1e-3f, "the direction of the sun",
         "make it a unit vector");
}

bool FrameDrawer::resize(const View& view) {
  if (targets_ && targets_->fits(view.width, view.height)) return false;
  targets_.reset();
  if (style_pass_) style_pass_->forgetTargets();
  targets_.emplace(*device_, static_cast<std::uint32_t>(view.width),
                   static_cast<std::uint32_t>(view.height));
  exposure_pass_.setSource(targets_->resolved);
  bloom_pass_.setSource(targets_->resolved);
  tone_pass_.setSource(targets_->color, bloom_pass_.result(), exposure_pass_.result());
  return true;
}

std::vector<Cascade> FrameDrawer::cascadesOf(const GpuScene& scene, const View& view) {
  const auto size = static_cast<std::uint32_t>(view.shadow_map_size);
  std::vector<Cascade> cascades =
      fitCascades({.camera = cascade_trial_.camera.value_or(view.camera),
                   .width = view.width,
                   .height = view.height,
                   .bounds = scene.casterBounds(view.camera.eye),
                   .to_sun = view.daylight.sun.direction,
                   .size = view.shadow_map_size,
                   .count = view.terms.shadow ? view.shadow_cascades : 1,
                   .snap = cascade_trial_.snap});
  // Layers that are there stay when fewer are needed: the next frame may need them again.
  const auto layers = static_cast<std::uint32_t>(cascades.size());
  bool other_maps = false;
  if (!shadow_maps_ || shadow_maps_->request.width != size ||
      shadow_maps_->request.layers < layers) {
    using Usage = vk::ImageUsageFlagBits;
    shadow_maps_.reset();
    shadow_maps_ =
        gpu::makeTexture(*device_, {.format = FrameLayout::kDepth,
                                    .width = size,
                                    .height = size,
                                    .layers = layers,
                                    .usage = Usage::eDepthStencilAttachment | Usage::eSampled,
                                    .aspect = kDepthAspect});
    frame_set_.setTexture(1, *shadow_maps_, *shadow_sampler_);
    other_maps = true;
  }
  // A single texel stands in where leaves are in the shadow map.
  const bool depth_maps = view.terms.shadow_source != ShadowSource::kShadowMap;
  const std::uint32_t foliage_size = depth_maps ? size : 1;
  if (!foliage_maps_ || foliage_maps_->request.width != foliage_size ||
      foliage_maps_->request.layers < layers) {
    using Usage = vk::ImageUsageFlagBits;
    foliage_maps_.reset();
    foliage_maps_ =
        gpu::makeTexture(*device_, {.format = FrameLayout::kFoliageDepth,
                                    .width = foliage_size,
                                    .height = foliage_size,
                                    .layers = layers,
                                    .usage = Usage::eColorAttachment | Usage::eSampled});
    frame_set_.setTexture(6, *foliage_maps_, *foliage_sampler_);
    other_maps = true;
  }
  if (other_maps) {
    blocker_pass_.setSources(*foliage_maps_, *shadow_maps_, *foliage_sampler_, *texel_sampler_);
    frame_set_.setTexture(7, blocker_pass_.result(), *foliage_sampler_);
  }
  return cascades;
}

const Harmonics& FrameDrawer::skyOf(const View& view) {
  const int bands = std::max(view.sky_bands, 3);  // three light unshadowed surfaces
  if (known_harmonics_.bands != bands || known_sky_ != view.daylight.sky) {
    known_sky_ = view.daylight.sky;
    known_harmonics_ = known_sky_ ? projectSky(*known_sky_, bands) : Harmonics{bands, {}};
  }
  return known_harmonics_;
}

shared::FrameUniforms FrameDrawer::makeUniforms(const GpuScene& scene, const View& view,
                                                const FrameLight& light, float units,
                                                const std::vector<Cascade>& cascades) const {
  shared::FrameUniforms u{};
  const float aspect = static_cast<float>(view.width) / static_cast<float>(view.height);
  const CameraRays rays = cameraRays(view.camera, aspect);
  u.clip_from_world = clipFromWorld(view.camera, aspect);
  u.last_clip_from_world = view.last ? clipFromWorld(view.last->camera, aspect) : u.clip_from_world;
  u.eye = glm::vec4(rays.eye, units);
  u.ray_right = glm::vec4(rays.right, 2.0f / static_cast<float>(view.width));
  u.ray_down = glm::vec4(rays.down, 2.0f / static_cast<float>(view.height));
  u.ray_forward = glm::vec4(rays.forward, 0.0f);
  for (std::size_t i = 0; i < cascades.size(); ++i) {
    const Cascade& next = cascades[std::min(i + 1, cascades.size() - 1)];
    u.shadow_from_world[i] = cascades[i].shadow_from_world;
    u.cascade[i] = glm::vec4(cascades[i].texel_m, next.texel_m / cascades[i].texel_m,
                             glm::vec2(cascades[i].origin));
  }
  u.to_sun = glm::vec4(light.to_sun, cascades.size());
  u.sun_light = glm::vec4(light.sun * units, 1.0f / static_cast<float>(view.shadow_map_size));
  u.sun_disk = glm::vec4(light.sun_disk * units, view.daylight.sun.angular_radius);
  u.open_sky = glm::vec4(light.open_sky * units, view.visibility_exponent);
  for (std::size_t i = 0; i < 9; ++i)
    u.open_light[i] = glm::vec4(light.open_light.weights[i] * units, 0.0f);
  const float distance = glm::length(view.camera.eye - view.camera.target);
  const float haze = std::max(look::kHazeHalf * distance, look::kHazeHalfLeast_m);
  u.ground = glm::vec4(scene.groundHeight(), look::kGroundRadius * haze, haze, look::kGroundTile_m);
  u.ground_map = glm::vec4(ground_light_.place(), 0.0f);
  u.leaf_tint = glm::vec4(scene.leafTint(), 0.0f);
  if (view.daylight.sky != nullptr && view.daylight.sky->formula() != nullptr)
    u.sky = *view.daylight.sky->formula();
  return u;
}

void FrameDrawer::recordColor(const vk::raii::CommandBuffer& commands, const GpuScene& scene,
                              const View& view, const DrawKind& kind) const {
  gpu::imageBarrier(commands, *targets_->color.image, gpu::kColorAspect, gpu::Use::kUndefined,
                    gpu::Use::kColorAttachment);
  gpu::imageBarrier(commands, *targets_->resolved.image, gpu::kColorAspect, gpu::Use::kUndefined,
                    gpu::Use::kColorAttachment);
  gpu::imageBarrier(commands, *targets_->depth.image, kDepthAspect, gpu::Use::kUndefined,
                    gpu::Use::kDepthAttachment);
  if (inspection_ != Inspection::kNothing) {
    beginColor(commands, view, true, true);
    inspect_pass_.record(commands, layout_, *frame_set_, scene, view.terms, inspection_);
    commands.endRendering();
    return;
  }
  const bool terrain = scene.terrain() != nullptr;
  const bool billboards = terrain && billboard_trial_;
  const bool photo = view.style == Style::kPhoto;  // the drawn styles draw plants themselves
  const GpuForest* forest = photo ? scene.forest() : nullptr;
  beginColor(commands, view, true, (!terrain || billboards) && forest == nullptr);
  if (photo) plant_pass_.record(commands, layout_, *frame_set_, scene, view.terms, kind, false);
  if (forest != nullptr) {
    commands.endRendering();
    if (forest->hides())
      forest_pass_.recordBehind(commands, *forest, targets_->depth);
    else
      gpu::imageBarrier(commands, *targets_->depth.image, kDepthAspect, gpu::Use::kDepthAttachment,
                        gpu::Use::kDepthAttachment);
    gpu::imageBarrier(commands, *targets_->color.image, gpu::kColorAspect,
                      gpu::Use::kColorAttachment, gpu::Use::kColorAttachment);
    beginColor(commands, view, false, !terrain || billboards);
    plant_pass_.record(commands, layout_, *frame_set_, scene, view.terms, kind, true);
    impostor_pass_.record(commands, *frame_set_, *forest, view.terms, kind);
  }
  if (terrain && !billboards)
    grass_blades_.record(commands, *frame_set_, *scene.terrain(), view.terms, kind);
  backdrop_pass_.record(commands, layout_, *frame_set_, view.terms, kind,
                        scene.ground() && !terrain);
  if (billboards)
    grass_billboards_.record(commands, *frame_set_, *scene.terrain(), grass_pass_.nodeCount());
  commands.endRendering();
  if (!terrain || billboards) return;
  grass_pass_.recordDepthRange(commands, targets_->depth);
  gpu::imageBarrier(commands, *targets_->color.image, gpu::kColorAspect, gpu::Use::kColorAttachment,
                    gpu::Use::kColorAttachment);
  beginColor(commands, view, false, true);
  grass_pass_.record(commands, *frame_set_, *scene.terrain(), view.terms, kind);
  commands.endRendering();
}

void FrameDrawer::beginColor(const vk::raii::CommandBuffer& commands, const View& view, bool first,
                             bool last) const {
  const vk::AttachmentLoadOp load =
      first ? vk::AttachmentLoadOp::eClear : vk::AttachmentLoadOp::eLoad;
  vk::RenderingAttachmentInfo color{
      .imageView = *targets_->color.view,
      .imageLayout = vk::ImageLayout::eColorAttachmentOptimal,
      .loadOp = load,
      .storeOp = vk::AttachmentStoreOp::eStore,  // the tone pass reads the samples
      .clearValue = vk::ClearValue(vk::ClearColorValue(std::array{0.0f, 0.0f, 0.0f, 0.0f}))};
  if (last) {
    color.resolveMode = vk::ResolveModeFlagBits::eAverage;
    color.resolveImageView = *targets_->resolved.view;
    color.resolveImageLayout = vk::ImageLayout::eColorAttachmentOptimal;
  }
  const vk::RenderingAttachmentInfo depth{
      .imageView = *targets_->depth.view,
      .imageLayout = vk::ImageLayout::eDepthAttachmentOptimal,
      .loadOp = load,
      .storeOp = last && view.style == Style::kPhoto ? vk::AttachmentStoreOp::eDontCare
                                                     : vk::AttachmentStoreOp::eStore,
      .clearValue = vk::ClearValue(vk::ClearDepthStencilValue{.depth = 0.0f})};
  const vk::Rect2D area{.extent = {targets_->color.request.width, targets_->color.request.height}};
  commands.beginRendering({.renderArea = area,
                           .layerCount = 1,
                           .colorAttachmentCount = 1,
                           .pColorAttachments = &color,
                           .pDepthAttachment = &depth});
  commands.setViewport(0, vk::Viewport{.width = static_cast<float>(area.extent.width),
                                       .height = static_cast<float>(area.extent.height),
                                       .maxDepth = 1.0f});
  commands.setScissor(0, area);
}

void FrameDrawer::recordTone(const vk::raii::CommandBuffer& commands, const View& view,
                             float units) const {
  gpu::imageBarrier(commands, *targets_->color.image, gpu::kColorAspect, gpu::Use::kColorAttachment,
                    gpu::Use::kFragmentSampled);
  gpu::imageBarrier(commands, *targets_->resolved.image, gpu::kColorAspect,
                    gpu::Use::kColorAttachment, gpu::Use::kComputeSampled);
  if (!view.exposure.ev || !view.exposure.white)
    exposure_pass_.record(commands, look::kLeastLuminance * units);
  gpu::imageBarrier(commands, *targets_->resolved.image, gpu::kColorAspect,
                    gpu::Use::kComputeSampled, gpu::Use::kFragmentSampled);
  bloom_pass_.record(commands, view.bloom > 0.0f);
  tone_pass_.record(
      commands, view.style == Style::kPhoto ? targets_->picture : style_pass_->backdrop(),
      {.background = glm::vec4(view.background.value_or(glm::vec3(0.0f)), 0.0f),
       .key = view.exposure.key,
       .white = view.exposure.white.value_or(0.0f),
       .average = view.exposure.ev ? shared::meteredLuminance(*view.exposure.ev) * units : 0.0f,
       .bloom = view.bloom});
}

Frame FrameDrawer::draw(GpuScene& scene, const View& view, const gpu::Texture* target) {
  checkView(view);
  const bool new_targets = resize(view);
  scene.setWind(view.wind, view.last ? std::optional(view.last->wind) : std::nullopt);
  const FrameLight light = makeFrameLight(view, skyOf(view), scene.ground());
  sky_image_.look(view.daylight.sky);
  const float units = frameUnits(std::max(light.brightest, sky_image_.brightest()));
  if (sky_image_.fill(units)) frame_set_.setTexture(4, sky_image_.texture(), *sky_sampler_);
  std::vector<glm::vec2> weights;
  if (view.terms.ambient_source == AmbientSource::kTransfer) {
    weights = transferWeights(light, view.daylight.sun.angular_radius, units);
    ground_light_.update(scene.grounds(), scene_id_, weights, light.open_sky * units);
  }
  const std::vector<Cascade> cascades = cascadesOf(scene, view);
  const shared::FrameUniforms uniforms = makeUniforms(scene, view, light, units, cascades);
  std::memcpy(uniforms_.memory.mapped(), &uniforms, sizeof(uniforms));
  const DrawKind kind = kindOf(view);
  const bool depth_maps = view.terms.shadow_source != ShadowSource::kShadowMap;
  if (view.last) velocity_pass_.prepare(*device_, layout_, scene, view.width, view.height);
  if (!depth_maps) shadow_pass_.prepare(*device_, layout_, scene);
  if (depth_maps) light_depth_pass_.prepare(*device_, layout_, scene, view.terms);
  const bool photo = view.style == Style::kPhoto;
  if (photo) plant_pass_.prepare(*device_, layout_, scene, view.terms, kind);
  if (inspection_ != Inspection::kNothing)
    inspect_pass_.prepare(*device_, layout_, scene, view.terms, inspection_);
  if (scene.forest() != nullptr) {
    scene.forest()->look(
        view, cascades, scene.terrain() != nullptr ? &scene.terrain()->terrain() : nullptr,
        std::min(scene.bounds().min.y,
                 scene.terrain() != nullptr ? scene.terrain()->lowest() : scene.groundHeight()),
        photo && inspection_ == Inspection::kNothing);
    forest_pass_.prepare(*scene.forest(), targets_->depth);
    impostor_pass_.prepare(view.terms, kind, depth_maps);
    if (view.last) impostor_pass_.prepareVelocity(VelocityPass::kFormat);
  }
  if (!photo && !style_pass_)
    style_pass_.emplace(*device_, layout_, *motion_pass_.layouts().vertex.layout);
  if (!photo) style_pass_->prepare(scene, view, targets_->depth, impostor_pass_, uniforms.ground.z);
  backdrop_pass_.prepare(*device_, layout_, view.terms, kind, scene.ground());
  if (scene.terrain() != nullptr)
    grass_pass_.prepare(*scene.terrain(), view, targets_->depth, new_targets, kind,
                        uniforms.ground.y);
  if (scene.terrain() != nullptr && view.last)
    grass_pass_.prepareVelocity(*scene.terrain(), VelocityPass::kFormat);
  if (scene.terrain() != nullptr) grass_blades_.prepare(*scene.terrain(), view, kind);
  if (scene.terrain() != nullptr && billboard_trial_)
    grass_billboards_.prepare(*scene.terrain(), view, kind, *billboard_trial_);

  device_->submit([&](const vk::raii::CommandBuffer& commands) {
    timers_.reset(commands);
    timers_.stamp(commands, 0);
    if (scene.forest() != nullptr) forest_pass_.record(commands, *scene.forest());
    if (scene.moves())
      motion_pass_.record(commands, scene.motion(), view.wind, view.seconds, false);
    if (scene.moves() && view.last)
      motion_pass_.record(commands, scene.motion(), view.last->wind, view.last->seconds, true);
    timers_.stamp(commands, 1);
    sky_image_.record(commands);
    ground_light_.record(commands);
    if (!weights.empty()) transfer_pass_.record(commands, scene.transfer(), std::move(weights));
    const auto cascade_count = static_cast<std::uint32_t>(cascades.size());
    if (depth_maps) {
      light_depth_pass_.record(commands, layout_, *frame_set_, scene, *shadow_maps_, *foliage_maps_,
                               impostor_pass_, cascade_count, view.terms);
    } else {
      shadow_pass_.record(commands, layout_, *frame_set_, scene, *shadow_maps_, impostor_pass_,
                          cascade_count, view.terms.shadow);
      gpu::imageBarrier(commands, *foliage_maps_->image, gpu::kColorAspect, gpu::Use::kUndefined,
                        gpu::Use::kFragmentSampled);
    }
    blocker_pass_.record(commands, depth_maps ? cascade_count : 0);
    timers_.stamp(commands, 2);
    if (scene.terrain() != nullptr) grass_blades_.recordChoice(commands, *scene.terrain());
    recordColor(commands, scene, view, kind);
    timers_.stamp(commands, 3);
    recordTone(commands, view, units);
    if (!photo)
      style_pass_->record(commands, *frame_set_, scene, view, impostor_pass_, targets_->depth,
                          targets_->picture);
    timers_.stamp(commands, 4);
    if (view.last)
      velocity_pass_.record(commands, layout_, *frame_set_, scene, impostor_pass_, grass_pass_);
    if (target != nullptr)
      targets_->recordHandOver(commands, *target);
    else
      targets_->recordReadback(commands, view.hdr);
  });
  Frame frame;
  if (target == nullptr) frame.image = targets_->readPicture();
  if (target == nullptr && view.hdr) frame.hdr = targets_->readHdr(units);
  if (view.last)
    frame.motion = velocity_pass_.read(view.camera, view.last->camera,
                                       scene.ground() && scene.terrain() == nullptr
                                           ? std::optional(scene.groundHeight())
                                           : std::nullopt);
  const ExposurePass::Measured measured = exposure_pass_.measured();
  frame.average_luminance =
      view.exposure.ev ? shared::meteredLuminance(*view.exposure.ev) : measured.average / units;
  const float exposure =
      frame.average_luminance > 0.0f ? view.exposure.key / frame.average_luminance : 0.0f;
  frame.white =
      view.exposure.white.value_or(shared::automaticWhite(measured.bright / units * exposure));
  frame.shadow_cascades = static_cast<int>(cascades.size());
  frame.times.motion_ms = timers_.milliseconds(0, 1);
  frame.times.shadow_ms = timers_.milliseconds(1, 2);
  frame.times.color_ms = timers_.milliseconds(2, 3);
  frame.times.tone_ms = timers_.milliseconds(3, 4);
  return frame;
}

}  // namespace verdure
