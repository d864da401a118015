#ifndef VERDURE_RENDER_SCENE_H_
#define VERDURE_RENDER_SCENE_H_

#include <array>
#include <optional>
#include <vector>

#include "gpu/resources.h"
#include "render/gpu_forest.h"
#include "render/grass_pass.h"
#include "render/mipmaps.h"
#include "render/motion_pass.h"
#include "render/packed_forest.h"
#include "render/packed_motion.h"
#include "render/packed_transfer.h"
#include "render/terms.h"
#include "render/transfer_pass.h"
#include "shared/frame.h"
#include "verdure/render.h"

namespace verdure {

/// A unit normal times the ambient coefficient, 16 bits a component: the paper's encoding. The
/// fourth is packVisibility() of the leaf's front and back (shared/leaf_visibility.h). A vertex
/// with baked light is no larger than one without.
using PackedNormal = std::array<std::int16_t, 4>;
PackedNormal packNormal(const glm::vec3& unit_normal, float ambient,
                        const glm::vec2& visibility = glm::vec2(1.0f));

/// A place where a plant stands, as shaders read it.
struct PackedInstance {
  std::array<glm::vec4, 3> rows;       ///< of world_from_plant
  glm::uvec4 motion{0, 0, 0, kPlain};  ///< see instance.glsl
  static constexpr std::uint32_t kPlain = 0xffffffu | shared::kForestWhole << 24;
};

/// One mesh at all places of its item.
struct Draw {
  bool foliage = false;
  bool baked = false;       ///< has crown normals; else they are the mesh's own
  bool transfer = false;    ///< has transfer vectors
  bool visibility = false;  ///< has leaf visibility
  bool alpha_test = false;
  bool normal_map = false;
  bool thickness_map = false;
  bool leaf_maps = false;            ///< of its material
  bool stated_transmission = false;  ///< its material has DiffuseTransmission
  bool moving = false;               ///< in wind
  bool seen = true;                  ///< else it is drawn into the shadow map alone
  /// Of a forest: which of its draws; its instances are then what the GPU has chosen.
  std::optional<std::uint32_t> forest;
  std::uint32_t index_count = 0, first_index = 0;
  std::int32_t vertex_offset = 0;
  std::uint32_t instance_count = 0, first_instance = 0;
  std::uint32_t material = 0;  ///< index into PackedScene::materials
  shared::DrawUniforms uniforms{};
};

/// A texture to upload; equal ones are packed once.
struct TextureJob {
  enum class Kind { kColor, kAlphaCut, kLinear, kAlpha };  ///< the last: alpha as grey
  const Image* image = nullptr;
  Kind kind = Kind::kColor;
  float cutoff = 0.0f;
  auto operator<=>(const TextureJob&) const = default;
};

/// The textures that a draw binds, and how they repeat. Index 0 of a texture is plain white (base
/// colour, thickness, transmission) or flat (normal map).
struct MaterialSlot {
  std::uint32_t base_color = 0;
  std::uint32_t normal_map = 0;
  std::uint32_t thickness_map = 0;
  std::uint32_t leaf_colors = 0, leaf_vectors = 0;  ///< into PackedScene::leaf_arrays
  std::array<bool, 2> base_clamp{};                 ///< u, v
  std::array<bool, 2> normal_clamp{};
  std::array<bool, 2> thickness_clamp{};
  std::uint32_t transmission_share = 0, transmission_color = 0;
  std::array<bool, 2> share_clamp{}, tint_clamp{};
  auto operator<=>(const MaterialSlot&) const = default;
};

/// Three of a leaf's maps as layers of one texture. Colours: the back's albedo, translucency of the
/// front and of the back. Vectors: the back's normals, coefficients of the front and of the back.
struct PackedLeafArray {
  std::array<std::vector<gpu::MipLevel>, 3> layers;
  bool linear = false;
};

/// The transfer vectors of the ground around a plant, and where such plants stand.
struct PackedGround {
  GroundTransfer transfer;
  int bands = 0, bounce_bands = 0;
  std::vector<glm::vec2> places;  ///< x, z of each instance's origin
};

/// A scene as arrays for the GPU. Coordinates are relative to the origin of the first item's plant.
struct PackedScene {
  std::vector<glm::vec3> positions;
  std::vector<PackedNormal> leaf_normals;   ///< the mesh's normals times k
  std::vector<PackedNormal> crown_normals;  ///< the baked normals times k; empty without bakes
  std::vector<glm::vec2> uvs;
  std::vector<std::uint32_t> indices;
  std::vector<PackedInstance> instances;
  std::vector<Draw> draws;  ///< wood first: it hides the most
  std::vector<MipChain> textures;
  std::vector<bool> texture_is_linear;
  std::vector<MaterialSlot> materials;
  std::vector<PackedLeafArray> leaf_arrays;  ///< the first two stand in where there are none
  std::vector<PackedTransfer> transfers;
  std::vector<PackedGround> grounds;
  PackedMotions motions;
  Bounds bounds;  ///< of all instances, at rest
  bool ground = false;
  float ground_height = 0.0f;
  glm::vec3 leaf_tint{1.0f};             ///< leafTint() of all foliage, mean over its vertices
  std::optional<PackedTerrain> terrain;  ///< instead of the plane of the ground
  std::optional<PackedForest> forest;
};

/// Extends `all` by what is in the box of a plant at this place.
void growBounds(const Bounds& box, const PackedInstance& place, Bounds& all);

/// Throws Error for a null plant, arrays of different lengths, indices out of range, transfer
/// vectors of a plant that is turned or scaled.
PackedScene packScene(const Scene& scene);

struct PackedLight;

/// The layouts of all descriptor sets that a scene has: FrameDrawer's.
struct SceneLayouts {
  vk::DescriptorSetLayout material;
  const gpu::SetLayout& transfer;
  const MotionLayouts& motion;
  const gpu::SetLayout& grass;
  const ForestLayouts& forest;
};

/// A packed scene on the GPU, with a descriptor set for each material (set 1: base colour, normal
/// map, thickness, colours and vectors of leaves, share and colour of what is transmitted).
class GpuScene {
 public:
  GpuScene(const gpu::Device& device, PackedScene packed, const SceneLayouts& layouts);

