// The reference: a path tracer with next-event estimation and multiple importance sampling (Veach,
// Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995; the
// balance heuristic).
#include "reference/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "base/parallel.h"
#include "base/progress.h"
#include "base/random.h"
#include "rays/ray_scene.h"
#include "reference/leaf_crossing.h"
#include "reference/sky_sampler.h"
#include "reference/surface_model.h"
#include "scene/camera.h"
#include "scene/look.h"
#include "shared/sky.h"
#include "verdure/error.h"

namespace verdure {
namespace {

constexpr int kRouletteFrom = 4;       ///< scatterings after which paths may end by chance
constexpr float kThroughShare = 0.6f;  ///< of the paths that go on through a LeafCrossing
constexpr int kTile = 16;              ///< side of what a thread works on, pixels

float luminanceOf(const glm::vec3& c) {
  return glm::dot(c, glm::vec3(0.2126f, 0.7152f, 0.0722f));
}

/// The sun's disk as a light: a cone of even luminance above the horizon.
class SunCone {
 public:
  explicit SunCone(const Sun& sun)
      : axis_(sun.direction),
        luminance_(sun.luminance),
        one_minus_cos_(2.0f * std::pow(std::sin(0.5f * sun.angular_radius), 2.0f)) {
    const glm::vec3 away = std::abs(axis_.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    x_ = glm::normalize(glm::cross(away, axis_));
    y_ = glm::cross(axis_, x_);
  }

  bool shines() const { return luminance_ != glm::vec3(0.0f) && one_minus_cos_ > 0.0f; }
  glm::vec3 sample(Random& random) const {
    const float below = random.uniform() * one_minus_cos_;  // 1 - cos of the angle
    const float ring = std::sqrt(std::max(below * (2.0f - below), 0.0f));
    const float turn = random.uniform(0.0f, glm::two_pi<float>());
    return glm::normalize(axis_ * (1.0f - below) + x_ * (ring * std::cos(turn)) +
                          y_ * (ring * std::sin(turn)));
  }
  bool contains(const glm::vec3& direction) const {
    const glm::vec3 apart = direction - axis_;  // |apart|^2 = 2 (1 - cos)
    return glm::dot(apart, apart) <= 2.0f * one_minus_cos_;
  }
  float density() const { return 1.0f / (glm::two_pi<float>() * one_minus_cos_); }
  glm::vec3 luminance(const glm::vec3& direction) const {
    return direction.y >= 0.0f ? luminance_ : glm::vec3(0.0f);
  }

 private:
  glm::vec3 axis_, luminance_, x_{0.0f}, y_{0.0f};
  float one_minus_cos_;
};

class BlackSky final : public Sky {
 public:
  glm::vec3 luminance(const glm::vec3&) const override { return glm::vec3(0.0f); }
  int rows() const override { return 32; }
};

const Sky& skyOf(const Daylight& lights) {
  static const BlackSky black;
  return lights.sky != nullptr ? *lights.sky : static_cast<const Sky&>(black);
}

class PathTracer {
 public:
  PathTracer(const Scene& scene, const Daylight& lights, const ReferenceOptions& options,
             const LeafCrossing* leaf)
      : scene_(scene),
        leaf_(leaf),
        options_(options),
        rays_(scene, {.leaf_maps = options.leaf_maps}),
        surfaces_(scene, rays_, {options.normal_maps, options.gloss, options.leaf_maps}),
        sky_(skyOf(lights)),
        sky_sampler_(sky_),
        sun_(lights.sun),
        camera_(cameraRays(options.camera,
                           static_cast<float>(options.width) / static_cast<float>(options.height))),
        haze_half_(
            std::max(look::kHazeHalf * glm::length(options.camera.eye - options.camera.target),
                     look::kHazeHalfLeast_m)) {}

  /// Luminance along one path through pixel x, y.
  glm::vec3 trace(int x, int y, Random& random) const {
    Ray ray;
    ray.origin = camera_.eye;
    const float across =
        2.0f * (static_cast<float>(x) + random.uniform()) / static_cast<float>(options_.width) -
        1.0f;
    const float down =
        2.0f * (static_cast<float>(y) + random.uniform()) / static_cast<float>(options_.height) -
        1.0f;
    ray.direction = glm::normalize(camera_.forward + across * camera_.right + down * camera_.down);

    const std::optional<RayHit> hit = firstSeen(ray);
    if (!hit) return seenSky(ray.direction);
    const SurfaceModel::Point point = surfaces_.at(*hit, ray);
    if (leaf_ != nullptr) {
      // Both ways on, not one by chance.
      glm::vec3 light(0.0f);
      for (const bool through : {true, false}) {
        SurfaceModel::Point from = point;
        glm::vec3 throughput(1.0f);
        if (crossLeaf(*hit, through, from, throughput, random))
          light += lightFrom(from, throughput, random);
      }
      return light;
    }
    if (!hit->ground()) return lightFrom(point, glm::vec3(1.0f), random);
    const float haze = shared::hazeShare(glm::length(point.position - ray.origin), haze_half_);
    return haze * sky_.luminance(shared::domeDirection(ray.direction)) +
           lightFrom(point, glm::vec3(1.0f - haze), random);
  }

