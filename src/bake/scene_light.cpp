#include "bake/scene_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bake/ray_directions.h"
#include "shared/sky.h"
#include "verdure/error.h"
#include "verdure/harmonics.h"

namespace verdure {
namespace {

/// No patch is larger than this share of the plant's surface.
constexpr double kLargestShare = 1.0 / 8192.0;
constexpr std::uint32_t kMostParts = 90;  ///< along an edge
constexpr int kCells = 64;                ///< along each side of the ground's square
constexpr std::uint64_t kPatchStream = 3, kCellStream = 4, kPassStream = 5;
constexpr double kGatherCost = 0.05;  ///< of one slot, beside a ray

/// Rays for each side of a patch. A vertex gathers from many patches, whose noise averages out.
std::size_t raysEach(const RayOptions& options) {
  return static_cast<std::size_t>(std::max(options.rays / 8, std::min(options.rays, 8)));
}

// A triangle cut into n * n alike: row j (of the third corner's weight) has n - j of the triangle's
// own kind and, between them, n - j - 1 turned round.
std::uint32_t partAt(const glm::vec2& barycentric, std::uint32_t n) {
  if (n == 1) return 0;
  const glm::vec2 at = glm::max(barycentric, 0.0f) * static_cast<float>(n);
  const std::uint32_t j = std::min(static_cast<std::uint32_t>(at.y), n - 1);
  const std::uint32_t i = std::min(static_cast<std::uint32_t>(at.x), n - 1 - j);
  const bool turned =
      i + j + 1 < n && at.x - static_cast<float>(i) + at.y - static_cast<float>(j) > 1.0f;
  return n * n - (n - j) * (n - j) + 2 * i + (turned ? 1 : 0);
}

/// The barycentric coordinates of a part's point, itself given by them.
glm::vec2 pointOfPart(std::uint32_t part, std::uint32_t n, const glm::vec2& inside) {
  std::uint32_t j = 0, row = 2 * n - 1;
  for (; part >= row; ++j, row -= 2) part -= row;
  const glm::vec2 corner(static_cast<float>(part / 2), static_cast<float>(j));
  return (corner + (part % 2 == 0 ? inside : 1.0f - inside)) / static_cast<float>(n);
}

}  // namespace

GroundSquare groundSquare(const Plant& plant, float height) {
  const Bounds box = bounds(plant);
  const float half = std::max(
      {0.5f * std::max(box.size().x, box.size().z) + std::max(box.max.y - height, 0.0f), 1e-3f});
  return {glm::vec2(box.center().x, box.center().z) - half, 2.0f * half};
}

SceneLight::SceneLight(const Plant& plant, const RayBake& rays, const RayOptions& options,
                       int bands)
    : plant_(plant),
      rays_(rays),
      options_(options),
      bands_(bands),
      count_(static_cast<std::size_t>(std::max(bands * bands, 1))),
      rays_each_(raysEach(options)) {
  if (options.bounces > 0) layPatches();
}

void SceneLight::layPatches() {
  first_triangle_ = {0};
  double area = 0.0;
  for (const Mesh& mesh : plant_.meshes) {
    first_triangle_.push_back(first_triangle_.back() + mesh.triangleCount());
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) area += areaOf(mesh, t);
  }
  splits_.reserve(first_triangle_.back());
  std::size_t slots = 0;
  for (std::uint32_t m = 0; m < plant_.meshes.size(); ++m)
    for (std::size_t t = 0; t < plant_.meshes[m].triangleCount(); ++t) {
      const double parts = areaOf(plant_.meshes[m], t) / std::max(area * kLargestShare, 1e-30);
      const auto n = static_cast<std::uint32_t>(
          std::clamp(std::ceil(std::sqrt(parts)), 1.0, static_cast<double>(kMostParts)));
      splits_.push_back({static_cast<Slot>(slots), n});
      slots += std::size_t{n} * n * sidesOf(m);
    }
  first_cell_ = static_cast<Slot>(slots);
  if (options_.ground_height) {
    square_ = groundSquare(plant_, *options_.ground_height);
    slots += std::size_t{kCells} * kCells + 1;
  }
  const std::size_t bytes =
      slots * (count_ * sizeof(float) * (options_.bounces > 1 ? 7 : 4) +
               (options_.bounces > 1 ? rays_each_ * sizeof(Slot) : 0) + sizeof(Side)) +
      splits_.size() * sizeof(Split);
  if (bytes > options_.max_memory_bytes || slots >= kInside)
    throw Error("bounced light",
                fmt::format("needs {} MiB, more than the {} MiB allowed", bytes >> 20,
                            options_.max_memory_bytes >> 20),
                "use fewer bands, no bounces, or allow more");
  slot_count_ = static_cast<Slot>(slots);
}

std::size_t SceneLight::sidesOf(std::uint32_t mesh) const {
  return plant_.meshes[mesh].kind == PartKind::kFoliage ? 2 : 1;
}

