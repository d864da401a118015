#ifndef VERDURE_LEAF_FILES_H_
#define VERDURE_LEAF_FILES_H_

#include <filesystem>
#include <optional>
#include <string>

#include "verdure/leaf.h"

namespace verdure {

/// What the maps of a leaf do not say themselves. Whatever is set stands instead of what a file
/// says.
struct LeafImportOptions {
  std::string name;                   ///< empty: of the folder, file or material
  std::optional<float> mm_per_texel;  ///< above 0
  std::optional<float> width_mm;      ///< instead: of the whole map
  /// Thickness of the leaf, mm, above 0; with a map, that of its largest value.
  std::optional<float> thickness_mm;
  /// Height of white over black in maps of relief, mm, above 0. Without it relief of 8 or 16 bits
  /// is left and found from the normals.
  std::optional<float> relief_mm;
};

/// Writes a leaf as a folder of leaf.json and PNG files (docs/leaves.md), which is made if it is
/// missing; each file is there whole or not at all, leaf.json last. Colours are rounded to sRGB of
/// 8 bits, opacity to 8 bits, normals, thickness and relief to 16 bits. Throws Error.
void writeLeafSet(const LeafSet& set, const std::filesystem::path& folder);

/// Reads what writeLeafSet wrote, or such a folder made by hand. What is missing is made from what
/// there is: a back from the front, relief from normals (Frankot and Chellappa 1988), normals from
/// relief; LeafSet::notes says so. Where albedo and translucency of the two sides sum to more than
/// 1, both are scaled down and the notes count them. Throws Error: no scale, no thickness, maps of
/// different sizes, unknown members.
LeafSet readLeafSet(const std::filesystem::path& folder, const LeafImportOptions& options = {});

/// Reads a folder with a leaf.json as readLeafSet does, or one of maps whose names end as those of
/// ambientCG do: _Color, _NormalGL, _Opacity, _Scattering, _Displacement, _Thickness, _Roughness.
LeafSet importLeafSet(const std::filesystem::path& folder, const LeafImportOptions& options);

}  // namespace verdure

#endif  // VERDURE_LEAF_FILES_H_