 private:
  /// Light that leaves the first surface of a path, times `throughput`.
  glm::vec3 lightFrom(SurfaceModel::Point point, glm::vec3 throughput, Random& random) const {
    glm::vec3 light(0.0f);
    for (int depth = 1;; ++depth) {
      if (options_.search != LightSearch::kSurface)
        light += throughput * sampledLight(point, random);
      const std::optional<Scatterer::Sample> next = point.scatterer.sample(random);
      if (!next) return light;
      throughput *= next->weight;
      const float density = point.scatterer.density(next->direction);  // that chose the ray
      if (depth >= kRouletteFrom) {
        const float survival = std::min(std::max({throughput.x, throughput.y, throughput.z}), 1.0f);
        if (random.uniform() >= survival) return light;
        throughput /= survival;
      }
      const Ray ray{originTowards(point, next->direction), 0.0f, next->direction};
      const std::optional<RayHit> hit = rays_.trace(ray);
      if (!hit) return light + throughput * foundSky(ray.direction, density);
      if (depth == options_.bounces) return light;
      point = surfaces_.at(*hit, ray);
      if (leaf_ != nullptr) {
        const bool through = random.uniform() < kThroughShare;
        throughput /= through ? kThroughShare : 1.0f - kThroughShare;
        if (!crossLeaf(*hit, through, point, throughput, random)) return light;
      }
    }
  }

  /// Takes a path to the other side of the leaf, where light enters as it falls on a white surface,
  /// or leaves it on this one. False where it ends.
  bool crossLeaf(const RayHit& hit, bool through, SurfaceModel::Point& point, glm::vec3& throughput,
                 Random& random) const {
    if (!hit.front) return false;  // in by the open outline, between both surfaces
    if (through) {
      const std::optional<LeafCrossing::Entry> entry = leaf_->sample(hit, random);
      if (!entry) return false;
      throughput *= entry->weight;
      point = surfaces_.at(entry->hit, {point.position, 0.0f, -entry->outside});
      point.scatterer.reflectance = glm::vec3(1.0f);
    }
    point.scatterer.transmittance = glm::vec3(0.0f);
    return true;
  }

  /// What the eye sees along a ray, which then starts behind all that it does not see.
  std::optional<RayHit> firstSeen(Ray& ray) const {
    for (;;) {
      std::optional<RayHit> hit = rays_.trace(ray);
      if (!hit || hit->ground() || scene_.items[hit->item].seen) return hit;
      // Another rounding may find the same triangle again, but a little farther each time.
      ray.t_min = std::nextafter(std::max(hit->distance, ray.t_min),
                                 std::numeric_limits<float>::infinity());
      // What lies on the ground, as the ends of trunks do, must not take the ground away.
      const float ground = (scene_.ground_height - ray.origin.y) / ray.direction.y;
      if (scene_.ground && ray.direction.y < 0.0f && ray.t_min > ground)
        return RayHit{.distance = ground};
    }
  }

  glm::vec3 originTowards(const SurfaceModel::Point& point, const glm::vec3& direction) const {
    const glm::vec3& side = point.scatterer.side;
    return rays_.originOff(point.position, glm::dot(direction, side) > 0.0f ? side : -side);
  }

  /// Sky and sun as the eye sees them.
  glm::vec3 seenSky(const glm::vec3& direction) const {
    glm::vec3 seen = sky_.luminance(shared::domeDirection(direction));
    if (sun_.shines() && sun_.contains(direction)) seen += sun_.luminance(direction);
    return seen;
  }

  /// Sky and sun met by a ray that a surface chose with `density`, weighted against their own.
  glm::vec3 foundSky(const glm::vec3& direction, float density) const {
    if (options_.search == LightSearch::kLights) return glm::vec3(0.0f);
    const auto weight = [&](float other) {
      return options_.search == LightSearch::kSurface ? 1.0f : density / (density + other);
    };
    glm::vec3 found(0.0f);
    if (!sky_sampler_.empty())
      found += sky_.luminance(direction) * weight(sky_sampler_.density(direction));
    if (sun_.shines() && sun_.contains(direction))
      found += sun_.luminance(direction) * weight(sun_.density());
    return found;
  }

  /// One ray to the sky and one to the sun.
  glm::vec3 sampledLight(const SurfaceModel::Point& point, Random& random) const {
    glm::vec3 sum(0.0f);
    const auto add = [&](const glm::vec3& direction, const glm::vec3& luminance, float density) {
      const glm::vec3 lit = point.scatterer.value(direction) * luminance;
      if (!(density > 0.0f) || lit == glm::vec3(0.0f)) return;
      if (rays_.occluded({originTowards(point, direction), 0.0f, direction})) return;
      const float other =
          options_.search == LightSearch::kLights ? 0.0f : point.scatterer.density(direction);
      sum += lit / (density + other);  // lit / density, times density / (density + other)
    };
    if (!sky_sampler_.empty()) {
      const float u = random.uniform(), v = random.uniform();
      const glm::vec3 direction = sky_sampler_.sample(u, v);
      add(direction, sky_.luminance(direction), sky_sampler_.density(direction));
    }
    if (sun_.shines()) {
      const glm::vec3 direction = sun_.sample(random);
      add(direction, sun_.luminance(direction), sun_.density());
    }
    return sum;
  }

