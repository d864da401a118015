#include "render/cascades.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/check.h"
#include "scene/camera.h"

namespace verdure {
namespace {

constexpr float kLogarithmic = 0.9f;    ///< the split scheme's lambda
constexpr float kDepthRange = 1000.0f;  ///< most far / near
constexpr float kPixelsOfTexel = 2.0f;  ///< automatic: no coarser
constexpr float kWorthwhile = 0.8f;     ///< largest share of the whole scene's texel
constexpr int kLeastSize = 64;

/// The light's axes: x and y of the map, and towards the sun.
struct SunAxes {
  explicit SunAxes(const glm::vec3& to_sun) : towards(to_sun) {
    const glm::vec3 aside = std::abs(to_sun.y) > 0.999f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    right = glm::normalize(glm::cross(aside, to_sun));
    up = glm::cross(to_sun, right);
  }
  glm::vec3 right, up, towards;
};

void setRow(glm::mat4& m, int row, const glm::vec3& axis, float offset) {
  for (int c = 0; c < 3; ++c) m[c][row] = axis[c];
  m[3][row] = offset;
}

float distanceTo(const Bounds& bounds, const glm::vec3& p) {
  return glm::length(p - glm::clamp(p, bounds.min, bounds.max));
}

float farthestFrom(const Bounds& bounds, const glm::vec3& p) {
  return glm::length(glm::max(glm::abs(bounds.min - p), glm::abs(bounds.max - p)));
}

/// Of any number above some smallest one.
float powerOfTwoBelow(float x) {
  return std::exp2(std::floor(std::log2(std::max(x, 1e-12f))));
}

/// Heights towards the sun of all of `bounds` whose (x, y) of the map lie in [0, 1]^2; first above
/// second if there is nothing.
std::pair<float, float> heightsInMap(const glm::mat4& shadow_from_world, const Bounds& bounds,
                                     const glm::vec3& to_sun) {
  std::pair<float, float> heights(std::numeric_limits<float>::max(),
                                  std::numeric_limits<float>::lowest());
  std::vector<glm::vec3> polygon, kept;
  for (int face = 0; face < 6; ++face) {  // of the bounds, cut by the map's four sides
    const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    polygon.clear();
    for (int corner = 0; corner < 4; ++corner) {
      glm::vec3 p(0.0f);
      p[axis] = face % 2 == 0 ? bounds.min[axis] : bounds.max[axis];
      p[u] = corner == 1 || corner == 2 ? bounds.max[u] : bounds.min[u];
      p[v] = corner >= 2 ? bounds.max[v] : bounds.min[v];
      polygon.push_back(p);
    }
    for (int side = 0; side < 4; ++side) {
      const auto inside = [&](const glm::vec3& p) {
        const float at = (shadow_from_world * glm::vec4(p, 1.0f))[side / 2];
        return side % 2 == 0 ? at : 1.0f - at;
      };
      kept.clear();
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const float in_a = inside(a), in_b = inside(b);
        if (in_a >= 0.0f) kept.push_back(a);
        if ((in_a >= 0.0f) != (in_b >= 0.0f)) kept.push_back(glm::mix(a, b, in_a / (in_a - in_b)));
      }
      std::swap(polygon, kept);
    }
    for (const glm::vec3& p : polygon) {
      heights.first = std::min(heights.first, glm::dot(p, to_sun));
      heights.second = std::max(heights.second, glm::dot(p, to_sun));
    }
  }
  return heights;
}

/// A map of `side_m` metres around a point, with the depths of what may stand in it.
Cascade placeCascade(const ShadowFit& whole, const SunAxes& axes, const glm::vec3& center,
                     float side_m, const CascadeRequest& request) {
  Cascade cascade;
  const auto size = static_cast<float>(request.size);
  cascade.texel_m = side_m / size;
  cascade.shadow_from_world = whole.shadow_from_world;
  int row = 0;
  for (const glm::vec3& axis : {axes.right, axes.up}) {
    // In double: far from the origin, and with small texels, a float does not hold their number.
    double at = glm::dot(glm::dvec3(axis), glm::dvec3(center)) / double{cascade.texel_m};
    if (request.snap) at = std::round(at);
    setRow(cascade.shadow_from_world, row, axis / side_m,
           static_cast<float>(0.5 - at / request.size));
    const double wraps = std::floor(at / shared::kCascadeWrap);
    cascade.origin[row++] = static_cast<int>(std::floor(at) - wraps * shared::kCascadeWrap);
  }
  const auto [low, high] = heightsInMap(cascade.shadow_from_world, request.bounds, axes.towards);
  if (low < high) {  // by steps, so that depths seldom change when the camera moves
    const float step = 0.25f * side_m;
    const float top = (std::floor(high / step) + 1.0f) * step;
    const float depth = top - (std::ceil(low / step) - 1.0f) * step;
    setRow(cascade.shadow_from_world, 2, -axes.towards / depth, top / depth);
  }
  return cascade;
}

/// `count` maps at most, the last one of the whole scene.
std::vector<Cascade> fitCount(const CascadeRequest& request, const ShadowFit& whole, int count) {
  std::vector<Cascade> cascades;
  if (count > 1) {
    const SunAxes axes(request.to_sun);
    const float aspect = static_cast<float>(request.width) / static_cast<float>(request.height);
    const CameraRays rays = cameraRays(request.camera, aspect);
    // Not from the rays: every bit of it stays when the camera turns.
    const PyramidSphere sphere = pyramidSphere(std::tan(0.5f * request.camera.vertical_fov) *
                                               std::sqrt(1.0f + aspect * aspect));
    const float far = 2.0f * powerOfTwoBelow(farthestFrom(request.bounds, rays.eye));
    const float near =
        std::max(powerOfTwoBelow(distanceTo(request.bounds, rays.eye)), far / kDepthRange);
    for (const float reach : cascadeSplits(near, far, count)) {
      const float inner = 2.0f * sphere.radius * reach;
      const float side = inner / shared::cascadeInnerShare(static_cast<float>(request.size));
      if (!(side < kWorthwhile * whole.texel_m * static_cast<float>(request.size))) break;
      cascades.push_back(placeCascade(
          whole, axes, rays.eye + rays.forward * (sphere.center * reach), side, request));
      cascades.back().reach_m = reach;
    }
  }
  Cascade& last = cascades.emplace_back();
  static_cast<ShadowFit&>(last) = whole;
  last.reach_m = std::numeric_limits<float>::infinity();
  return cascades;
}

/// No texel is larger than kPixelsOfTexel pixels where it may be seen.
bool resolves(const std::vector<Cascade>& cascades, const CascadeRequest& request) {
  const float far = farthestFrom(request.bounds, request.camera.eye);
  float nearest = std::max(distanceTo(request.bounds, request.camera.eye), far / kDepthRange);
  const float pixel = 2.0f * std::tan(0.5f * request.camera.vertical_fov) /
                      static_cast<float>(request.height);  // at depth 1
  for (const Cascade& cascade : cascades) {
    if (cascade.texel_m > kPixelsOfTexel * pixel * nearest) return false;
    nearest = std::max(nearest, cascade.reach_m);
  }
  return true;
}

}  // namespace

