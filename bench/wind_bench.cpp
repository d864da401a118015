// What wind costs, as table 4.3 of Habel 2009: frames of the same trees, at rest and in wind, in
// turns within one run; medians of the GPU's times, and of their ratios. Usage:
// wind_bench [trees = 1] [frames = 15] [width = 1280] [height = 720] [light = standard]
// `unshaded` as a light: textures and ambient light alone, no shadows.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <vector>

#include "verdure/error.h"
#include "verdure/grow.h"
#include "verdure/motion.h"
#include "verdure/render.h"

namespace {

using namespace verdure;

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

int argument(int argc, char** argv, int index, int otherwise) {
  return argc > index ? std::max(std::atoi(argv[index]), 1) : otherwise;
}

Terms termsOf(const std::string& light) {
  if (light != "unshaded") return presetTerms(light);
  Terms terms = presetTerms("standard");
  terms.diffuse = terms.specular = terms.shadow = false;
  return terms;
}

int run(int argc, char** argv) {
  const int trees = argument(argc, argv, 1, 1), frames = argument(argc, argv, 2, 15);
  View view;
  view.width = argument(argc, argv, 3, 1280);
  view.height = argument(argc, argv, 4, 720);
  const std::string light = argc > 5 ? argv[5] : "standard";
  view.terms = termsOf(light);
  view.shadow_cascades = 1;

  // About the tree of the table: 75,000 vertices, 1,500 branches, 10,000 leaves.
  GrowOptions options;
  options.species = "quaking-aspen";
  options.seed = 2;
  options.leaf_form = LeafForm::kCard;
  options.set = {{"Leaves", "12"}};
  options.texture_size = 128;
  const Plant tree = grow(options);
  const PlantMotion motion = plantMotion(tree);
  Scene scene;
  scene.items.push_back({.plant = &tree, .world_from_plant = {}, .motion = &motion});
  const int side = static_cast<int>(std::ceil(std::sqrt(trees)));
  const Bounds box = bounds(tree);
  const float apart = 1.2f * std::max(box.size().x, box.size().z);
  for (int i = 0; i < trees; ++i)
    scene.items[0].world_from_plant.push_back(glm::rotate(
        glm::translate(glm::mat4(1.0f),
                       glm::vec3(apart * float(i % side), 0.0f, -apart * float(i / side))),
        2.4f * float(i), glm::vec3(0, 1, 0)));
  view.camera = automaticCamera(scene, 0.2f, 0.1f,
                                static_cast<float>(view.width) / static_cast<float>(view.height));
  Renderer renderer;
  renderer.setScene(scene);
  std::vector<double> times[2], moving, ratios;
  for (int frame = -1; frame < frames; ++frame) {  // one round to warm up
    double pair[2] = {};
    for (int k = 0; k < 2; ++k) {
      const int windy = (frame & 1) != 0 ? 1 - k : k;  // neither always goes first
      view.wind.speed = windy == 1 ? 6.0f : 0.0f;
      view.seconds = 0.04 * frame;
      const FrameTimes t = renderer.render(view).times;
      pair[windy] = t.motion_ms + t.shadow_ms + t.color_ms + t.tone_ms;
      if (frame >= 0 && windy == 1) moving.push_back(t.motion_ms);
    }
    if (frame < 0) continue;
    for (int k = 0; k < 2; ++k) times[k].push_back(pair[k]);
    ratios.push_back(pair[1] / pair[0]);
  }
  const double static_ms = median(times[0]), animated_ms = median(times[1]);
  std::printf("%s, %d x %d, %s: %d x %zu vertices, %zu branches, %zu leaves\n",
              renderer.deviceName().c_str(), view.width, view.height, light.c_str(), trees,
              vertexCount(tree), motion.tree.branches.size(), tree.leaves.size());
  const int passes = view.terms.shadow ? 2 : 1;
  std::printf(
      "at rest %.2f ms, in wind %.2f ms (branches and leaves %.2f): ratio %.3f (median of pairs), "
      "%.1f ns a vertex and pass\n",
      static_ms, animated_ms, median(moving), median(ratios),
      1e6 * (animated_ms - static_ms) / (double(vertexCount(tree)) * trees * passes));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const verdure::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
