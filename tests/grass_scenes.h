#ifndef VERDURE_TESTS_GRASS_SCENES_H_
#define VERDURE_TESTS_GRASS_SCENES_H_

#include <functional>
#include <ostream>

#include "base/parallel.h"
#include "base/random.h"
#include "grass_reference.h"
#include "render_fixture.h"
#include "verdure/grass.h"

/// Grass for the renderer's tests, and how well a picture of it agrees with brute force.
namespace verdure::test {

/// Blocks of random texels, with holes: what is read at a wrong place shows.
inline GrassMap blocks(int width, int height, int block, double open, std::uint64_t seed) {
  GrassMap map{width, height, {}, {}};
  map.color.resize(map.texelCount());
  map.data.resize(map.texelCount());
  const auto columns = static_cast<std::uint64_t>(width / block + 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto cell =
          static_cast<std::uint64_t>(y / block) * columns + static_cast<std::uint64_t>(x / block);
      Random random(seed, cell);
      const float kind = random.uniform();
      const float alpha = kind < open ? 0.0f : kind < open + 0.1 ? 0.5f : 1.0f;
      const glm::vec3 color(random.uniform(0.25f, 0.9f), random.uniform(0.25f, 0.9f),
                            random.uniform(0.25f, 0.9f));
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                            static_cast<std::size_t>(x);
      map.color[i] = glm::vec4(color, 1.0f) * alpha;
      map.data[i] = glm::vec4(0.0f, 0.0f, 0.0f, random.uniform(0.0f, 0.95f)) * alpha;
    }
  return map;
}

/// Slices at other distances across u than across v, 0.25 m high; `scale` times as large.
inline GrassSet blockySet(float scale = 1.0f) {
  GrassSet set;
  set.name = "blocks";
  set.height_m = 0.25f * scale;
  set.spacing_m = glm::vec2(0.11f, 0.07f) * scale;
  set.tile_m = 0.5f * scale;
  for (std::uint64_t kind = 0; kind < 3; ++kind)
    set.slices.push_back(blocks(128, 16, 4, 0.7, 10 + kind));
  set.opaque = blocks(128, 16, 4, -1.0, 20);
  set.ground = blocks(128, 128, 4, -1.0, 21);
  set.middle = blocks(128, 128, 4, 0.8, 22);
  return set;
}

inline GrassLayer plainLayer(const GrassSet& set) {
  GrassLayer layer;
  layer.set = &set;
  layer.variation = 0.0f;
  layer.medium = layer.middle = layer.blades = false;
  layer.most_slices = 256;
  return layer;
}

/// Light from all sides alike: the picture is the reflectance.
inline View plainView(const Camera& camera, int width = 120, int height = 90) {
  View view = smallView(width, height);
  view.camera = camera;
  view.terms = presetTerms("standard");
  view.terms.diffuse = view.terms.specular = view.terms.shadow = false;
  setSun(view, glm::vec3(0, 1, 0), glm::vec3(0.0f));
  setFurnace(view, glm::vec3(1.0f));
  view.background = glm::vec3(0.0f);
  view.exposure.ev = 13.0f;
  view.exposure.white = 4.0f;
  return view;
}

inline Camera lookingFrom(const glm::vec3& eye, const glm::vec3& toward, float fov = 0.6f) {
  return {eye, eye + toward, fov};
}

inline Scene grassScene(const GrassLayer& layer, const Terrain* terrain = nullptr) {
  Scene scene;
  scene.terrain = terrain;
  scene.grass = {layer};
  return scene;
}

/// That of a scene without terrain.
inline Terrain plane() {
  return {2, 2, glm::vec2(-8.0f), glm::vec2(16.0f), std::vector<float>(4, 0.0f)};
}

/// A reflectance as a picture shows it, levels of 255.
inline glm::dvec3 levelsOf(const glm::dvec3& reflectance) {
  glm::dvec3 levels;
  for (int c = 0; c < 3; ++c)
    levels[c] =
        255.0 *
        double{shared::srgbFromLinear(std::clamp(static_cast<float>(reflectance[c]), 0.0f, 1.0f))};
  return levels;
}

inline double largestOf(const glm::dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Shares of a picture's pixels.
struct Agreement {
  double exact = 0;      ///< at most 2 levels off what a ray through their middle sees
  double explained = 0;  ///< or else between what rays through them see, and these 2 levels
  double mean = 0;       ///< levels off
  double worst = 0;      ///< levels off what rays through the pixel see
  int pixels = 0;
};

inline std::ostream& operator<<(std::ostream& out, const Agreement& all) {
  return out << "exact " << all.exact << ", explained " << all.explained << ", mean " << all.mean
             << ", worst " << all.worst;
}

/// Where two triangles of the shell meet (also those that clipping makes of one), a pixel is traced
/// for each of them, somewhere in the part that it covers: then its colour lies between what rays
/// through the pixel see. `most`: rays that meet more slices do not count.
inline Agreement agreementWith(const GrassReference& reference, const View& view,
                               const HdrImage& image, int most,
                               const std::function<SeenGrass(const glm::dvec3&)>& see) {
  const auto width = static_cast<std::size_t>(view.width);
  const std::size_t count = width * static_cast<std::size_t>(view.height);
  std::vector<double> apart(count), beyond(count), counts(count);
  parallelFor(static_cast<std::size_t>(view.height), 4, [&](std::size_t row) {
    for (std::size_t column = 0; column < width; ++column) {
      const auto x = static_cast<double>(column), y = static_cast<double>(row);
      const SeenGrass seen = see(reference.ray(x + 0.5, y + 0.5));
      const std::size_t i = row * width + column;
      if (seen.slices > most) continue;
      counts[i] = 1.0;
      const glm::dvec3 pixel =
          levelsOf(glm::dvec3(image.at(static_cast<int>(column), static_cast<int>(row))));
      glm::dvec3 low = levelsOf(seen.color), high = low;
      apart[i] = largestOf(pixel - low);
      if (apart[i] <= 2.0) continue;
      constexpr int kRays = 5;
      for (int k = 0; k < kRays * kRays; ++k) {
        const glm::dvec2 at(k % kRays, k / kRays);
        const glm::dvec2 share = (at + 0.5) / double{kRays};
        const glm::dvec3 levels = levelsOf(see(reference.ray(x + share.x, y + share.y)).color);
        low = glm::min(low, levels);
        high = glm::max(high, levels);
      }
      beyond[i] = largestOf(pixel - glm::clamp(pixel, low, high));
    }
  });
  Agreement all;
  for (std::size_t i = 0; i < count; ++i) {
    if (counts[i] == 0.0) continue;
    ++all.pixels;
    all.mean += apart[i];
    all.exact += apart[i] <= 2.0 ? 1.0 : 0.0;
    all.explained += beyond[i] <= 2.0 ? 1.0 : 0.0;
    all.worst = std::max(all.worst, beyond[i]);
  }
  all.mean /= all.pixels;
  all.exact /= all.pixels;
  all.explained /= all.pixels;
  return all;
}

}  // namespace verdure::test

#endif  // VERDURE_TESTS_GRASS_SCENES_H_
