#ifndef VERDURE_PLANT_H_
#define VERDURE_PLANT_H_

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "verdure/image.h"

namespace verdure {

enum class AlphaMode { kOpaque, kMask, kBlend };

/// What is known of a leaf's two sides beyond base colour and normal map, which are the front's
/// (Habel 2009, chapter 3). Indices into Plant::textures, all of one size and read at the same
/// places as those.
struct LeafTextures {
  int back_color = -1;          ///< albedo of the back, sRGB
  int back_normal = -1;         ///< as normal_texture, but blue is out of the back
  int front_translucency = -1;  ///< rho_t: colour of light that leaves the front, sRGB
  int back_translucency = -1;   ///< of light that leaves the back
  /// Coefficients of the Half-Life 2 basis (shared/leaf_basis.h) of light that leaves each side:
  /// offset + scale * texel.
  int front_light = -1, back_light = -1;
  float front_scale = 1.0f, front_offset = 0.0f, back_scale = 1.0f, back_offset = 0.0f;
  /// Cook and Torrance's m of each side's gloss, 0 = none, and its refractive index (LeafOptics).
  float front_roughness = 0.3f, back_roughness = 0.0f, refractive_index = 1.45f;
};

/// Light through leaves as glTF states it (KHR_materials_diffuse_transmission): `factor` of all
/// diffuse light goes through, in a colour of its own; the rest is reflected in the base colour.
struct DiffuseTransmission {
  float factor = 0.0f;      ///< [0, 1]
  int factor_texture = -1;  ///< index into Plant::textures: its alpha times that
  glm::vec3 color{1.0f};    ///< linear RGB, [0, 1]
  int color_texture = -1;   ///< index into Plant::textures (sRGB): times that
};

/// The clear surface over a colour as glTF states it (KHR_materials_ior, KHR_materials_specular).
struct ClearSurface {
  float refractive_index = 1.5f;  ///< at least 1
  float strength = 1.0f;          ///< [0, 1], of all that it reflects
  glm::vec3 color{1.0f};          ///< linear RGB, at least 0: of what it reflects squarely
  bool operator==(const ClearSurface&) const = default;
};

/// How a surface looks, in the terms of glTF that verdure uses.
struct Material {
  std::string name;
  glm::vec4 base_color{1.0f};   ///< linear RGB and alpha, multiplies the texture
  int base_color_texture = -1;  ///< index into Plant::textures (sRGB), -1 = none
  int normal_texture = -1;      ///< index into Plant::textures (linear, tangent space, +Y up)
  float normal_scale = 1.0f;
  /// How many mean free paths thick a leaf is, 0 = unknown: thickness over attenuation distance of
  /// KHR_materials_volume.
  float optical_thickness = 0.0f;
  int thickness_texture =
      -1;  ///< index into Plant::textures (linear): its green channel times that
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
  std::optional<LeafTextures> leaf = {};  ///< of foliage only
  /// Of foliage without `leaf`; not set: guessed from its colour (shared/leaf.h).
  std::optional<DiffuseTransmission> transmission = {};
  ClearSurface surface = {};  ///< its gloss; that of `leaf` is its own
};

struct Texture {
  std::string name;
  Image image;
  bool clamp_u = false;  ///< else repeats
  bool clamp_v = false;
};

enum class PartKind {
  kWood,    ///< trunk, branches and whatever else is not foliage: keeps its normals
  kFoliage  ///< leaves, needles, flowers: generators of the density field
};

/// One piece of one material. Positions are metres, +Y up, relative to Plant::origin;
/// counter-clockwise triangles face the viewer. Vertex arrays have equal length or are empty.
struct Mesh {
  std::string name;
  PartKind kind = PartKind::kWood;
  std::uint32_t material = 0;
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  ///< unit; always present after loading or growing
  std::vector<glm::vec2> uvs;      ///< glTF convention: (0,0) = top left of the image; may be empty
  std::vector<std::uint32_t> indices;  ///< three per triangle
  /// Ambient coefficients of an earlier bake, [0, 1], from the file's `_AO`; empty if it has none.
  std::vector<float> ambient;
  /// Of an earlier bake, from the file's `_VISIBILITY`: how much of the front and of the back of
  /// each vertex's leaf is seen from around, [0, 1]; empty if it has none.
  std::vector<glm::vec2> visibility;
  /// Wood only: the branch (index into Plant::branches) of each vertex; empty if unknown.
  std::vector<std::uint32_t> branch_of_vertex;

