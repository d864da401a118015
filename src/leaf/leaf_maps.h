#ifndef VERDURE_LEAF_LEAF_MAPS_H_
#define VERDURE_LEAF_LEAF_MAPS_H_

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "verdure/leaf.h"
#include "verdure/leaf_files.h"

namespace verdure {

/// A map as a file holds it: fractions of white for PNG and JPEG, the numbers themselves for EXR.
struct LeafMap {
  std::string where;
  int width = 0, height = 0;
  int channels = 0;           ///< 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA
  bool physical = false;      ///< EXR: linear colours, signed normals, millimetres
  std::vector<float> values;  ///< width * height * channels

  std::size_t texelCount() const { return values.size() / static_cast<std::size_t>(channels); }
  bool hasAlpha() const { return channels == 2 || channels == 4; }
  float alpha(std::size_t texel) const {
    return values[(texel + 1) * static_cast<std::size_t>(channels) - 1];
  }
  glm::vec3 color(std::size_t texel) const {
    const float* v = values.data() + texel * static_cast<std::size_t>(channels);
    return channels < 3 ? glm::vec3(v[0]) : glm::vec3(v[0], v[1], v[2]);
  }
};

/// Millimetres at black and at white.
struct LeafRange {
  float low = 0.0f, high = 0.0f;
};

struct LeafSideMaps {
  std::optional<LeafMap> albedo, translucency, normal, relief;
  std::optional<LeafRange> relief_range_mm;
};

/// What any of the ways in has found of a leaf; makeLeafSet() fills the rest.
struct LeafMaps {
  std::string where;  ///< for messages
  std::string name;
  std::array<LeafSideMaps, 2> sides;  ///< front, back
  std::optional<LeafMap> thickness, opacity;
  std::optional<LeafRange> thickness_range_mm;
  std::optional<float> thickness_mm;  ///< without a map
  std::optional<float> mm_per_texel, width_mm;
  LeafOptics optics;
  std::vector<std::string> notes;
};

/// Decodes by the ending of `where`: .exr, else PNG or JPEG. Throws Error.
LeafMap readLeafMap(const std::filesystem::path& path);
LeafMap decodeLeafMap(std::span<const std::uint8_t> file, const std::string& where);

/// Throws Error as readLeafSet does.
LeafSet makeLeafSet(LeafMaps maps, const LeafImportOptions& options);

/// Heights, mm, whose slopes (rise over run: x to the right, y down) are nearest to the given ones,
/// zero-mean: Frankot and Chellappa, "A Method for Enforcing Integrability in Shape from Shading
/// Algorithms", 1988, with a cosine transform, so that nothing has to be periodic. `step_mm`: width
/// of a texel.
std::vector<float> heightsFromSlopes(const std::vector<glm::vec2>& slopes, int width, int height,
                                     float step_mm);

/// Slopes by central differences (one-sided at the border and where `inside` ends; 0 outside).
std::vector<glm::vec2> slopesFromHeights(const std::vector<float>& heights_mm,
                                         const std::vector<bool>& inside, int width, int height,
                                         float step_mm);

}  // namespace verdure

#endif  // VERDURE_LEAF_LEAF_MAPS_H_
