// Leaf visibility by rays from the leaves beside the way of its paper, pictures along the axes in
// which every pixel knows the nearest leaf, in the same run: leaf_visibility_bench [species]
// [seed] [many]. Both are compared with `many` rays along the same axes, and from all around, which
// is what the axes stand for.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "rays/ray_scene.h"
#include "verdure/grow.h"
#include "verdure/leaf_visibility.h"

namespace verdure {
namespace {

using Visibility = std::vector<glm::vec2>;

constexpr int kRounds = 2;

/// Six orthographic pictures of `size`^2 pixels of the box around the foliage, by rasterisation: of
/// each leaf's pixels those in front, and all, as V_i and V.
class Pictures {
 public:
  Pictures(const Plant& plant, const RayScene& scene, int size)
      : plant_(plant), scene_(scene), size_(size) {
    for (const Mesh& mesh : plant.meshes) leaf_of_.emplace_back(mesh.triangleCount(), kNone);
    for (std::uint32_t l = 0; l < plant.leaves.size(); ++l)
      for (std::uint32_t t = 0; t < plant.leaves[l].triangle_count; ++t)
        leaf_of_[plant.leaves[l].mesh][plant.leaf_triangles[plant.leaves[l].first_triangle + t]] =
            l;
  }

  Visibility draw() const {
    std::array<std::vector<glm::uvec4>, 6> counts;  // seen and all, front and back
    parallelFor(6, 1, [&](std::size_t view) {
      counts[view].assign(plant_.leaves.size(), glm::uvec4(0));
      drawOne(static_cast<int>(view / 2), view % 2 == 0 ? 1.0f : -1.0f, counts[view]);
    });
    Visibility visibility(plant_.leaves.size());
    for (std::size_t l = 0; l < visibility.size(); ++l) {
      glm::uvec4 sum(0);
      for (const auto& view : counts) sum += view[l];
      for (int side = 0; side < 2; ++side)
        visibility[l][side] =
            sum[side + 2] > 0 ? static_cast<float>(sum[side]) / static_cast<float>(sum[side + 2])
                              : 1.0f;
    }
    return visibility;
  }

 private:
  struct Pixel {
    float depth = -std::numeric_limits<float>::infinity();  ///< towards the viewer
    std::uint32_t face = kNone;                             ///< 2 leaf + side
  };

  /// From the end of `axis` that `sign` names.
  void drawOne(int axis, float sign, std::vector<glm::uvec4>& counts) const {
    const Bounds box = bounds(plant_, PartKind::kFoliage);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const float side = 1.001f * std::max({box.size().x, box.size().y, box.size().z});
    const float scale = static_cast<float>(size_) / side;
    const auto half = 0.5f * static_cast<float>(size_);
    std::vector<Pixel> picture(static_cast<std::size_t>(size_) * static_cast<std::size_t>(size_));
    for (std::uint32_t m = 0; m < plant_.meshes.size(); ++m) {
      const Mesh& mesh = plant_.meshes[m];
      const bool cut = plant_.materials[mesh.material].alpha_mode != AlphaMode::kOpaque;
      for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t) {
        glm::vec2 at[3];
        float depth[3];
        for (std::uint32_t c = 0; c < 3; ++c) {
          const glm::vec3 p = mesh.positions[mesh.indices[3 * t + c]] - box.center();
          at[c] = glm::vec2(p[u], p[v]) * scale + half;
          depth[c] = sign * p[axis];
        }
        const glm::vec2 e1 = at[1] - at[0], e2 = at[2] - at[0];
        const float area = e1.x * e2.y - e1.y * e2.x;
        if (area == 0.0f) continue;
        const std::uint32_t leaf = leaf_of_[m][t];
        const std::uint32_t face = leaf == kNone ? kNone : 2 * leaf + (area * sign > 0.0f ? 0 : 1);
        const glm::vec2 low = glm::min(at[0], glm::min(at[1], at[2]));
        const glm::vec2 high = glm::max(at[0], glm::max(at[1], at[2]));
        const auto first = [](float x) { return std::max(static_cast<int>(x - 0.5f), 0); };
        const auto end = [&](float x) { return std::min(static_cast<int>(x + 0.5f) + 1, size_); };
        if (high.x < 0.0f || high.y < 0.0f) continue;
        for (int y = first(low.y); y < end(high.y); ++y)
          for (int x = first(low.x); x < end(high.x); ++x) {
            const glm::vec2 d = glm::vec2(x, y) + 0.5f - at[0];
            const float b = (d.x * e2.y - d.y * e2.x) / area;
            const float c = (e1.x * d.y - e1.y * d.x) / area;
            if (b < 0.0f || c < 0.0f || b + c > 1.0f) continue;
            Pixel& pixel = picture[static_cast<std::size_t>(y) * static_cast<std::size_t>(size_) +
                                   static_cast<std::size_t>(x)];
            const float z = depth[0] + b * (depth[1] - depth[0]) + c * (depth[2] - depth[0]);
            if (face == kNone && z <= pixel.depth) continue;
            if (cut && scene_.cutAt({0.0f, {b, c}, 0, 0, m, t, true})) continue;
            if (face != kNone) ++counts[leaf][2 + static_cast<int>(face % 2)];
            if (z > pixel.depth) pixel = {z, face};
          }
      }
    }
    for (const Pixel& pixel : picture)
      if (pixel.face != kNone) ++counts[pixel.face / 2][static_cast<int>(pixel.face % 2)];
  }

