#ifndef VERDURE_PLANT_IO_H_
#define VERDURE_PLANT_IO_H_

#include <filesystem>
#include <string>
#include <vector>

#include "verdure/leaf_files.h"
#include "verdure/plant.h"

namespace verdure {

struct LoadOptions {
  /// Materials, meshes or nodes, by name (case-insensitive, whole name or `*` pattern), that are
  /// foliage or wood whatever the analysis says.
  std::vector<std::string> foliage;
  std::vector<std::string> wood;
};

/// Loads a plant: .glb and .gltf (glTF 2.0), or .obj, .fbx, .dae, .ply. What was found out
/// (which parts are foliage and why, mended normals, ...) is in Plant::notes. Leaves are found.
/// Throws Error for files that are missing, truncated, inconsistent, hold non-finite positions, or
/// require a glTF extension that verdure cannot read.
Plant loadPlant(const std::filesystem::path& path, const LoadOptions& options = {});

/// The leaf that a material of a .glb or .gltf file shows: base colour, its alpha where it is cut,
/// normals, KHR_materials_volume's thickness and KHR_materials_diffuse_transmission. Lengths in the
/// file are metres. `material`: a name or `*` pattern that one material with a base colour texture
/// matches, empty: the only one. The scale comes from the meshes that wear the material, if
/// `options` says none. Throws Error as importLeafSet does.
LeafSet importLeafMaterial(const std::filesystem::path& path, const std::string& material,
                           const LeafImportOptions& options);

struct ExportOptions {
  bool color1 = false;  ///< also write the ambient coefficient as COLOR_1 (RGB = k, A = 1)
};

/// Writes glTF 2.0 (.glb, or .gltf with a .bin and textures beside it by extension). A plant that
/// was loaded from glTF keeps its document: only NORMAL and `_AO` (and `_VISIBILITY`,
/// COLOR_1) change. `light`
/// may be null: then the plant is written as it is. Nodes that share a mesh under different light
/// get copies of it, lit instances (EXT_mesh_gpu_instancing) become nodes, meshopt and draco
/// compression is undone; normals that equal the plant's own stay as they are in the file. Atomic.
/// Throws Error, also for light that is not of this plant, not of unit length or outside [0, 1].
void savePlant(const Plant& plant, const CrownLight* light, const std::filesystem::path& path,
               const ExportOptions& options = {});

/// What `verdure inspect` prints.
struct PartReport {
  std::string name;
  std::string material;
  PartKind kind = PartKind::kWood;
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  std::size_t leaves = 0;
  bool has_uvs = false;
};

struct LevelReport {
  std::size_t branches = 0;
  double length_m = 0.0;  ///< of all of them along their axes
};

struct PlantReport {
  std::vector<PartReport> parts;
  Bounds bounds;  ///< relative to origin
  glm::dvec3 origin{0.0};
  std::size_t vertices = 0, triangles = 0, leaves = 0, branches = 0;
  int levels = 0;                       ///< 0 = unknown
  std::vector<LevelReport> by_level;    ///< of branches, from the trunk on
  double leaf_area_m2 = 0.0;            ///< one side, all leaves
  double mean_leaf_size_m = 0.0;        ///< square root of the mean leaf area
  std::vector<std::string> attributes;  ///< names of vertex attributes in the source document
  std::vector<std::string> problems;    ///< one line each
  std::vector<std::string> notes;       ///< Plant::notes
};

PlantReport inspectPlant(const Plant& plant);

}  // namespace verdure

#endif  // VERDURE_PLANT_IO_H_
