#ifndef VERDURE_LEAF_H_
#define VERDURE_LEAF_H_

#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "verdure/image.h"

/// Leaves as data sets of maps: Habel, "Real-time Rendering and Animation of Vegetation",
/// dissertation, TU Wien 2009, chapter 3.
namespace verdure {

/// What a leaf is made of, at the wavelength for which light through it is simulated (table 3.1:
/// 510 nm).
struct LeafOptics {
  float scattering_per_mm = 10.2f;  ///< sigma_s, above 0
  float absorption_per_mm = 0.4f;   ///< sigma_a, above 0
  float anisotropy = 0.07f;         ///< g, mean cosine of scattering, in (-1, 1)
  float refractive_index = 1.33f;   ///< eta of the tissue: what (3.4) makes A of, [1, 4)
  float front_roughness = 0.3f;     ///< Cook-Torrance's m, after Bousquet et al. 2005: [0.078, 0.5]
  float back_roughness = 0.0f;      ///< the same of the back, 0 = diffuse
  float front_index = 1.45f;        ///< effective refractive index of the gloss: [1.2, 1.7]
};

/// One side of a leaf. Each map has LeafSet::width x height values, rows from the top, and the same
/// texel of both sides is the same place of the leaf: the back is not turned over.
struct LeafSide {
  std::vector<glm::vec3> albedo;        ///< diffuse reflectance, linear RGB, [0, 1]
  std::vector<glm::vec3> translucency;  ///< rho_t: colour of light that leaves here, linear, [0, 1]
  /// Unit. x to the right of the image, y up, z out of this side (of the back, too).
  std::vector<glm::vec3> normal;
  /// Height of the surface above the leaf's middle plane, out of this side, mm; its slopes are
  /// those of `normal`.
  std::vector<float> relief_mm;
};

/// A leaf, its stalk's foot at the lower edge's middle if nothing else is known.
struct LeafSet {
  std::string name;
  int width = 0;
  int height = 0;
  float mm_per_texel = 0.0f;
  LeafSide front;                   ///< adaxial: the upper side
  LeafSide back;                    ///< abaxial
  std::vector<float> thickness_mm;  ///< above 0 wherever there is leaf
  std::vector<float> opacity;       ///< 1 in the leaf, 0 outside and in holes
  LeafOptics optics;
  std::vector<std::string> notes;  ///< one line each: what reading found out or mended

  std::size_t texelCount() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

/// Throws Error, naming `where`, unless all maps have the set's size and all values lie in their
/// ranges.
void checkLeafSet(const LeafSet& set, const std::string& where);

/// A rectangle of a leaf's maps. Throws Error unless it has texels and lies in them.
LeafSet cropLeaf(const LeafSet& set, int x, int y, int width, int height);

/// Several leaves as one set, in rows from the top: an atlas for a plant. All must have one size
/// and scale; the optics are the first one's. Throws Error.
LeafSet tileLeaves(std::span<const LeafSet> leaves, int columns);

}  // namespace verdure

#endif  // VERDURE_LEAF_H_