  std::size_t triangleCount() const { return indices.size() / 3; }
};

inline constexpr std::uint32_t kNone = 0xffffffffu;

/// One leaf (or one card of several leaves): a connected component of a foliage mesh after welding
/// by position.
struct Leaf {
  std::uint32_t mesh = 0;            ///< index into Plant::meshes
  std::uint32_t first_triangle = 0;  ///< range in Plant::leaf_triangles
  std::uint32_t triangle_count = 0;
  std::uint32_t branch = kNone;  ///< the branch that carries it, kNone if unknown
  glm::vec3 centroid{0.0f};      ///< area-weighted
  float area = 0.0f;             ///< one side, m^2
  glm::vec3 stalk{0.0f};         ///< where it is attached
};

struct BranchPoint {
  glm::vec3 position{0.0f};
  float radius = 0.0f;
};

/// One stem: a polyline with radii. The trunk has level 0 and no parent.
struct Branch {
  std::uint32_t parent = kNone;  ///< index into Plant::branches, always below its own index
  int level = 0;
  float parent_offset = 0.0f;       ///< where it leaves the parent: 0 = parent's base, 1 = its tip
  std::vector<BranchPoint> points;  ///< base to tip, at least 2
};

/// The document that a plant was loaded from, kept so that export changes nothing that a bake does
/// not change. Defined in the plant room.
struct SourceDocument;

/// A plant as plain data.
struct Plant {
  std::string name;
  glm::dvec3 origin{0.0};  ///< added to every position; not 0 for plants far from the origin
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Leaf> leaves;
  std::vector<std::uint32_t> leaf_triangles;  ///< triangle numbers within the leaf's mesh
  std::vector<Branch> branches;               ///< empty where the hierarchy is unknown
  std::vector<std::string> notes;             ///< one line each: what loading found out or mended
  std::shared_ptr<const SourceDocument> source;  ///< null for grown plants
};

struct Bounds {
  glm::vec3 min{0.0f};
  glm::vec3 max{0.0f};
  glm::vec3 center() const { return 0.5f * (min + max); }
  glm::vec3 size() const { return max - min; }
};

/// Bounds of all vertices, or of those of one kind. All zero when there are none.
Bounds bounds(const Plant& plant);
Bounds bounds(const Plant& plant, PartKind kind);

std::size_t vertexCount(const Plant& plant);
std::size_t triangleCount(const Plant& plant);

/// Bytes held by the plant's arrays and images (not its source document).
std::size_t memoryBytes(const Plant& plant);

/// Finds the leaves of every foliage mesh: connected components after welding by position (vertices
/// closer than 1e-6 of the mesh's size are one). Fills Plant::leaves and leaf_triangles, ordered by
/// mesh and first triangle. The stalk point is the vertex nearest to the wood, or, without wood,
/// the one farthest from the leaf's centroid towards the plant's axis. Deterministic for any number
/// of threads.
void findLeaves(Plant& plant);

/// Finds the branches of any plant: fills Plant::branches, Mesh::branch_of_vertex of wood and
/// Leaf::branch; what they held is lost. A glTF skin's joints are taken as given; other wood is
/// split by level sets of the distance along its bark, and its pieces hang on what they touch.
/// Parents come before their children. Foliage without wood is one upright branch; a plant without
/// vertices has none. Adds a note on what it did. Deterministic for any number of threads. Throws
/// Error for a skin that names a joint twice. docs/motion.md has the method and its limits.
void findBranches(Plant& plant);

/// The light of a crown, per vertex of each mesh of the plant it was baked from.
struct MeshLight {
  std::vector<glm::vec3> normals;  ///< unit
  std::vector<float> ambient;      ///< coefficient in [1/255, 1], 1 = open
  /// Of leaves: how much of the front and of the back is seen from around, [0, 1]; empty: unknown.
  std::vector<glm::vec2> visibility = {};
};

/// The result of a bake: `meshes` runs parallel to Plant::meshes.
struct CrownLight {
  std::vector<MeshLight> meshes;
};

}  // namespace verdure

#endif  // VERDURE_PLANT_H_
