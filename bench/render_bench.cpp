// Does baked light cost anything at run time? Draws one scene with the standard model (leaf
// normals, constant ambient) and with expressive light (baked normals and coefficient), in turns
// within one run, and prints the medians of the GPU's frame times and their ratio. Usage:
// render_bench [leaves = 10000] [frames = 31] [width = 1280] [height = 720]

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "test_plants.h"
#include "verdure/error.h"
#include "verdure/render.h"

namespace {

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

int argument(int argc, char** argv, int index, int otherwise) {
  return argc > index ? std::max(std::atoi(argv[index]), 1) : otherwise;
}

int run(int argc, char** argv) {
  using namespace verdure;
  const int leaves = argument(argc, argv, 1, 10000), frames = argument(argc, argv, 2, 31);
  View view;
  view.width = argument(argc, argv, 3, 1280);
  view.height = argument(argc, argv, 4, 720);

  const Plant tree = test::ballTree(leaves, 0.12f, true);
  const CrownLight light = test::ballTreeLight(tree);
  Scene scene;
  scene.items.push_back({&tree, &light});
  view.camera = automaticCamera(scene, 0.2f, 0.0f,
                                static_cast<float>(view.width) / static_cast<float>(view.height));
  Renderer renderer;
  renderer.setScene(scene);

  const char* const names[] = {"standard", "expressive"};
  std::vector<double> shadow[2], color[2], tone[2];
  double pack_ms = 0.0;
  for (int frame = -2; frame < frames; ++frame)  // two rounds to warm up
    for (int k = 0; k < 2; ++k) {
      const int which = (frame & 1) != 0 ? 1 - k : k;  // neither always goes first
      view.terms = presetTerms(names[which]);
      const FrameTimes times = renderer.render(view).times;
      pack_ms = times.pack_ms;
      if (frame < 0) continue;
      shadow[which].push_back(times.shadow_ms);
      color[which].push_back(times.color_ms);
      tone[which].push_back(times.tone_ms);
    }
  std::printf("%s, %d x %d, %zu triangles, %d frames each; pack and upload %.1f ms\n",
              renderer.deviceName().c_str(), view.width, view.height, triangleCount(tree), frames,
              pack_ms);
  for (int which = 0; which < 2; ++which)
    std::printf("%-11s shadow %8.3f ms   color %8.3f ms   tone %8.3f ms\n", names[which],
                median(shadow[which]), median(color[which]), median(tone[which]));
  // Pairs of neighbouring frames share the machine's mood: the median of their ratios is steadier
  // than the ratio of the medians.
  std::vector<double> ratios;
  for (std::size_t i = 0; i < color[0].size(); ++i) ratios.push_back(color[1][i] / color[0][i]);
  std::printf("expressive / standard: %.4f (median of pairs), %.4f (medians)\n", median(ratios),
              median(color[1]) / median(color[0]));
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