  /// Another bake of the same items, all of which had light; false, and nothing changes, where it
  /// has not as many vertices.
  bool setLight(const gpu::Device& device, const PackedLight& light);
  /// Binds all vertex streams and the index buffer; the normals are those asked for.
  void bindVertices(const vk::raii::CommandBuffer& commands, NormalSource normals) const;
  const std::vector<Draw>& draws() const { return draws_; }
  /// Draws one of them with the bound pipeline, of `layout`. `view`: whose trees of a forest.
  void record(const vk::raii::CommandBuffer& commands, vk::PipelineLayout layout,
              vk::DescriptorSet frame_set, const Draw& draw, std::uint32_t view) const;
  /// All of it that the picture shows.
  void recordSeen(const vk::raii::CommandBuffer& commands, vk::PipelineLayout layout,
                  vk::DescriptorSet frame_set, const Draw& draw) const;
  /// From now on; without wind, plants that could move are drawn as those that cannot.
  void setWind(const Wind& wind, const std::optional<Wind>& last);
  /// Of all that may move in the wind that was set, but for the forest.
  const Bounds& bounds() const { return bounds_; }
  /// And of what casts shadows of the forest, seen from `eye`.
  Bounds casterBounds(const glm::vec3& eye) const;
  const GpuMotion& motion() const { return *motion_; }
  /// Whether anything does in the wind that was set.
  bool moves() const { return bounds_wind_.has_value(); }
  bool ground() const { return ground_; }
  float groundHeight() const { return ground_height_; }
  const glm::vec3& leafTint() const { return leaf_tint_; }
  const std::vector<PackedGround>& grounds() const { return grounds_; }
  GpuTransfer& transfer() { return *transfer_; }
  /// The forest, or null.
  GpuForest* forest() { return forest_ ? &*forest_ : nullptr; }
  const GpuForest* forest() const { return forest_ ? &*forest_ : nullptr; }
  /// What is drawn instead of the plane of the ground, or null.
  GpuTerrain* terrain() { return terrain_ ? &*terrain_ : nullptr; }
  const GpuTerrain* terrain() const { return terrain_ ? &*terrain_ : nullptr; }

  /// Vertex bindings 0..4 and attributes: position, normal, uv, the instance (rows, motion), light
  /// from transfer vectors (front, back). Without `transfer` every vertex reads the first one's
  /// light.
  static std::vector<vk::VertexInputBindingDescription> bindings(bool transfer);
  static std::vector<vk::VertexInputAttributeDescription> attributes();
  /// Of these, positions, texture coordinates and instances.
  static std::vector<vk::VertexInputAttributeDescription> shapeAttributes();
  /// What shaders of such passes are specialised by.
  static gpu::Constants shapeConstants(const Draw& draw);

 private:
  gpu::Buffer positions_, leaf_normals_, crown_normals_, uvs_, indices_, instances_;
  bool has_crown_normals_ = false;
  std::vector<gpu::Texture> textures_, leaf_arrays_;
  std::vector<vk::raii::Sampler> samplers_;  ///< [clamp_u + 2 clamp_v]
  vk::raii::DescriptorPool pool_ = nullptr;
  std::vector<vk::raii::DescriptorSet> material_sets_;
  std::optional<GpuTransfer> transfer_;
  std::optional<GpuMotion> motion_;
  std::vector<PackedMotion> moving_items_;
  std::vector<PackedInstance> places_;  ///< of all items
  std::vector<bool> can_move_;          ///< of each draw
  std::vector<Draw> draws_;
  std::vector<PackedGround> grounds_;
  Bounds rest_bounds_, bounds_;
  std::optional<Wind> bounds_wind_;  ///< that bounds_ are for; unset: at rest
  std::optional<GpuTerrain> terrain_;
  std::optional<GpuForest> forest_;
  bool any_items_ = false;
  bool ground_ = false;
  float ground_height_ = 0.0f;
  glm::vec3 leaf_tint_{1.0f};
};

}  // namespace verdure

#endif  // VERDURE_RENDER_SCENE_H_
