#ifndef VERDURE_GRASS_H_
#define VERDURE_GRASS_H_

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

/// Grass as a material: Habel, Wimmer, Jeschke, "Instant Animated Grass", WSCG 2007; Habel,
/// "Real-time Rendering and Animation of Vegetation", dissertation, TU Wien 2009, chapter 2.
///
/// A layer of grass is a shell as high as the grass over the ground. In it stand vertical slices at
/// even distances along both axes, u and v, of a horizontal plane in metres; w is the height above
/// the ground. What a slice shows are the plants that stand within half a spacing of it, seen along
/// the other axis.
namespace verdure {

/// A picture of grass that is filtered and composited by its alpha. Rows from the top.
struct GrassMap {
  int width = 0;
  int height = 0;
  /// Linear reflectance times alpha, and alpha: [0, 1].
  std::vector<glm::vec4> color;
  /// All times alpha. x, y: the unit normal that faces the looker, along the picture to the right
  /// and up, [-1, 1]; its third component, towards the looker, is what is missing to 1. z: what is
  /// transmitted, in shares of what is reflected, [0, 1]. w: rank of the plant, uniform in [0, 1):
  /// where the grass has density d, plants of rank below d stand.
  std::vector<glm::vec4> data;

  bool empty() const { return color.empty(); }
  std::size_t texelCount() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

/// How a ribbon's width goes along it.
enum class RibbonProfile : std::uint32_t {
  kBlade,  ///< widest a little above the foot, pointed
  kStalk,  ///< even and round: seen equally wide from all sides
  kOval,   ///< a leaflet or petal: widest in the middle, round at its ends
  kCut,    ///< a mown blade: even, and flat as blades are
};

/// One kind of ribbon of a plant: a blade, a stalk, leaflets, petals. Angles are from the vertical,
/// of ribbons on a stalk from the stalk's end.
struct GrassPart {
  RibbonProfile profile = RibbonProfile::kBlade;
  bool on_stalk =
      false;      ///< at the end of the plant's first ribbon, which is part 0; else on the ground
  int count = 1;  ///< ribbons, evenly around
  float length_m = 0.1f, length_spread = 0.3f;  ///< spread: +- this share, uniform
  float width_m = 0.004f;
  float lean = 0.2f, lean_spread = 0.15f;  ///< where it begins, radians
  float bend = 0.8f, bend_spread = 0.4f;   ///< by how much more it leans at its end, radians
  glm::vec3 root_color{0.05f, 0.09f, 0.02f}, tip_color{0.1f, 0.2f, 0.04f};  ///< linear reflectance
  float color_spread = 0.15f;  ///< +- this share of brightness, uniform, one for a plant
  float transmitted = 0.6f;    ///< share of what is reflected, [0, 1]
};

/// One kind of plant of a species: a tuft of grass, a clover, a daisy.
struct GrassPlant {
  std::string name;
  float per_m2 = 1000.0f;
  float radius_m = 0.01f;  ///< ribbons on the ground begin within this of the middle
  std::vector<GrassPart> parts;
};

/// What grows.
struct GrassSpecies {
  std::string name;
  std::string description;
  float height_m = 0.15f;   ///< of the shell: nothing grows higher
  float spacing_m = 0.05f;  ///< of the slices, along both axes
  float tile_m = 0.5f;      ///< side of a Wang tile
  glm::vec3 soil_color{0.06f, 0.045f, 0.03f};
  float litter = 0.5f;  ///< share of the soil that dead blades cover, [0, 1]
  glm::vec3 litter_color{0.25f, 0.2f, 0.1f};
  std::vector<GrassPlant> plants;
};

/// "lawn", "meadow", "dry-grass", "clover". Throws Error for an unknown name.
GrassSpecies grassSpecies(const std::string& name);
const std::vector<std::string>& grassSpeciesNames();

/// A species as pictures: what is traced.
struct GrassSet {
  std::string name;
  float height_m = 0.0f;      ///< h, above 0
  glm::vec2 spacing_m{0.0f};  ///< d_u, d_v: of slices across u and across v, above 0
  float tile_m = 0.0f;        ///< side of a Wang tile, above 0
  /// Kinds of slices, all of one size: four Wang tiles wide, in the order of wangColumn()
  /// (shared/grass.h), so that they repeat; height_m high. Row 0 is the shell's top.
  std::vector<GrassMap> slices;
  GrassMap opaque;  ///< the same size, alpha 1: what is behind all slices that were passed
  /// 4 x 4 Wang tiles, u to the right and v down, alpha 1: the ground seen from above with the
  /// lower half of the plants. The normals' right and up are u and -v.
  GrassMap ground;
  GrassMap
      middle;  ///< the same, without the ground: what grows above half of the height; may be empty
  GrassSpecies species;  ///< what it was made of; without plants where pictures were given
};

struct GrassGrowOptions {
  std::uint64_t seed = 1;
  float texels_per_m = 512.0f;  ///< of slices and ground, [16, 4096]
  int kinds = 8;                ///< of slices, [1, 64]
};

/// Grows the plants of all slabs and draws them. Slabs across u and slabs across v stand in the
/// same place, so each is grown at pi / 4 of the density: over all directions, rays then meet as
/// much as in the grass itself. Deterministic for any number of threads. Throws Error for numbers
/// out of range.
GrassSet growGrass(const GrassSpecies& species, const GrassGrowOptions& options = {});

/// Throws Error, naming `where`, unless all pictures have the sizes and values that they should.
void checkGrassSet(const GrassSet& set, const std::string& where);

/// Half as large, and so on to one texel: means of what is times alpha, so that coverage is kept.
/// Slices and grounds repeat to the right, grounds down as well.
std::vector<GrassMap> grassMips(const GrassMap& map);

/// Writes grass.json and its pictures (docs/grass.md has the format): all or none of them.
void saveGrass(const GrassSet& set, const std::filesystem::path& folder);

/// Reads a folder or its grass.json. Throws Error: one line for slices of different sizes or
/// without alpha, spacing or height of zero, missing files, unknown keys.
GrassSet loadGrass(const std::filesystem::path& path);

}  // namespace verdure

#endif  // VERDURE_GRASS_H_
