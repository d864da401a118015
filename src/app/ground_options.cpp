#include "app/ground_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/commands.h"
#include "verdure/error.h"

namespace verdure::app {
namespace {

/// WxD metres.
glm::vec2 sizeOf(const std::string& text) {
  std::string numbers = text;
  std::replace(numbers.begin(), numbers.end(), 'x', ',');
  const std::vector<float> size = parseNumbers("--terrain-size", numbers, 2);
  if (!(size[0] > 0.0f && size[1] > 0.0f))
    throw Error("--terrain-size", fmt::format("'{}' has no area", text), "write 200x200, metres");
  return {size[0], size[1]};
}

Terrain terrainOf(const GroundOptions& options) {
  const std::vector<float> range = parseNumbers("--terrain-height", options.terrain_height, 2);
  if (!(range[1] >= range[0]))
    throw Error("--terrain-height", fmt::format("{:g} is above {:g}", range[0], range[1]),
                "write LOW,HIGH");
  const glm::vec2 size = sizeOf(options.terrain_size);
  if (options.terrain == "hills")
    return growTerrain(
        {.seed = options.terrain_seed, .size_m = size, .relief_m = range[1] - range[0]});
  return readTerrain(options.terrain, {size, range[0], range[1]});
}

GrassSet setOf(const std::string& name, std::uint64_t seed) {
  const std::vector<std::string>& species = grassSpeciesNames();
  if (std::find(species.begin(), species.end(), name) != species.end())
    return growGrass(grassSpecies(name), {.seed = seed});
  if (!std::filesystem::exists(name))
    throw Error("--grass", fmt::format("'{}' is neither a species nor a folder", name),
                fmt::format("use {}, or what verdure grass grow writes", fmt::join(species, ", ")));
  return loadGrass(name);
}

}  // namespace

SceneGround makeGround(const GroundOptions& options) {
  SceneGround ground;
  for (const float density : options.density)
    if (!(density >= 0.0f && density <= 1.0f))
      throw Error("--grass-density", fmt::format("{:g} is out of range", density), "choose 0 to 1");
  if (options.slices < 1 || options.slices > 256)
    throw Error("--grass-slices", fmt::format("{} is out of range", options.slices),
                "choose 1 to 256");
  if (options.cover.size() > options.grass.size())
    throw Error("--grass-cover", "there are more maps than layers of grass", "leave some out");
  if (!options.terrain.empty()) ground.terrain = terrainOf(options);
  for (const std::string& name : options.grass)
    ground.sets.push_back(setOf(name, options.grass_seed));
  for (std::size_t i = 0; i < ground.sets.size(); ++i) {
    std::optional<CoverMap>& cover = ground.covers.emplace_back();
    if (i < options.cover.size() && !options.cover[i].empty())
      cover = readCoverMap(options.cover[i], sizeOf(options.terrain_size));
  }
  return ground;
}

void SceneGround::layUnder(Scene& scene, const GroundOptions& options) {
  if (terrain) {
    const float lift = scene.ground_height - terrain->heightAt(glm::vec2(0.0f));
    for (float& height : terrain->heights) height += lift;
    scene.terrain = &*terrain;
  }
  for (std::size_t i = 0; i < sets.size(); ++i) {
    GrassLayer layer;
    layer.set = &sets[i];
    layer.cover = covers[i] ? &*covers[i] : nullptr;
    if (!options.density.empty())
      layer.density = options.density[std::min(i, options.density.size() - 1)];
    layer.most_slices = options.slices;
    scene.grass.push_back(layer);
  }
}

}  // namespace verdure::app
