// Radii are drawn from tabulated T(r, d) at the thickness where light leaves, and now and then from
// plain poles, because T at the thickness where it entered may be a higher and narrower spike. T is
// a sum of poles (z / R^3) (1 + s R) exp(-s R) with R^2 = r^2 + z^2; without absorption one is the
// density z / (2 pi R^3), whose radii are drawn in closed form and which falls off more slowly, so
// that no weight is large.
#include "reference/leaf_crossing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/path_tracer.h"
#include "verdure/error.h"
#include "verdure/leaf_reference.h"

namespace verdure {
namespace {

double surfaceReflection(const LeafSet& set, const LeafBakeOptions& options) {
  checkLeafSet(set, set.name);
  if (!options.surface_reflection) return insideReflection(double{set.optics.refractive_index});
  const float rho = *options.surface_reflection;
  if (!(rho >= 0.0f && rho < 1.0f))
    throw Error("surface_reflection", "is out of range", "give a number in [0, 1)");
  return double{rho};
}

constexpr int kRings = 128;
constexpr double kInRings = 0.998;     ///< share of T that they hold
constexpr double kByRings = 0.8;       ///< share of the radii that are drawn from them
constexpr double kLevelRatio = 1.125;  ///< of the pole's height, from one table to the next

double poleDensity(double r, double z) {
  const double distance = std::sqrt(r * r + z * z);
  return z / (2.0 * std::numbers::pi * distance * distance * distance);
}

}  // namespace

LeafCrossing::LeafCrossing(const LeafSet& set, const Plant& relief, const LeafBakeOptions& options)
    : set_(set),
      relief_(relief),
      multipole_(set.optics, surfaceReflection(set, options), options.pairs) {
  const auto limit = static_cast<float>(multipole_.leastThickness());
  double most = double{limit};
  for (std::size_t i = 0; i < set.texelCount(); ++i) {
    thickness_mm_.push_back(std::max(set.thickness_mm[i], limit));
    if (set.opacity[i] >= 0.5f) most = std::max(most, double{thickness_mm_[i]});
    entering_[0].push_back(1.0f - glm::dot(set.front.albedo[i], options.wavelength));
    entering_[1].push_back(1.0f - glm::dot(set.back.albedo[i], options.wavelength));
  }
  const double least = multipole_.leastThickness() - multipole_.meanFreePath();
  for (double z = least; z < 2.0 * most; z *= 2.0) poles_.push_back(z);
  for (double z = least; z < kLevelRatio * most; z *= kLevelRatio) {
    const double d = z + multipole_.meanFreePath(), total = multipole_.total(d);
    std::vector<double>& rings = rings_.emplace_back(1, 0.0);
    for (int i = 1; i <= kRings; ++i) {
      double low = std::sqrt(rings.back()), high = 40.0 / multipole_.decay();
      for (int step = 0; step < 48; ++step) {
        const double middle = 0.5 * (low + high);
        const bool nearer = multipole_.beyond(middle, d) > (1.0 - kInRings * i / kRings) * total;
        (nearer ? low : high) = middle;
      }
      rings.push_back(high * high);
    }
  }
}

const std::vector<double>& LeafCrossing::ringsOf(float thickness_mm) const {
  const double z = double{thickness_mm} - multipole_.meanFreePath();
  const double level = std::log(std::max(z / poles_[0], 1.0)) / std::log(kLevelRatio);
  return rings_[std::min(static_cast<std::size_t>(std::lround(level)), rings_.size() - 1)];
}

LeafCrossing::Place LeafCrossing::placeOf(float x, float y) const {
  const auto floor_of = [](float value, int size) {
    return std::clamp(static_cast<int>(std::floor(value)), 0, size - 2);
  };
  const int column = floor_of(x, set_.width), row = floor_of(y, set_.height);
  return {static_cast<std::size_t>(row) * static_cast<std::size_t>(set_.width) +
              static_cast<std::size_t>(column),
          std::clamp(x - static_cast<float>(column), 0.0f, 1.0f),
          std::clamp(y - static_cast<float>(row), 0.0f, 1.0f)};
}

template <class Value>
Value LeafCrossing::at(const std::vector<Value>& map, const Place& place) const {
  const std::size_t below = place.first + static_cast<std::size_t>(set_.width);
  return (1.0f - place.t) * ((1.0f - place.s) * map[place.first] + place.s * map[place.first + 1]) +
         place.t * ((1.0f - place.s) * map[below] + place.s * map[below + 1]);
}

/// Per mm^2.
double LeafCrossing::density(double r, const std::vector<double>& rings) const {
  double of_poles = 0.0, of_rings = 0.0;
  for (const double z : poles_) of_poles += poleDensity(r, z);
  const auto outer = std::upper_bound(rings.begin(), rings.end(), r * r);
  if (outer != rings.end())
    of_rings = 1.0 / (kRings * std::numbers::pi * (*outer - *std::prev(outer)));
  return kByRings * of_rings + (1.0 - kByRings) * of_poles / static_cast<double>(poles_.size());
}

std::optional<LeafCrossing::Entry> LeafCrossing::sample(const RayHit& exit, Random& random) const {
  const Mesh& from = relief_.meshes[exit.mesh];
  const std::uint32_t* corner = &from.indices[std::size_t{3} * exit.triangle];
  const glm::vec2 uv = (1.0f - exit.barycentric.x - exit.barycentric.y) * from.uvs[corner[0]] +
                       exit.barycentric.x * from.uvs[corner[1]] +
                       exit.barycentric.y * from.uvs[corner[2]];
  const float x = uv.x * static_cast<float>(set_.width) - 0.5f;
  const float y = uv.y * static_cast<float>(set_.height) - 0.5f;
  const Place leaving = placeOf(x, y);
  const std::vector<double>& rings = ringsOf(at(thickness_mm_, leaving));
  double r;
  if (double{random.uniform()} < kByRings) {
    const double ring = double{random.uniform()} * kRings;
    const auto inner = std::min(static_cast<std::size_t>(ring), std::size_t{kRings - 1});
    r = std::sqrt(glm::mix(rings[inner], rings[inner + 1], ring - static_cast<double>(inner)));
  } else {
    const double pole = double{random.uniform()} * static_cast<double>(poles_.size());
    const double z = poles_[std::min(static_cast<std::size_t>(pole), poles_.size() - 1)];
    const double farther = 1.0 - double{random.uniform()};  // share of it that lands farther out
    r = z * std::sqrt(1.0 / (farther * farther) - 1.0);
  }
  const float turn = random.uniform(0.0f, 2.0f * std::numbers::pi_v<float>);
  const auto texels = static_cast<float>(r) / set_.mm_per_texel;
  const float to_x = x + texels * std::cos(turn), to_y = y + texels * std::sin(turn);
  // Written so that what is not finite is refused.
  if (!(to_x >= 0.0f && to_x <= static_cast<float>(set_.width - 1) && to_y >= 0.0f &&
        to_y <= static_cast<float>(set_.height - 1)))
    return std::nullopt;
  const Place entering = placeOf(to_x, to_y);
  if (at(set_.opacity, entering) < 0.5f) return std::nullopt;

  const bool front = exit.mesh == 0;  // is looked at, and the back is lit
  const double transmitted =
      multipole_.transmittance(r, double{at(thickness_mm_, entering)}) / density(r, rings);
  Entry entry;
  entry.weight = at((front ? set_.front : set_.back).translucency, leaving) *
                 (at(entering_[front ? 1 : 0], entering) * static_cast<float>(transmitted));
  entry.hit.item = 0;
  entry.hit.mesh = front ? 1 : 0;
  // The two triangles of a cell, see leafReliefPlant().
  const auto row =
      static_cast<std::uint32_t>(entering.first / static_cast<std::size_t>(set_.width));
  const auto cell = static_cast<std::uint32_t>(entering.first) - row;
  const bool second = entering.s + entering.t > 1.0f;
  entry.hit.triangle = 2 * cell + (second ? 1 : 0);
  glm::vec2& weights = entry.hit.barycentric;
  weights = second ? glm::vec2(1.0f - entering.s, entering.s + entering.t - 1.0f)
                   : glm::vec2(entering.t, entering.s);
  if (front) std::swap(weights.x, weights.y);  // of the back, which is wound the other way
  const Mesh& to = relief_.meshes[entry.hit.mesh];
  entry.outside = to.normals[to.indices[std::size_t{3} * entry.hit.triangle]];
  return entry;
}

ReferencePicture renderLeafReference(const LeafSet& set, const LeafPlantOptions& shape,
                                     const LeafBakeOptions& bake, const Daylight& lights,
                                     const ReferenceOptions& options) {
  const Plant relief = leafReliefPlant(set, shape);
  const LeafCrossing crossing(set, relief, bake);
  Scene scene;
  scene.ground = false;
  scene.items.push_back({&relief});
  ReferenceOptions matt = options;
  matt.gloss = matt.leaf_maps = false;
  return tracePicture(scene, lights, matt, &crossing);
}

}  // namespace verdure
