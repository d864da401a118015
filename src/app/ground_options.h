#ifndef VERDURE_APP_GROUND_OPTIONS_H_
#define VERDURE_APP_GROUND_OPTIONS_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "verdure/grass.h"
#include "verdure/scene.h"
#include "verdure/terrain.h"

/// What a scene stands on, as the command line names it.
namespace verdure::app {

struct GroundOptions {
  std::vector<std::string> grass;  ///< of each layer: a species, a folder or its grass.json
  std::vector<float> density;      ///< of each layer, the last for all further ones
  std::vector<std::string> cover;  ///< pictures, of each layer; "" or missing: everywhere
  std::uint64_t grass_seed = 1;
  int slices = 32;      ///< on a ray
  std::string terrain;  ///< "hills" or a picture; empty: a plane
  std::string terrain_size = "200x200";
  std::string terrain_height = "0,12";
  std::uint64_t terrain_seed = 1;

  bool any() const { return !grass.empty() || !terrain.empty(); }
};

/// What they name, made: outlives the scene that it was laid under.
struct SceneGround {
  std::optional<Terrain> terrain;
  std::vector<GrassSet> sets;
  std::vector<std::optional<CoverMap>> covers;

  /// Lays it under the scene: a terrain goes through the ground at x = z = 0.
  void layUnder(Scene& scene, const GroundOptions& options);
};

/// Throws Error that names the option.
SceneGround makeGround(const GroundOptions& options);

}  // namespace verdure::app

#endif  // VERDURE_APP_GROUND_OPTIONS_H_