ShadowFit fitShadow(const Bounds& bounds, const glm::vec3& to_sun, int size) {
  const SunAxes axes(to_sun);
  const glm::vec3 center = bounds.center(), half = 0.5f * bounds.size();
  const auto reach = [&half](const glm::vec3& axis) { return glm::dot(glm::abs(axis), half); };
  // A square, so that texels are square, with some texels around for the filter.
  const float smallest = 1e-4f + 1e-6f * glm::length(center);
  const float side = 2.0f * std::max({reach(axes.right), reach(axes.up), smallest}) *
                     static_cast<float>(size) / static_cast<float>(std::max(size - 8, 1));
  const float depth = 2.0f * std::max(reach(to_sun), smallest) * 1.01f;
  glm::mat4 m(1.0f);
  setRow(m, 0, axes.right / side, 0.5f - glm::dot(axes.right, center) / side);
  setRow(m, 1, axes.up / side, 0.5f - glm::dot(axes.up, center) / side);
  setRow(m, 2, -to_sun / depth, 0.5f + glm::dot(to_sun, center) / depth);
  return {m, side / static_cast<float>(size)};
}

PyramidSphere pyramidSphere(float tan_corner) {
  // Through the eye and the four corners; of a wide pyramid, around the corners alone.
  const float square = tan_corner * tan_corner;
  if (square >= 1.0f) return {1.0f, tan_corner};
  return {0.5f * (1.0f + square), 0.5f * (1.0f + square)};
}

std::vector<float> cascadeSplits(float near, float far, int count) {
  VERDURE_CHECK_LT(near, far);
  std::vector<float> splits;
  for (int i = 1; i < count; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(count);
    const float logarithmic = near * std::pow(far / near, share);
    const float uniform = near + (far - near) * share;
    splits.push_back(kLogarithmic * logarithmic + (1.0f - kLogarithmic) * uniform);
  }
  return splits;
}

std::vector<Cascade> fitCascades(const CascadeRequest& request) {
  const ShadowFit whole = fitShadow(request.bounds, request.to_sun, request.size);
  const int most = request.size < kLeastSize ? 1 : shared::kMostCascades;
  if (request.count > 0) return fitCount(request, whole, std::min(request.count, most));
  std::vector<Cascade> cascades;
  for (int count = 1; count <= most; ++count) {
    cascades = fitCount(request, whole, count);
    if (resolves(cascades, request)) break;
  }
  return cascades;
}

}  // namespace verdure