SceneLight::TriangleId SceneLight::triangleOf(std::size_t number) const {
  const auto after = std::upper_bound(first_triangle_.begin(), first_triangle_.end(), number);
  const auto mesh = static_cast<std::size_t>(after - first_triangle_.begin() - 1);
  return {static_cast<std::uint32_t>(mesh),
          static_cast<std::uint32_t>(number - first_triangle_[mesh])};
}

double SceneLight::rayCount() const {
  return static_cast<double>(slot_count_) * static_cast<double>(rays_each_) *
         (1.0 + kGatherCost * options_.bounces);
}

SceneLight::Slot SceneLight::slotOf(const Ray& ray, const RayHit& hit) const {
  if (hit.ground()) {
    const glm::vec3 p = ray.origin + ray.direction * hit.distance;
    const glm::vec2 at = (glm::vec2(p.x, p.z) - square_.corner) * (kCells / square_.side);
    if (!(at.x >= 0.0f && at.y >= 0.0f && at.x < kCells && at.y < kCells)) return slot_count_ - 1;
    return first_cell_ + static_cast<Slot>(at.y) * kCells + static_cast<Slot>(at.x);
  }
  const bool leaf = plant_.meshes[hit.mesh].kind == PartKind::kFoliage;
  if (!leaf && !hit.front) return kInside;
  const Split& split = splits_[first_triangle_[hit.mesh] + hit.triangle];
  const std::uint32_t part = partAt(hit.barycentric, split.n);
  return split.first + (leaf ? 2 * part + (hit.front ? 0 : 1) : part);
}

SceneLight::Slot SceneLight::follow(const Ray& ray, float* direct) const {
  const bool sky = !options_.ground_height || ray.direction.y >= 0.0f;
  if (options_.bounces == 0) {
    if (!sky || rays_.scene.occluded(ray)) return kBlack;
  } else if (const std::optional<RayHit> hit = rays_.scene.trace(ray)) {
    return slotOf(ray, *hit);
  } else if (!sky) {
    return kBlack;
  }
  addSky(ray.direction, direct);
  return kBlack;
}

void SceneLight::addSky(const glm::vec3& direction, float* direct) const {
  if (bands_ == 0) {
    direct[0] += 1.0f;
    return;
  }
  std::array<float, kMaxBands * kMaxBands> values;
  harmonicsAt(direction, bands_, values.data());
  for (std::size_t i = 0; i < count_; ++i) direct[i] += values[i];
}

void SceneLight::gather(std::span<const Slot> slots, float* sums) const {
  const std::size_t n = 3 * count_;
  constexpr std::size_t kAhead = 4;
  for (std::size_t s = 0; s < slots.size(); ++s) {
#if defined(__GNUC__)
    if (s + kAhead < slots.size() && slots[s + kAhead] < kInside)
      for (std::size_t i = 0; i < n; i += 16)
        __builtin_prefetch(&passed_[slots[s + kAhead] * n + i]);
#endif
    if (slots[s] >= kInside) continue;
    const float* values = &passed_[slots[s] * n];
    for (std::size_t i = 0; i < n; ++i) sums[i] += values[i];
  }
}

void SceneLight::tracePatch(TriangleId id, std::uint32_t part, Random& random) {
  const Split& split = splits_[first_triangle_[id.mesh] + id.triangle];
  const std::size_t sides = sidesOf(id.mesh), first = split.first + part * sides;
  RayHit at;
  at.item = 0;
  at.mesh = id.mesh;
  at.triangle = id.triangle;
  const auto isThere = [&] {
    if (rays_.scene.cutAt(at)) return false;
    return !options_.ground_height ||
           rays_.scene.surfaceAt(at, {}).position.y >= *options_.ground_height;
  };
  for (std::size_t side = 0; side < sides; ++side) {
    const ShiftedLattice lattice(static_cast<int>(rays_each_), random);
    const std::size_t slot = first + side;
    at.front = side == 0;
    Side mean;
    std::size_t traced = 0;
    for (std::size_t r = 0; r < rays_each_; ++r) {
      constexpr int kTries = 32;
      bool found = false;
      for (int t = 0; !found && t < kTries; ++t) {
        glm::vec2 inside(random.uniform(), random.uniform());
        if (inside.x + inside.y > 1.0f) inside = 1.0f - inside;
        at.barycentric = pointOfPart(part, split.n, inside);
        found = isThere();
      }
      if (!found) continue;
      const SurfacePoint point = rays_.scene.surfaceAt(at, {});
      const glm::vec3 normal = side == 0 ? point.normal : -point.normal;
      const glm::vec2 u = lattice.point(static_cast<int>(r));
      Ray ray;
      ray.origin = rays_.scene.originOff(point.position, normal);
      ray.direction = axesAround(normal) * cosineDirection(u.x, u.y);
      const Slot met = follow(ray, &direct_[slot * count_]);
      if (met == kInside) continue;  // the point lies within wood, where nothing sees it
      if (!met_.empty()) met_[slot * rays_each_ + r] = met;
      ++traced;
      mean.reflectance += point.reflectance;
      mean.transmittance += point.transmittance;
    }
    if (traced == 0) continue;
    const float weight = 1.0f / static_cast<float>(traced);
    sides_[slot] = {mean.reflectance * weight, mean.transmittance * weight, weight};
  }
}

