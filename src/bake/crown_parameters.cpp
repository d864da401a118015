#include "bake/crown_parameters.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "base/random.h"

namespace verdure {
namespace {

// A leaf that spans more than this share of the foliage is no leaf.
constexpr float kLargestLeaf = 0.15f;

// rho as a share of the cube root of the crown's volume; Fig. 3 of the paper spans about 0.1 to
// 0.25 of its tree's size. Small enough to keep the clumps of a crown apart.
constexpr float kRhoShare = 0.16f;
// A generator inside the crown has at least this many others in reach, on average: fewer make the
// surface follow single leaves.
constexpr float kLeastNeighbours = 30.0f;
// The crown's volume is found by counting occupied boxes, which stray leaves do not spoil as they
// do the bounding box: at most this many along the longest side, and fewer where the boxes would
// hold less than a few leaves each and most of a sparse crown would seem empty.
constexpr float kVolumeCells = 16.0f;
constexpr float kLeavesPerCell = 4.0f;

constexpr float kTauShare = 0.35f;
constexpr float kCoreQuantile = 0.9f;

float quantile(std::vector<float>& values, float q) {
  const auto at = static_cast<std::ptrdiff_t>(q * static_cast<float>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

}  // namespace

std::vector<glm::vec3> foliageCenters(const Plant& plant, std::size_t& skipped) {
  skipped = 0;
  const glm::vec3 size = bounds(plant, PartKind::kFoliage).size();
  const float limit = kLargestLeaf * std::max(size.x, std::max(size.y, size.z));
  std::vector<glm::vec3> centers;
  centers.reserve(plant.leaves.size());
  for (const Leaf& leaf : plant.leaves) {
    if (!(leaf.area > 0.0f)) {
      ++skipped;
      continue;
    }
    const Mesh& mesh = plant.meshes[leaf.mesh];
    const auto corner = [&](std::size_t t, std::size_t k) {
      return mesh.positions[mesh.indices[3 * plant.leaf_triangles[leaf.first_triangle + t] + k]];
    };
    glm::vec3 low(1e30f), high(-1e30f);
    for (std::size_t t = 0; t < leaf.triangle_count; ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        low = glm::min(low, corner(t, k));
        high = glm::max(high, corner(t, k));
      }
    const glm::vec3 extent = high - low;
    if (std::max(extent.x, std::max(extent.y, extent.z)) <= limit || plant.leaves.size() < 3) {
      centers.push_back(leaf.centroid);
      continue;
    }
    for (std::size_t t = 0; t < leaf.triangle_count; ++t) {
      const glm::vec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
      if (glm::length(glm::cross(b - a, c - a)) > 0.0f) centers.push_back((a + b + c) / 3.0f);
    }
  }
  return centers;
}

std::vector<glm::vec3> randomFraction(const std::vector<glm::vec3>& centers, float fraction,
                                      std::uint32_t seed) {
  const auto count = centers.size();
  const auto wanted = std::clamp<std::size_t>(
      static_cast<std::size_t>(std::lround(double{fraction} * static_cast<double>(count))), 1,
      count);
  if (wanted == count) return centers;
  // Selection sampling (Knuth, The Art of Computer Programming, 3.4.2, algorithm S).
  Random random(seed);
  std::vector<glm::vec3> chosen;
  chosen.reserve(wanted);
  for (std::size_t i = 0; i < count && chosen.size() < wanted; ++i) {
    const auto left = static_cast<std::uint32_t>(count - i);
    if (random.below(left) < wanted - chosen.size()) chosen.push_back(centers[i]);
  }
  return chosen;
}

float defaultRho(const std::vector<glm::vec3>& centers) {
  glm::vec3 low = centers[0], high = low;
  for (const glm::vec3& p : centers) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const glm::vec3 size = high - low;
  const float cells =
      std::clamp(std::floor(std::cbrt(static_cast<float>(centers.size()) / kLeavesPerCell)), 2.0f,
                 kVolumeCells);
  const float cell = std::max(std::max(size.x, std::max(size.y, size.z)) / cells, 1e-6f);
  std::unordered_set<std::uint32_t> occupied;
  for (const glm::vec3& p : centers) {
    const glm::uvec3 c((p - low) / cell);
    occupied.insert(c.x | c.y << 8 | c.z << 16);
  }
  const float volume = static_cast<float>(occupied.size()) * cell * cell * cell;
  const float by_size = kRhoShare * std::cbrt(volume);
  const float by_density =
      std::cbrt(kLeastNeighbours * volume / (4.18879f * static_cast<float>(centers.size())));
  return std::max(by_size, by_density);
}

CrownThresholds defaultThresholds(std::vector<float> sums, const DensityOptions& options) {
  CrownThresholds result;
  result.tau = options.tau.value_or(kTauShare * quantile(sums, 0.5f));
  const float core = quantile(sums, kCoreQuantile);
  // With a tau near the maximum nothing lies deep: then the darkest value is out of reach.
  result.d_min = options.d_min.value_or(std::max(core - result.tau, 0.25f * core));
  return result;
}

}  // namespace verdure
