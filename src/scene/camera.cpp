#include "scene/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <map>

#include "base/parallel.h"
#include "scene/scene.h"
#include "verdure/error.h"

namespace verdure {
namespace {

/// Even directions on the sphere: a Fibonacci lattice.
constexpr int kDirections = 256;
glm::vec3 evenDirection(std::size_t d) {
  const float y = 1.0f - (2.0f * static_cast<float>(d) + 1.0f) / kDirections;
  const float turn = glm::two_pi<float>() * 0.61803399f * static_cast<float>(d);
  const float ring = std::sqrt(1.0f - y * y);
  return {ring * std::cos(turn), y, ring * std::sin(turn)};
}

/// The vertices of a plant that lie farthest in each of many directions: what a camera must show so
/// that it shows all (to about 1 % of the size).
std::vector<glm::vec3> outermostVertices(const Plant& plant) {
  std::vector<glm::vec3> outermost(kDirections);
  std::vector<float> reach(kDirections, std::numeric_limits<float>::lowest());
  parallelFor(kDirections, 8, [&](std::size_t d) {
    const glm::vec3 direction = evenDirection(d);
    for (const Mesh& mesh : plant.meshes)
      for (const glm::vec3& p : mesh.positions)
        if (const float along = glm::dot(p, direction); along > reach[d]) {
          reach[d] = along;
          outermost[d] = p;
        }
  });
  if (vertexCount(plant) == 0) outermost.clear();
  return outermost;
}

/// The same of a forest: of those of its plants that, as spheres, reach farthest.
void addOutermost(const Forest& forest, std::vector<glm::vec3>& points) {
  struct Ball {
    glm::vec3 center{0.0f};
    float radius = 0.0f;
    std::vector<glm::vec3> outermost;
  };
  std::vector<Ball> balls;
  for (const ForestKind& kind : forest.kinds) {
    if (kind.plant == nullptr)
      throw Error("forest", "a kind has no plant", "set ForestKind::plant");
    const Bounds box = bounds(*kind.plant);
    balls.push_back({box.center(), 0.5f * glm::length(box.size()), outermostVertices(*kind.plant)});
  }
  for (const Placement& place : forest.places)
    if (place.plant >= balls.size())
      throw Error("forest", "a place has no kind", "set Forest::kinds");
  std::vector<std::size_t> farthest(kDirections);
  parallelFor(kDirections, 8, [&](std::size_t d) {
    const glm::vec3 direction = evenDirection(d);
    float reach = std::numeric_limits<float>::lowest();
    for (std::size_t i = 0; i < forest.places.size(); ++i) {
      const Placement& place = forest.places[i];
      const Ball& ball = balls[place.plant];
      // Turned about the vertical, a crown stays above its foot: that is near enough.
      const glm::vec3 center = place.position + glm::vec3(0, place.scale * ball.center.y, 0);
      const float along = glm::dot(center, direction) + place.scale * ball.radius;
      if (along > reach) {
        reach = along;
        farthest[d] = i;
      }
    }
  });
  std::sort(farthest.begin(), farthest.end());
  farthest.erase(std::unique(farthest.begin(), farthest.end()), farthest.end());
  for (const std::size_t i : farthest) {
    const glm::mat4 world = matrixOf(forest.places[i]);
    for (const glm::vec3& p : balls[forest.places[i].plant].outermost)
      points.emplace_back(world * glm::vec4(p, 1.0f));
  }
}

std::vector<glm::vec3> outermostPoints(const Scene& scene) {
  std::map<const Plant*, std::vector<glm::vec3>> of_plant;
  std::vector<glm::vec3> points;
  for (const SceneItem& item : scene.items) {
    if (item.plant == nullptr) throw Error("scene", "an item has no plant", "set SceneItem::plant");
    const auto [entry, is_new] = of_plant.try_emplace(item.plant);
    if (is_new) entry->second = outermostVertices(*item.plant);
    for (const glm::mat4& instance : item.world_from_plant) {
      const glm::mat4 world = worldFromPlant(scene, item, instance);
      for (const glm::vec3& p : entry->second) points.emplace_back(world * glm::vec4(p, 1.0f));
    }
  }
  if (scene.forest != nullptr && !scene.forest->places.empty()) addOutermost(*scene.forest, points);
  return points;
}

/// Extent of points in a camera's image, as tangents of angles.
struct ImageBox {
  glm::vec2 min{std::numeric_limits<float>::max()};
  glm::vec2 max{std::numeric_limits<float>::lowest()};
  bool behind = false;  ///< a point is not in front of the eye
};

ImageBox imageBox(const Camera& camera, const std::vector<glm::vec3>& points) {
  const glm::mat3 axes = cameraAxes(camera);
  ImageBox box;
  for (const glm::vec3& p : points) {
    const glm::vec3 q = (p - camera.eye) * axes;
    if (q.z >= -1e-6f * glm::length(p - camera.eye)) {
      box.behind = true;
      return box;
    }
    const glm::vec2 at = glm::vec2(q) / -q.z;
    box.min = glm::min(box.min, at);
    box.max = glm::max(box.max, at);
  }
  return box;
}

}  // namespace

glm::vec3 directionOf(float azimuth, float elevation) {
  return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
          std::cos(azimuth) * std::cos(elevation)};
}

