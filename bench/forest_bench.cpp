// What a forest costs: trees that fill the view, alone and among many more that stand around and
// behind it, with and without those that others hide; medians of the GPU's times. Usage:
// forest_bench [seen = 1000] [all = 100000] [frames = 5] [width = 1280] [height = 720]
// [detail = 1] [picture.png]

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "render/frame.h"
#include "verdure/error.h"
#include "verdure/grow.h"
#include "verdure/levels.h"
#include "verdure/optical_depth.h"
#include "verdure/render.h"
#include "verdure/scatter.h"

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

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Kind {
  Plant plant;
  CrownLight light;
  PlantMotion motion;
  PlantLevels levels;
};

Kind makeKind(const char* species) {
  Kind kind;
  GrowOptions options;
  options.species = species;
  options.seed = 2;
  options.leaf_form = LeafForm::kCard;
  options.texture_size = 256;
  kind.plant = grow(options);
  kind.light = bakeOpticalDepth(kind.plant).light;
  kind.motion = plantMotion(kind.plant);
  const auto start = std::chrono::steady_clock::now();
  kind.levels = makeLevels(kind.plant, &kind.light);
  std::printf("%s: %zu triangles; levels in %.2f s:", species, triangleCount(kind.plant),
              secondsSince(start));
  for (const PlantLevel& level : kind.levels.meshes) {
    std::size_t triangles = 0;
    for (const Mesh& mesh : level.meshes) triangles += mesh.triangleCount();
    std::printf(" %zu", triangles);
  }
  std::printf(" triangles, impostor\n");
  return kind;
}

int run(int argc, char** argv) {
  const int seen = argument(argc, argv, 1, 1000), all = argument(argc, argv, 2, 100000);
  const int frames = argument(argc, argv, 3, 5);
  View view;
  view.width = argument(argc, argv, 4, 1280);
  view.height = argument(argc, argv, 5, 720);
  view.terms = presetTerms("best");
  view.terms.ambient_source = AmbientSource::kBaked;
  view.wind.speed = 5.0f;
  view.seconds = 3.0;
  view.shadow_map_size = 1024;

  std::vector<Kind> kinds;
  for (const char* species : {"quaking-aspen", "japanese-maple"})
    kinds.push_back(makeKind(species));
  // 400 a hectare; the nearest to the middle of the picture's pyramid are those that fill it.
  const float side = std::sqrt(static_cast<float>(std::max(all, 8 * seen)) * 30.0f);
  const std::vector<Placement> places = scatterPlants({.kinds = {{0, 0.6f, 1.8f}, {1, 0.4f, 1.5f}},
                                                       .corner = glm::vec2(-0.5f * side),
                                                       .size_m = glm::vec2(side),
                                                       .per_m2 = 0.04f,
                                                       .taken = {}});
  view.camera = {{0.0f, 6.0f, 0.0f}, {0.0f, 4.0f, -30.0f}, 0.6f};
  Forest few, many;
  for (const Kind& kind : kinds)
    few.kinds.push_back({&kind.plant, &kind.light, &kind.motion, &kind.levels});
  few.detail = many.detail = argc > 6 ? static_cast<float>(std::atof(argv[6])) : 1.0f;
  many.kinds = few.kinds;
  std::vector<std::pair<float, std::size_t>> inside;
  const float slope = 1.1f * std::tan(0.5f * view.camera.vertical_fov) *
                      static_cast<float>(view.width) / static_cast<float>(view.height);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::vec3& p = places[i].position;
    if (p.z < -12.0f && std::abs(p.x) < 6.0f - slope * p.z)
      inside.emplace_back(-p.z, i);
    else if (many.places.size() + static_cast<std::size_t>(seen) < static_cast<std::size_t>(all) &&
             glm::length(p) > 6.0f)
      many.places.push_back(places[i]);
  }
  std::sort(inside.begin(), inside.end());
  for (std::size_t i = 0; i < std::min(inside.size(), static_cast<std::size_t>(seen)); ++i) {
    few.places.push_back(places[inside[i].second]);
    many.places.push_back(places[inside[i].second]);
  }
  const gpu::Device device("", false);
  FrameDrawer drawer(device);
  std::printf("%s, %d x %d, %zu trees in view\n", device.name().c_str(), view.width, view.height,
              few.places.size());
  // All in turns, since others may use the machine; the first round warms up.
  struct Way {
    std::unique_ptr<GpuScene> scene;
    bool all;
    std::vector<FrameTimes> times = {};
    Image picture = {};
  };
  std::vector<Way> ways;
  for (const Forest* forest : {&few, &many})
    for (const bool draws_all : {false, true}) {
      Scene scene;
      scene.forest = forest;
      const auto start = std::chrono::steady_clock::now();
      ways.push_back(
          {std::make_unique<GpuScene>(device, packScene(scene), drawer.sceneLayouts()), draws_all});
      if (!draws_all)
        std::printf("%zu trees: loaded in %.2f s\n", forest->places.size(), secondsSince(start));
      ways.back().scene->forest()->tryAll(draws_all);
    }
  for (int round = 0; round <= frames; ++round)
    for (Way& way : ways) {
      drawer.forgetScene();
      const Frame frame = drawer.draw(*way.scene, view);
      if (round > 0) way.times.push_back(frame.times);
      way.picture = frame.image;
    }
  for (const Way& way : ways) {
    const auto middle = [&](auto of) {
      std::vector<double> values;
      for (const FrameTimes& t : way.times) values.push_back(of(t));
      return median(std::move(values));
    };
    const auto [meshes, impostors] = way.scene->forest()->counts();
    std::printf(
        "%7zu trees%s: %u meshes and %u impostors drawn; frame %.1f ms (choice and motion %.1f, "
        "the sun's maps %.1f, picture %.1f)\n",
        way.scene->forest()->places(), way.all ? ", nothing left out" : "", meshes, impostors,
        middle(
            [](const FrameTimes& t) { return t.motion_ms + t.shadow_ms + t.color_ms + t.tone_ms; }),
        middle([](const FrameTimes& t) { return t.motion_ms; }),
        middle([](const FrameTimes& t) { return t.shadow_ms; }),
        middle([](const FrameTimes& t) { return t.color_ms; }));
  }
  if (argc > 7) writePng(ways[2].picture, argv[7]);
  for (const std::size_t i : {0u, 2u})
    if (ways[i].picture.rgba != ways[i + 1].picture.rgba)
      throw Error("forest_bench", "what is left out is missing in the picture",
                  "mend the choice of trees");
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
