#include <algorithm>
#include <cmath>
#include <vector>

#include "bake/coverage.h"
#include "base/parallel.h"
#include "base/random.h"
#include "rays/ray_scene.h"
#include "shared/color.h"
#include "shared/forest.h"
#include "shared/leaf.h"
#include "shared/octahedron.h"
#include "verdure/error.h"
#include "verdure/levels.h"

namespace verdure {
namespace {

/// Of a texel, sums over its rays.
struct Texel {
  glm::vec3 color{0.0f}, normal{0.0f};
  float covered = 0.0f, depth = 0.0f, ambient = 0.0f, foliage = 0.0f, through = 0.0f;
};

class ImpostorBake {
 public:
  ImpostorBake(const Plant& plant, const CrownLight* light, const ImpostorOptions& options)
      : plant_(plant), light_(light), options_(options), scene_(plant) {
    const Bounds box = bounds(plant);
    out_.views = options.views;
    out_.texels = options.texels;
    out_.center = box.center();
    for (const Mesh& mesh : plant.meshes)
      for (const glm::vec3& p : mesh.positions)
        out_.radius = std::max(out_.radius, glm::length(p - out_.center));
    // Half a texel of air, so that what lies at the border is not stretched.
    out_.radius *= 1.0f + 1.0f / static_cast<float>(options.texels);
    const int side = options.views * options.texels;
    for (Image* image : {&out_.color, &out_.normal, &out_.light}) *image = Image(side, side);
  }

  Impostor bake() {
    measureCrown();
    const int side = options_.views * options_.texels;
    parallelFor(static_cast<std::size_t>(side), 4, [&](std::size_t row) {
      const RayThread thread;
      for (int x = 0; x < side; ++x) bakeTexel(x, static_cast<int>(row));
    });
    return std::move(out_);
  }

 private:
  /// Fits the extinction to rays from what is seen of the foliage towards the upper hemisphere.
  void measureCrown() {
    constexpr int kRays = 4096;
    const Bounds box = bounds(plant_, PartKind::kFoliage);
    out_.crown_center = box.center();
    out_.crown_radii = glm::max(0.5f * box.size(), glm::vec3(1e-3f * out_.radius));
    std::vector<float> ways(kRays, -1.0f);
    std::vector<std::uint8_t> open(kRays, 0);
    parallelFor(kRays, 64, [&](std::size_t i) {
      const RayThread thread;
      Random random(i, 11);
      const auto upper = [&random] {
        const float y = random.uniform(), turn = random.uniform(0.0f, 6.2831853f);
        const float across = std::sqrt(1.0f - y * y);
        return glm::vec3(across * std::cos(turn), y, across * std::sin(turn));
      };
      const glm::vec3 toward = upper(), right = shared::viewRight(toward);
      const glm::vec2 at(random.uniform(-1.0f, 1.0f), random.uniform(-1.0f, 1.0f));
      Ray ray;
      ray.origin =
          out_.center + out_.radius * (at.x * right + at.y * glm::cross(toward, right) + toward);
      ray.direction = -toward;
      const std::optional<Hit> hit = scene_.closestHit(ray);
      if (!hit || !hit->foliage) return;
      const glm::vec3 light = upper();
      Ray back;
      back.direction = light;
      const float side = glm::dot(light, hit->normal) > 0.0f ? 1.0f : -1.0f;
      back.origin = scene_.originOff(hit->position, side * hit->normal);
      ways[i] = shared::wayThroughCrown((hit->position - out_.crown_center) / out_.crown_radii,
                                        light / out_.crown_radii);
      open[i] = scene_.occluded(back) ? 0 : 1;
    });
    double seen = 0.0;
    for (std::size_t i = 0; i < kRays; ++i)
      seen += ways[i] >= 0.0f ? static_cast<double>(open[i]) : 0.0;
    float low = 0.0f, high = 20.0f;
    for (int step = 0; step < 40; ++step) {
      const float middle = 0.5f * (low + high);
      double left = 0.0;
      for (const float way : ways)
        if (way >= 0.0f) left += std::exp(-double{middle} * double{way});
      (left > seen ? low : high) = middle;
    }
    out_.extinction = low;
  }