  const Scene& scene_;
  const LeafCrossing* leaf_;
  const ReferenceOptions& options_;
  RayScene rays_;
  SurfaceModel surfaces_;
  const Sky& sky_;
  SkySampler sky_sampler_;
  SunCone sun_;
  CameraRays camera_;
  float haze_half_;
};

/// Sums of a pixel's paths.
struct PixelSum {
  glm::dvec3 light{0.0};
  double squares = 0.0;  ///< of the luminance
};

void checkOptions(const ReferenceOptions& options) {
  const auto demand = [](bool fine, const char* what, const char* must) {
    if (!fine) throw Error("reference", std::string(what) + " " + must);
  };
  demand(options.width > 0 && options.height > 0, "the picture", "has no pixels");
  demand(options.samples >= 1, "samples", "must be at least 1");
  demand(options.bounces >= 1, "bounces", "must be at least 1");
  demand(options.seconds >= 0.0, "seconds", "must not be negative");
  demand(options.noise >= 0.0, "noise", "must not be negative");
}

}  // namespace

ReferencePicture renderReference(const Scene& scene, const Daylight& lights,
                                 const ReferenceOptions& options) {
  return tracePicture(scene, lights, options, nullptr);
}

ReferencePicture tracePicture(const Scene& scene, const Daylight& lights,
                              const ReferenceOptions& options, const LeafCrossing* leaf) {
  checkOptions(options);
  const Timer timer;
  const PathTracer tracer(scene, lights, options, leaf);
  const int tiles_across = (options.width + kTile - 1) / kTile;
  const int tiles_down = (options.height + kTile - 1) / kTile;
  const std::size_t pixels =
      static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
  std::vector<PixelSum> sums(pixels);

  /// Paths first, first + 1, ..., last - 1 of each pixel.
  const auto round = [&](int first, int last) {
    const auto tiles =
        static_cast<std::size_t>(tiles_across) * static_cast<std::size_t>(tiles_down);
    parallelFor(tiles, 1, [&](std::size_t tile) {
      const RayThread flush_denormals;
      const int x0 = static_cast<int>(tile) % tiles_across * kTile;
      const int y0 = static_cast<int>(tile) / tiles_across * kTile;
      for (int y = y0; y < std::min(y0 + kTile, options.height); ++y)
        for (int x = x0; x < std::min(x0 + kTile, options.width); ++x) {
          const std::size_t pixel =
              static_cast<std::size_t>(y) * static_cast<std::size_t>(options.width) +
              static_cast<std::size_t>(x);
          PixelSum& sum = sums[pixel];
          for (int s = first; s < last; ++s) {
            // Each path has numbers of its own, so that order and threads mean nothing.
            Random random(hash(hash(hash(options.seed) + pixel) + static_cast<std::uint64_t>(s)));
            const glm::vec3 light = tracer.trace(x, y, random);
            sum.light += glm::dvec3(light);
            const double l = double{luminanceOf(light)};
            sum.squares += l * l;
          }
        }
    });
  };

  ReferencePicture picture;
  picture.image = HdrImage(options.width, options.height);
  picture.standard_error.resize(pixels);
  const auto resolve = [&](int n) {
    double errors = 0.0, light = 0.0;
    for (std::size_t i = 0; i < pixels; ++i) {
      const glm::dvec3 mean = sums[i].light / static_cast<double>(n);
      picture.image.rgb[i] = glm::vec3(mean);
      const double l = glm::dot(mean, glm::dvec3(0.2126, 0.7152, 0.0722));
      const double variance = std::max(sums[i].squares / n - l * l, 0.0) / std::max(n - 1, 1);
      picture.standard_error[i] = n > 1 ? static_cast<float>(std::sqrt(variance)) : 0.0f;
      errors += variance;
      light += l;
    }
    const double count = static_cast<double>(pixels);
    picture.samples = n;
    picture.noise = light > 0.0 && n > 1 ? std::sqrt(errors / count) / (light / count) : 0.0;
  };

  int done = 0;
  while (done < options.samples) {
    const int next = std::min(options.samples, done < 4 ? 4 : done + std::min(done, 16));
    round(done, next);
    done = next;
    double share = static_cast<double>(done) / options.samples;
    bool enough = done >= options.samples;
    if (options.seconds > 0.0) {
      share = std::max(share, timer.seconds() / options.seconds);
      enough = enough || timer.seconds() >= options.seconds;
    }
    if (options.noise > 0.0) {
      resolve(done);
      enough = enough || picture.noise <= options.noise;
    }
    if (options.progress) options.progress(enough ? 1.0 : std::min(share, 1.0));
    if (enough) break;
  }
  resolve(done);
  picture.seconds = timer.seconds();
  return picture;
}

}  // namespace verdure