/// Cell kCells^2 stands for the open ground.
void SceneLight::traceCell(std::size_t cell, Random& random) {
  constexpr int kOpenRays = 4096;
  const std::size_t slot = first_cell_ + cell;
  const glm::vec3 up(0.0f, 1.0f, 0.0f);
  const bool open = slot + 1 == slot_count_;
  const int count = open ? kOpenRays : static_cast<int>(rays_each_);
  const ShiftedLattice lattice(count, random);
  for (int r = 0; r < count; ++r) {
    const glm::vec2 u = lattice.point(r);
    Ray ray;
    ray.direction = axesAround(up) * cosineDirection(u.x, u.y);
    if (open) {
      addSky(ray.direction, &direct_[slot * count_]);
      continue;
    }
    const glm::vec2 at = square_.corner + (glm::vec2(static_cast<float>(cell % kCells),
                                                     static_cast<float>(cell / kCells)) +
                                           glm::vec2(random.uniform(), random.uniform())) *
                                              (square_.side / kCells);
    ray.origin = rays_.scene.originOff({at.x, *options_.ground_height, at.y}, up);
    const Slot met = follow(ray, &direct_[slot * count_]);
    if (!met_.empty()) met_[slot * rays_each_ + static_cast<std::size_t>(r)] = met;
  }
  sides_[slot].weight = 1.0f / static_cast<float>(count);
  sides_[slot].reflectance = shared::groundMeanColor();
}

void SceneLight::passOn(Slot first, std::size_t sides, bool again,
                        std::vector<float>& passed) const {
  std::array<std::array<float, 3 * kMaxBands * kMaxBands>, 2> light{};
  for (std::size_t s = 0; s < sides; ++s) {
    const std::size_t slot = first + s;
    if (again) gather({&met_[slot * rays_each_], rays_each_}, light[s].data());
    for (std::size_t i = 0; i < 3 * count_; ++i)
      light[s][i] = (light[s][i] + direct_[slot * count_ + i / 3]) * sides_[slot].weight;
  }
  for (std::size_t s = 0; s < sides; ++s) {
    const Side& side = sides_[first + s];
    float* out = &passed[(first + s) * 3 * count_];
    for (std::size_t i = 0; i < 3 * count_; ++i) {
      const int c = static_cast<int>(i % 3);
      out[i] = side.reflectance[c] * light[s][i] + side.transmittance[c] * light[1 - s][i];
    }
  }
}

void SceneLight::passAll(bool again, double begin, double end) {
  std::vector<float> passed(3 * count_ * slot_count_);
  const double cells_begin =
      begin + (end - begin) * static_cast<double>(first_cell_) / static_cast<double>(slot_count_);
  rays_.forEach(splits_.size(), kPassStream, begin, cells_begin, [&](std::size_t t, Random&) {
    const std::size_t sides = sidesOf(triangleOf(t).mesh);
    const std::uint32_t n = splits_[t].n;
    for (Slot part = 0; part < n * n; ++part)
      passOn(splits_[t].first + part * static_cast<Slot>(sides), sides, again, passed);
  });
  rays_.forEach(slot_count_ - first_cell_, kPassStream, cells_begin, end,
                [&](std::size_t cell, Random&) {
                  passOn(first_cell_ + static_cast<Slot>(cell), 1, again, passed);
                });
  passed_.swap(passed);
}

void SceneLight::bounce(double end) {
  if (slot_count_ == 0) return;
  const double pass = end * kGatherCost / (1.0 + kGatherCost * options_.bounces);
  const double traced = end - pass * options_.bounces;
  const double cells_begin =
      traced * static_cast<double>(first_cell_) / static_cast<double>(slot_count_);
  sides_.resize(slot_count_);
  direct_.resize(count_ * slot_count_);
  if (options_.bounces > 1) met_.resize(rays_each_ * slot_count_, kBlack);
  rays_.forEach(splits_.size(), kPatchStream, 0.0, cells_begin, [&](std::size_t t, Random& random) {
    const TriangleId id = triangleOf(t);
    for (std::uint32_t part = 0; part < splits_[t].n * splits_[t].n; ++part)
      tracePatch(id, part, random);
  });
  rays_.forEach(slot_count_ - first_cell_, kCellStream, cells_begin, traced,
                [&](std::size_t cell, Random& random) { traceCell(cell, random); });
  for (int b = 0; b < options_.bounces; ++b)
    passAll(b > 0, traced + pass * b, traced + pass * (b + 1));
  sides_ = {};
  direct_ = {};
  met_ = {};
}

}  // namespace verdure