  void bakeTexel(int x, int y) {
    const int n = options_.texels, samples = options_.samples;
    const auto steps = static_cast<float>(options_.views - 1);
    const glm::vec3 toward = shared::octahedronDirection(
        glm::vec2(static_cast<float>(x / n), static_cast<float>(y / n)) / steps);
    const glm::vec3 right = shared::viewRight(toward), up = glm::cross(toward, right);
    Texel sum;
    for (int s = 0; s < samples * samples; ++s) {
      const glm::vec2 at =
          (glm::vec2(static_cast<float>(x % n), static_cast<float>(y % n)) +
           (glm::vec2(static_cast<float>(s % samples), static_cast<float>(s / samples)) + 0.5f) /
               static_cast<float>(samples)) *
              (2.0f / static_cast<float>(n)) -
          1.0f;
      if (glm::dot(at, at) > 1.0f) continue;
      Ray ray;
      ray.origin = out_.center + out_.radius * (at.x * right - at.y * up + toward);
      ray.direction = -toward;
      ray.t_max = 2.0f * out_.radius;
      if (const std::optional<Hit> hit = scene_.closestHit(ray)) add(*hit, sum);
    }
    write(sum, 1.0f / static_cast<float>(samples * samples), x, y);
  }

  void add(const Hit& hit, Texel& sum) const {
    sum.covered += 1.0f;
    sum.color += hit.reflectance;
    sum.depth += 1.0f - hit.distance / (2.0f * out_.radius);
    sum.normal += hit.front ? hit.vertex_normal : -hit.vertex_normal;
    sum.ambient += ambientAt(hit);
    if (!hit.foliage) return;
    sum.foliage += 1.0f;
    const float guess = shared::leafTransmittance(hit.reflectance).g;
    if (guess > 0.0f) sum.through += std::min(0.5f * hit.transmittance.g / guess, 1.0f);
  }

  float ambientAt(const Hit& hit) const {
    if (light_ == nullptr) return 1.0f;
    const std::vector<float>& ambient = light_->meshes[hit.mesh].ambient;
    const std::uint32_t* corner = &plant_.meshes[hit.mesh].indices[std::size_t{hit.triangle} * 3];
    const glm::vec2& b = hit.barycentric;
    return (1.0f - b.x - b.y) * ambient[corner[0]] + b.x * ambient[corner[1]] +
           b.y * ambient[corner[2]];
  }

  void write(const Texel& sum, float weight, int x, int y) {
    std::uint8_t* color = out_.color.at(x, y);
    std::uint8_t* normal = out_.normal.at(x, y);
    std::uint8_t* light = out_.light.at(x, y);
    for (int c = 0; c < 3; ++c) {
      color[c] = toByte(shared::srgbFromLinear(std::min(sum.color[c] * weight, 1.0f)));
      normal[c] = toByte((128.0f + 127.0f * sum.normal[c] * weight) / 255.0f);
    }
    color[3] = toByte(sum.covered * weight);
    normal[3] = toByte(sum.depth * weight);
    light[0] = toByte(sum.ambient * weight);
    light[1] = toByte(sum.foliage * weight);
    light[2] = toByte(sum.through * weight);
    light[3] = 255;
  }

