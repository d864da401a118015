#ifndef VERDURE_LAYOUT_H_
#define VERDURE_LAYOUT_H_

#include <filesystem>
#include <string>
#include <vector>

#include "verdure/placement.h"

namespace verdure {

/// Places of plants that a glTF file holds.
struct Layout {
  std::vector<Placement>
      places;  ///< Placement::plant: number of the node among those that have any
  /// That have instances. Several with the same places are parts of one plant, and count once.
  std::size_t nodes = 0;
  std::vector<std::string> notes;  ///< one line each: what of the file is lost
};

/// Reads the instances (EXT_mesh_gpu_instancing) of a .glb or .gltf file's scene: positions, turns
/// about +Y and even scales, in the world. Tilts, mirroring and uneven scales are lost, with a
/// note; instances more than 10 km from the origin are moved there as a whole, with another. Phases
/// differ. Throws Error as loadPlant() does, and for a file without instances.
Layout loadLayout(const std::filesystem::path& path);

}  // namespace verdure

#endif  // VERDURE_LAYOUT_H_
