#ifndef VERDURE_PLANT_GLTF_STEMS_H_
#define VERDURE_PLANT_GLTF_STEMS_H_

#include "plant/gltf_document.h"

// Plant::branches in a glTF file. `_STEM_ID` (float) holds the number of each vertex's branch, of
// leaves too, -1 for none. asset.extras.verdure.stems holds the branches themselves: "points", an
// accessor of VEC4 floats: position and radius, m, relative to "origin", for all branches in turn,
// base to tip; "stems", an accessor of VEC4 floats, one for each branch: its parent's number or -1,
// its level, where it leaves its parent, [0, 1], and the number of its first point; "stalks", an
// accessor of VEC3 floats, where each of Plant::leaves is attached, likewise. Programs that
// renumber accessors drop extras of the asset, or keep them beside other accessors: what does not
// fit is left out.
namespace verdure {

inline constexpr const char* kStemId = "_STEM_ID";

/// For each mesh and vertex; empty for a plant without branches.
std::vector<std::vector<float>> stemIds(const Plant& plant);

/// Writes the plant's stems, if it has any, unless the document has them.
void writeStems(const Plant& plant, GltfDocument& document);

/// Whether the document says that it has stems. `_STEM_ID` means nothing without.
bool namesStems(const GltfDocument& document);

/// Branches and stalks of a file, relative to `origin`; empty unless they are whole, which a note
/// tells.
struct FileStems {
  std::vector<Branch> branches;
  std::vector<glm::vec3> stalks;
  glm::dvec3 origin{0.0};
};
FileStems readStems(const GltfDocument& document, std::vector<std::string>& notes);

/// Gives the plant its file's branches if they lie among its meshes, each leaf that of its
/// vertices, and its stalk if all leaves have one: Mesh::branch_of_vertex is of wood alone then.
void keepStems(FileStems stems, Plant& plant);

}  // namespace verdure

#endif  // VERDURE_PLANT_GLTF_STEMS_H_