  const Plant& plant_;
  const CrownLight* light_;
  const ImpostorOptions& options_;
  RayScene scene_;
  Impostor out_;
};

/// The level whose leaves grow so that it covers as much as the plant does. `probe` has the plant's
/// materials and textures, and takes the meshes that are tried.
PlantLevel coveringLevel(const Plant& plant, Plant& probe, double covered,
                         SimplifyOptions options) {
  constexpr int kTries = 6;
  constexpr double kClose = 0.003;
  PlantLevel level = simplifyPlant(plant, options);
  if (plant.leaves.empty()) return level;
  double slope = 1.0;  // of the logarithms: what is covered by the leaves' length
  double last_growth = 0.0, last = 0.0;
  for (int i = 0; i < kTries; ++i) {
    const double growth = std::log(double{level.leaf_growth});
    probe.meshes = level.meshes;
    const double now = std::log(meanCoverage(probe) / covered);
    if (!std::isfinite(now) || std::abs(now) < kClose) break;
    if (i > 0 && std::abs(growth - last_growth) > 1e-6)
      slope = std::clamp((now - last) / (growth - last_growth), 0.2, 2.0);
    last = now;
    last_growth = growth;
    options.leaf_growth = static_cast<float>(std::exp(growth - std::clamp(now / slope, -0.4, 0.4)));
    level = simplifyPlant(plant, options);
  }
  return level;
}

}  // namespace

double meanCoverage(const Plant& plant) {
  constexpr int kDirections = 8, kSide = 96;
  const RayScene scene(plant);
  const Bounds box = bounds(plant);
  const float radius = 0.5f * glm::length(box.size());
  std::vector<std::uint32_t> hits(kDirections * kSide, 0);
  parallelFor(hits.size(), 4, [&](std::size_t row) {
    const RayThread thread;
    const auto d = static_cast<float>(row / kSide);
    // Around the horizon, rising: a forest is seen from the side and from hills.
    const float turn = 2.39996323f * d, rise = 0.6f * (d + 0.5f) / kDirections;
    const glm::vec3 toward(std::cos(rise) * std::sin(turn), std::sin(rise),
                           std::cos(rise) * std::cos(turn));
    const glm::vec3 right = shared::viewRight(toward), up = glm::cross(toward, right);
    for (int x = 0; x < kSide; ++x) {
      const glm::vec2 at =
          (glm::vec2(static_cast<float>(x), static_cast<float>(row % kSide)) + 0.5f) *
              (2.0f / kSide) -
          1.0f;
      Ray ray;
      ray.origin = box.center() + radius * (at.x * right - at.y * up + toward);
      ray.direction = -toward;
      if (scene.occluded(ray)) ++hits[row];
    }
  });
  double sum = 0.0;
  for (const std::uint32_t count : hits) sum += count;
  return sum / (double{kDirections} * kSide * kSide);
}

Impostor bakeImpostor(const Plant& plant, const CrownLight* light, const ImpostorOptions& options) {
  const auto within = [&](int value, int least, int most, const char* what) {
    if (value < least || value > most)
      throw Error(plant.name, std::string("an impostor's ") + what + " is out of range",
                  "choose " + std::to_string(least) + " to " + std::to_string(most));
  };
  within(options.views, 2, 32, "number of views");
  within(options.texels, 16, 512, "number of texels");
  within(options.samples, 1, 16, "number of samples");
  if (triangleCount(plant) == 0)
    throw Error(plant.name, "has no triangles", "there is nothing to see of it");
  return ImpostorBake(plant, light, options).bake();
}

PlantLevels makeLevels(const Plant& plant, const CrownLight* light, const LevelOptions& options) {
  PlantLevels levels;
  const double covered = meanCoverage(plant);
  Plant probe;
  probe.name = plant.name;
  probe.materials = plant.materials;
  probe.textures = plant.textures;
  for (const float share : options.leaf_shares) {
    if (!(share > 0.0f && share < 1.0f))
      throw Error(plant.name, "a share of leaves is out of range", "choose between 0 and 1");
    levels.meshes.push_back(
        coveringLevel(plant, probe, covered, {.leaf_share = share, .wood_share = share}));
  }
  levels.impostor = bakeImpostor(plant, light, options.impostor);
  return levels;
}

}  // namespace verdure