glm::mat3 cameraAxes(const Camera& camera) {
  const glm::vec3 back = glm::normalize(camera.eye - camera.target);
  const glm::vec3 up = std::abs(back.y) > 0.9999f ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
  const glm::vec3 right = glm::normalize(glm::cross(up, back));
  return {right, glm::cross(back, right), back};
}

namespace {

void checkCamera(const Camera& camera) {
  const float distance = glm::length(camera.eye - camera.target);
  if (!(distance > 0.0f) || !std::isfinite(distance))
    throw Error("camera", "eye and target are the same point or not finite", "move one of them");
  if (!(camera.vertical_fov > 0.0f && camera.vertical_fov < glm::pi<float>()))
    throw Error("camera", "the field of view is not between 0 and pi radians");
}

}  // namespace

CameraRays cameraRays(const Camera& camera, float aspect) {
  checkCamera(camera);
  const glm::mat3 axes = cameraAxes(camera);
  const float tan_half = std::tan(0.5f * camera.vertical_fov);
  return {camera.eye, axes[0] * tan_half * aspect, -axes[1] * tan_half, -axes[2]};
}

glm::mat4 clipFromWorld(const Camera& camera, float aspect) {
  checkCamera(camera);
  const glm::mat3 axes = cameraAxes(camera);
  const float tan_half = std::tan(0.5f * camera.vertical_fov);
  glm::mat4 view(glm::transpose(axes));
  view[3] = glm::vec4(-(camera.eye * axes), 1.0f);
  glm::mat4 projection(0.0f);
  projection[0][0] = 1.0f / (tan_half * aspect);
  projection[1][1] = -1.0f / tan_half;  // Vulkan's y points down
  projection[2][3] = -1.0f;
  projection[3][2] = 0.002f * glm::length(camera.eye - camera.target);  // the near plane
  return projection * view;
}

Camera automaticCamera(const Scene& scene, float azimuth, float elevation, float aspect,
                       float vertical_fov) {
  constexpr float kMargin = 0.9f;  // share of the image that the scene fills
  Camera camera;
  camera.vertical_fov = vertical_fov;
  const std::vector<glm::vec3> points = outermostPoints(scene);
  if (points.empty()) return camera;

  glm::vec3 low = points[0], high = points[0];
  for (const glm::vec3& p : points) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const glm::vec3 center = 0.5f * (low + high);
  const float radius = std::max(0.5f * glm::length(high - low), 1e-4f);
  // At elevation 0 the eye is where a standing person's is, for plants of such size; lower for
  // small plants, higher for giants.
  const float height = high.y - low.y;
  const float eye_height = std::min(std::max(1.7f, 0.125f * height), height / 3.0f);
  const glm::vec3 direction = directionOf(azimuth, elevation);
  const auto eyeAt = [&](float distance) {
    const glm::vec3 flat(center.x, low.y + eye_height, center.z);
    return flat + direction * distance;
  };

  const glm::vec2 half = glm::vec2(aspect, 1.0f) * std::tan(0.5f * vertical_fov) * kMargin;
  // The target that centres the scene depends on the distance and the other way round: some rounds
  // of both settle.
  camera.target = center;
  for (int round = 0; round < 4; ++round) {
    float near = 0.0f, far = radius;
    const auto fits = [&](float distance) {
      Camera trial = camera;
      trial.eye = eyeAt(distance);
      if (glm::length(trial.eye - trial.target) < 1e-3f * radius) return false;
      const ImageBox box = imageBox(trial, points);
      const glm::vec2 size = 0.5f * (box.max - box.min);
      return !box.behind && size.x <= half.x && size.y <= half.y;
    };
    while (!fits(far) && far < 1e4f * radius) far *= 1.5f;
    for (int step = 0; step < 30; ++step) {
      const float middle = 0.5f * (near + far);
      (fits(middle) ? far : near) = middle;
    }
    camera.eye = eyeAt(far);
    const ImageBox box = imageBox(camera, points);
    const glm::mat3 axes = cameraAxes(camera);
    const glm::vec2 middle = 0.5f * (box.min + box.max);
    camera.target +=
        (axes[0] * middle.x + axes[1] * middle.y) * glm::dot(camera.eye - camera.target, axes[2]);
  }
  return camera;
}

}  // namespace verdure
