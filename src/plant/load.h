#ifndef VERDURE_PLANT_LOAD_H_
#define VERDURE_PLANT_LOAD_H_

#include <filesystem>
#include <vector>

#include "plant/classify.h"
#include "plant/gltf_stems.h"

namespace verdure {

/// A mesh on its way in: world positions in double until the plant's origin is known.
struct RawPart {
  Mesh mesh;  ///< all but its positions
  PartNames names;
  std::vector<glm::dvec3> world;
};

/// A plant whose positions are still in world coordinates.
struct RawPlant {
  Plant plant;      ///< all but its meshes and branches
  FileStems stems;  ///< those
  std::vector<RawPart> parts;
};

RawPlant importGltf(const std::filesystem::path& path);
RawPlant importAssimp(const std::filesystem::path& path);

/// "1,234,567".
std::string withCommas(std::size_t number);

}  // namespace verdure

#endif  // VERDURE_PLANT_LOAD_H_
