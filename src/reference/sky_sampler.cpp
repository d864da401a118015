#include "reference/sky_sampler.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "base/parallel.h"

namespace verdure {
namespace {

/// x, y in [0, 1) of the sphere's equal-area cylinder: y = 0 at the nadir.
glm::vec3 directionAt(float x, float y) {
  const float up = 2.0f * y - 1.0f, ring = std::sqrt(std::max(1.0f - up * up, 0.0f));
  const float azimuth = glm::two_pi<float>() * x;
  return {ring * std::sin(azimuth), up, ring * std::cos(azimuth)};
}

/// First index whose cumulative share is above u, and where u lies in it, in [0, 1).
std::pair<int, float> pick(const float* ends, int count, float u) {
  const int i =
      std::min(static_cast<int>(std::upper_bound(ends, ends + count, u) - ends), count - 1);
  const float begin = i == 0 ? 0.0f : ends[i - 1], width = ends[i] - begin;
  return {i, width > 0.0f ? std::clamp((u - begin) / width, 0.0f, 0.99999994f) : 0.5f};
}

float share(const float* ends, int i) {
  return i == 0 ? ends[0] : ends[i] - ends[i - 1];
}

}  // namespace

SkySampler::SkySampler(const Sky& sky) {
  const int rows = 2 * std::clamp(sky.rows(), 32, 1024), columns = 2 * rows;
  const auto width = static_cast<std::size_t>(columns), height = static_cast<std::size_t>(rows);
  std::vector<double> luminance(width * height);
  parallelFor(height, 4, [&](std::size_t r) {
    for (std::size_t c = 0; c < width; ++c)
      luminance[r * width + c] = double{glm::dot(
          sky.luminance(directionAt((static_cast<float>(c) + 0.5f) / static_cast<float>(columns),
                                    (static_cast<float>(r) + 0.5f) / static_cast<float>(rows))),
          glm::vec3(0.2126f, 0.7152f, 0.0722f))};
  });
  double total = 0.0;
  for (const double l : luminance) total += l;
  if (!(total > 0.0)) return;
  rows_ = rows;
  columns_ = columns;
  // What lies between the points may be brighter: every cell gets at least a hundredth of the mean.
  const double least = 0.01 * total / static_cast<double>(luminance.size());
  cell_ends_.resize(luminance.size());
  std::vector<double> row_sums(height);
  for (std::size_t r = 0; r < height; ++r) {
    double sum = 0.0;
    for (std::size_t c = 0; c < width; ++c) sum += std::max(luminance[r * width + c], least);
    row_sums[r] = sum;
    double so_far = 0.0;
    for (std::size_t c = 0; c < width; ++c) {
      so_far += std::max(luminance[r * width + c], least);
      cell_ends_[r * width + c] = static_cast<float>(so_far / sum);
    }
  }
  double all = 0.0, so_far = 0.0;
  for (const double sum : row_sums) all += sum;
  for (const double sum : row_sums) {
    so_far += sum;
    row_ends_.push_back(static_cast<float>(so_far / all));
  }
}

glm::vec3 SkySampler::sample(float u, float v) const {
  const auto [row, y] = pick(row_ends_.data(), rows_, v);
  const auto [column, x] =
      pick(cell_ends_.data() + static_cast<std::ptrdiff_t>(row) * columns_, columns_, u);
  return directionAt((static_cast<float>(column) + x) / static_cast<float>(columns_),
                     (static_cast<float>(row) + y) / static_cast<float>(rows_));
}

float SkySampler::density(const glm::vec3& direction) const {
  const int row = std::clamp(
      static_cast<int>((0.5f * direction.y + 0.5f) * static_cast<float>(rows_)), 0, rows_ - 1);
  const float turns = std::atan2(direction.x, direction.z) / glm::two_pi<float>();
  const int column = std::clamp(
      static_cast<int>((turns < 0.0f ? turns + 1.0f : turns) * static_cast<float>(columns_)), 0,
      columns_ - 1);
  const float cells = static_cast<float>(rows_) * static_cast<float>(columns_);
  return share(row_ends_.data(), row) *
         share(cell_ends_.data() + static_cast<std::ptrdiff_t>(row) * columns_, column) * cells /
         (4.0f * glm::pi<float>());
}

}  // namespace verdure
