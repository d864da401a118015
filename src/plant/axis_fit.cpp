#include "plant/axis_fit.h"

#include <algorithm>
#include <limits>

namespace verdure {
namespace {

/// Of the radius.
constexpr float kSimplified = 0.04f;

struct Ring {
  float along = 0.0f, radius = 0.0f;
  std::size_t count = 0;
};

/// Samples that lie together along the axis, at most half a radius long.
std::vector<Ring> ringsOf(const std::vector<std::pair<float, float>>& samples) {
  std::vector<Ring> rings;
  std::vector<float> distances;
  for (std::size_t begin = 0, end = 0; begin < samples.size(); begin = end) {
    distances.clear();
    float along = 0.0f, farthest = 0.0f;
    while (end < samples.size()) {
      const float reach = std::max(farthest, samples[end].second);
      if (end > begin && samples[end].first - samples[begin].first > 0.5f * reach) break;
      farthest = reach;
      along += samples[end].first;
      distances.push_back(samples[end].second);
      ++end;
    }
    Ring ring;
    ring.count = distances.size();
    ring.along = along / static_cast<float>(ring.count);
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(ring.count / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    ring.radius = *middle;
    rings.push_back(ring);
  }
  return rings;
}

std::size_t segmentAt(const std::vector<BranchPoint>& axis, float& along) {
  std::size_t i = 0;
  for (; i + 2 < axis.size(); ++i) {
    const float length = glm::length(axis[i + 1].position - axis[i].position);
    if (along <= length) break;
    along -= length;
  }
  return i;
}

}  // namespace

float axisLength(const std::vector<BranchPoint>& axis) {
  float length = 0.0f;
  for (std::size_t i = 1; i < axis.size(); ++i)
    length += glm::length(axis[i].position - axis[i - 1].position);
  return length;
}

std::pair<float, float> placeOnAxis(const std::vector<BranchPoint>& axis, const glm::vec3& point) {
  float best = std::numeric_limits<float>::max(), along = 0.0f, start = 0.0f;
  for (std::size_t i = 0; i + 1 < axis.size(); ++i) {
    const glm::vec3 a = axis[i].position, ab = axis[i + 1].position - a;
    const float square = glm::dot(ab, ab), length = std::sqrt(square);
    const float t = square > 0.0f ? glm::clamp(glm::dot(point - a, ab) / square, 0.0f, 1.0f) : 0.0f;
    const glm::vec3 off = point - a - t * ab;
    if (glm::dot(off, off) < best) {
      best = glm::dot(off, off);
      along = start + t * length;
    }
    start += length;
  }
  return {along, std::sqrt(best)};
}

glm::vec3 pointOnAxis(const std::vector<BranchPoint>& axis, float along) {
  const std::size_t i = segmentAt(axis, along);
  const float length = glm::length(axis[i + 1].position - axis[i].position);
  return glm::mix(axis[i].position, axis[i + 1].position,
                  length > 0.0f ? glm::clamp(along / length, 0.0f, 1.0f) : 0.0f);
}

float radiusOnAxis(const std::vector<BranchPoint>& axis, float along) {
  const std::size_t i = segmentAt(axis, along);
  const float length = glm::length(axis[i + 1].position - axis[i].position);
  return glm::mix(axis[i].radius, axis[i + 1].radius,
                  length > 0.0f ? glm::clamp(along / length, 0.0f, 1.0f) : 0.0f);
}

void fitRadii(std::vector<std::pair<float, float>> samples, std::vector<BranchPoint>& axis) {
  if (samples.empty()) return;
  std::sort(samples.begin(), samples.end());
  std::vector<Ring> rings = ringsOf(samples);
  // The point that closes an end says nothing of the radius beside two rings.
  const float length = axisLength(axis);
  if (rings.size() > 2 && rings.back().count == 1 && rings.back().along > 0.98f * length)
    rings.pop_back();
  if (rings.size() > 2 && rings.front().count == 1 && rings.front().along < 0.02f * length)
    rings.erase(rings.begin());
  float along = 0.0f;
  std::size_t next = 0;
  for (std::size_t i = 0; i < axis.size(); ++i) {
    if (i > 0) along += glm::length(axis[i].position - axis[i - 1].position);
    while (next < rings.size() && rings[next].along < along) ++next;
    if (rings.size() == 1) {
      axis[i].radius = rings[0].radius;
    } else if (next == 0) {
      axis[i].radius = rings[0].radius;
    } else {
      // Beyond the last ring the taper goes on.
      const Ring& b = rings[std::min(next, rings.size() - 1)];
      const Ring& a = rings[std::min(next, rings.size() - 1) - 1];
      const float gap = std::max(b.along - a.along, 1e-12f);
      const float t = std::min((along - a.along) / gap, 3.0f);
      axis[i].radius =
          std::clamp(a.radius + t * (b.radius - a.radius), 0.0f, std::max(a.radius, b.radius));
    }
  }
}

void simplifyAxis(std::vector<BranchPoint>& axis) {
  if (axis.size() < 3) return;
  std::vector<bool> kept(axis.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> spans{{0, axis.size() - 1}};
  while (!spans.empty()) {
    const auto [first, last] = spans.back();
    spans.pop_back();
    const glm::vec3 a = axis[first].position, ab = axis[last].position - a;
    const float square = glm::dot(ab, ab);
    float most = kSimplified;
    std::size_t farthest = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const float t = square > 0.0f
                          ? glm::clamp(glm::dot(axis[i].position - a, ab) / square, 0.0f, 1.0f)
                          : 0.0f;
      const float off =
          glm::length(axis[i].position - a - t * ab) +
          std::abs(axis[i].radius - glm::mix(axis[first].radius, axis[last].radius, t));
      const float share = off / std::max(axis[i].radius, 1e-12f);
      if (share > most) {
        most = share;
        farthest = i;
      }
    }
    if (farthest == first) continue;
    kept[farthest] = true;
    spans.emplace_back(first, farthest);
    spans.emplace_back(farthest, last);
  }
  std::size_t n = 0;
  for (std::size_t i = 0; i < axis.size(); ++i)
    if (kept[i]) axis[n++] = axis[i];
  axis.resize(n);
}

}  // namespace verdure
