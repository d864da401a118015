// What one way of lighting costs against another: draws one scene with both, in turns within one
// run, and prints the medians of the GPU's frame times and their ratio. Usage:
// render_bench [leaves = 10000] [frames = 31] [width = 1280] [height = 720] [A = standard]
//   [B = expressive]
// A and B are presets; PRESET:paper, PRESET:layers, PRESET:ordered and PRESET:shadow-map are one
// with that source of shadows; PRESET:maps, PRESET:even, PRESET:color and PRESET:no-light-through
// one with that model of leaves, which then wear the maps of a grown leaf.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "test_plants.h"
#include "verdure/error.h"
#include "verdure/leaf_grow.h"
#include "verdure/leaf_plant.h"
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

verdure::Terms termsOf(const std::string& name) {
  using verdure::ShadowSource;
  const std::size_t colon = name.find(':');
  verdure::Terms terms = verdure::presetTerms(name.substr(0, colon));
  if (colon == std::string::npos) return terms;
  const std::string source = name.substr(colon + 1);
  if (source == "paper")
    terms.shadow_source = ShadowSource::kDepthPaper;
  else if (source == "layers")
    terms.shadow_source = ShadowSource::kDepthLayers;
  else if (source == "ordered")
    terms.shadow_source = ShadowSource::kDepthOrdered;
  else if (source == "shadow-map")
    terms.shadow_source = ShadowSource::kShadowMap;
  else if (source == "maps")
    terms.leaf = verdure::LeafModel::kMaps;
  else if (source == "even")
    terms.leaf = verdure::LeafModel::kDiffuse;
  else if (source == "color")
    terms.leaf = verdure::LeafModel::kColor;
  else if (source == "no-light-through")
    terms.transmission = false;
  else
    throw verdure::Error("render_bench", "unknown: \"" + source + "\"",
                         "use paper, layers, ordered or shadow-map, or maps, even, color or "
                         "no-light-through");
  return terms;
}

bool wantsLeafMaps(const std::string& name) {
  for (const char* model : {":maps", ":even", ":color", ":no-light-through"})
    if (name.ends_with(model)) return true;
  return false;
}

/// Four textures of 512 x 512 a side instead of the painted leaf.
void putOnLeafMaps(verdure::Plant& tree) {
  verdure::LeafGrowOptions grow;
  grow.size = 512;
  const verdure::LeafSet leaf = verdure::growLeaf(grow);
  const std::uint32_t material =
      verdure::addLeafMaterial(tree, leaf, verdure::bakeLeafTranslucency(leaf));
  for (verdure::Mesh& mesh : tree.meshes)
    if (mesh.kind == verdure::PartKind::kFoliage) mesh.material = material;
}

int run(int argc, char** argv) {
  using namespace verdure;
  const int leaves = argument(argc, argv, 1, 10000), frames = argument(argc, argv, 2, 31);
  View view;
  view.width = argument(argc, argv, 3, 1280);
  view.height = argument(argc, argv, 4, 720);

  const std::string names[] = {argc > 5 ? argv[5] : "standard", argc > 6 ? argv[6] : "expressive"};
  Plant tree = test::ballTree(leaves, 0.12f, true);
  if (wantsLeafMaps(names[0]) || wantsLeafMaps(names[1])) putOnLeafMaps(tree);
  const CrownLight light = test::ballTreeLight(tree);
  Scene scene;
  scene.items.push_back({&tree, &light});
  view.camera = automaticCamera(scene, 0.2f, 0.0f,
                                static_cast<float>(view.width) / static_cast<float>(view.height));
  Renderer renderer;
  renderer.setScene(scene);

  const Terms terms[] = {termsOf(names[0]), termsOf(names[1])};
  std::vector<double> shadow[2], color[2], tone[2], whole[2];
  double pack_ms = 0.0;
  for (int frame = -2; frame < frames; ++frame)  // two rounds to warm up
    for (int k = 0; k < 2; ++k) {
      const int which = (frame & 1) != 0 ? 1 - k : k;  // neither always goes first
      view.terms = terms[which];
      const FrameTimes times = renderer.render(view).times;
      pack_ms = times.pack_ms;
      if (frame < 0) continue;
      shadow[which].push_back(times.shadow_ms);
      color[which].push_back(times.color_ms);
      tone[which].push_back(times.tone_ms);
      whole[which].push_back(times.shadow_ms + times.color_ms + times.tone_ms);
    }
  std::printf("%s, %d x %d, %zu triangles, %d frames each; pack and upload %.1f ms\n",
              renderer.deviceName().c_str(), view.width, view.height, triangleCount(tree), frames,
              pack_ms);
  for (int which = 0; which < 2; ++which)
    std::printf("%-22s shadow %8.3f ms   color %8.3f ms   tone %8.3f ms   whole %8.3f ms\n",
                names[which].c_str(), median(shadow[which]), median(color[which]),
                median(tone[which]), median(whole[which]));
  // Pairs of neighbouring frames share the machine's mood: the median of their ratios is steadier
  // than the ratio of the medians.
  std::vector<double> ratios;
  for (std::size_t i = 0; i < whole[0].size(); ++i) ratios.push_back(whole[1][i] / whole[0][i]);
  std::printf("%s / %s, whole frames: %.4f (median of pairs), %.4f (medians)\n", names[1].c_str(),
              names[0].c_str(), median(ratios), median(whole[1]) / median(whole[0]));
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