  const Plant& plant_;
  const RayScene& scene_;
  int size_;
  std::vector<std::vector<std::uint32_t>> leaf_of_;
};

double rms(const Visibility& a, const Visibility& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const glm::dvec2 d = glm::dvec2(a[i]) - glm::dvec2(b[i]);
    sum += 0.5 * glm::dot(d, d);
  }
  return std::sqrt(sum / static_cast<double>(a.size()));
}

Visibility byRays(const Plant& plant, int directions, int rays, std::uint32_t seed = 1) {
  LeafVisibilityOptions options;
  options.directions = directions;
  options.rays = rays;
  options.seed = seed;
  return leafVisibility(plant, options);
}

void run(const std::string& species, std::uint32_t seed, int many, LeafForm form) {
  GrowOptions options;
  options.species = species;
  options.seed = seed;
  options.set = {{"LeafQuality", "0.5"}};  // half as many leaves, twice as large: about 20,000
  options.leaf_form = form;
  const Plant plant = grow(options);
  fmt::print("\n{}, leaves as {}: {} leaves, {} triangles\n", species,
             form == LeafForm::kMesh ? "meshes" : "cards", plant.leaves.size(),
             triangleCount(plant));
  struct Way {
    std::string name;
    int directions, rays;  ///< rays = 0: pictures of 1024^2
    double best = 1e30, best_cpu = 1e30;
    Visibility found = {};
  };
  std::vector<Way> ways = {{"6 pictures of 1024^2", 6, 0}};
  for (const int rays : {64, 256}) ways.push_back({"rays", 6, rays});
  for (const int rays : {64, 128, 256}) ways.push_back({"rays", 64, rays});
  const RayScene scene(plant);
  const Pictures pictures(plant, scene, 1024);
  for (int round = 0; round < kRounds; ++round)
    for (Way& way : ways) {  // interleaved: other work on the machine hits all alike
      Timer timer;
      const std::clock_t before = std::clock();
      way.found = way.rays == 0 ? pictures.draw() : byRays(plant, way.directions, way.rays);
      way.best = std::min(way.best, timer.seconds());
      way.best_cpu = std::min(way.best_cpu, static_cast<double>(std::clock() - before) /
                                                static_cast<double>(CLOCKS_PER_SEC));
    }
  const Visibility axes = byRays(plant, 6, many, 2), all = byRays(plant, many, many, 2);
  fmt::print("{:22} {:>10} {:>9} {:>7} {:>7} {:>11} {:>11}\n", "way", "directions", "rays/leaf",
             "ms", "CPU ms", "RMS, 6 axes", "RMS, around");
  for (const Way& way : ways)
    fmt::print("{:22} {:10} {:9} {:7.0f} {:7.0f} {:11.4f} {:11.4f}\n", way.name, way.directions,
               way.rays, 1e3 * way.best, 1e3 * way.best_cpu, rms(way.found, axes),
               rms(way.found, all));
}

}  // namespace
}  // namespace verdure

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const std::string species = argc > 1 ? argv[1] : "black-oak";
  const auto seed = static_cast<std::uint32_t>(argc > 2 ? std::atoi(argv[2]) : 4);
  const int many = argc > 3 ? std::atoi(argv[3]) : 2048;
  verdure::run(species, seed, many, verdure::LeafForm::kMesh);
  verdure::run(species, seed, many, verdure::LeafForm::kCard);
}
