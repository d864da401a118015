// What a user of the installed library writes: grow, bake, save.
#include <verdure/density.h>
#include <verdure/error.h>
#include <verdure/grow.h>
#include <verdure/plant_io.h>
#include <verdure/render.h>

#include <cstdio>

int main() {
  verdure::GrowOptions options;
  options.species = "japanese-maple";
  options.texture_size = 64;
  const verdure::Plant plant = verdure::grow(options);
  const verdure::DensityBake bake = verdure::bakeDensity(plant);
  verdure::savePlant(plant, &bake.light, "consumer.glb");
  std::printf("%zu leaves, %zu surface vertices, preset %s\n", plant.leaves.size(),
              bake.report.surface_vertices, verdure::presetNames().front().c_str());
  return bake.report.watertight && verdure::loadPlant("consumer.glb").leaves.size() > 100 ? 0 : 1;
}
