#ifndef VERDURE_RAYS_RAY_SCENE_H_
#define VERDURE_RAYS_RAY_SCENE_H_

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "verdure/scene.h"

/// Rays against a scene, by Embree. The alpha cut is part of the geometry: a ray passes where the
/// base colour's alpha, sampled bilinearly from the full texture, is below textureCutoff().
namespace verdure {

/// Points origin + t * direction for t in [t_min, t_max]. The direction need not be unit; distances
/// are in multiples of it. Values are finite (t_max may be infinite).
struct Ray {
  glm::vec3 origin{0.0f};
  float t_min = 0.0f;
  glm::vec3 direction{0.0f, 0.0f, 1.0f};
  float t_max = std::numeric_limits<float>::infinity();
};

/// Where a ray meets the scene.
struct RayHit {
  float distance = 0.0f;        ///< t of the ray
  glm::vec2 barycentric{0.0f};  ///< weights of the triangle's second and third corner
  std::uint32_t item = kNone;   ///< index into Scene::items; kNone = the ground
  std::uint32_t instance = 0;   ///< index into the item's world_from_plant
  std::uint32_t mesh = 0;       ///< index into the plant's meshes
  std::uint32_t triangle = 0;   ///< of the mesh: corners are indices[3 * triangle ...]
  bool front = true;            ///< whether the ray comes from the side of SurfacePoint::normal
  bool ground() const { return item == kNone; }
};

/// The surface at a hit, in world coordinates.
struct SurfacePoint {
  glm::vec3 position{0.0f};  ///< on the triangle, not on the ray: free of the ray's rounding
  /// Unit, of the triangle, on the side from which its corners run counter-clockwise in the plant's
  /// own space: the outside of wood, the front of a leaf, mirrored instances included.
  glm::vec3 normal{0.0f, 1.0f, 0.0f};
  glm::vec3 vertex_normal{0.0f, 1.0f, 0.0f};  ///< unit, interpolated from the mesh's normals
  glm::vec2 uv{0.0f};
  /// Diffuse, of the side that RayHit::front names, linear RGB in [0, 1]: base colour times
  /// texture, bilinear; of leaves with maps of both sides the side's own.
  glm::vec3 reflectance{0.0f};
  /// Share of even light on the other side that leaves here (LeafSurface); 0 but for foliage.
  glm::vec3 transmittance{0.0f};
  bool foliage = false;
};

struct Hit : RayHit, SurfacePoint {};

struct RaySceneOptions {
  std::size_t max_memory_bytes = std::size_t{8} << 30;  ///< a scene that needs more is refused
  bool leaf_maps = true;  ///< leaves by the maps of both their sides, where they have them
};

/// Sets this thread to flush denormals to zero while it lives, as Embree wants: hold one around
/// every loop over rays (each thread its own). Without it rays are right, but slower.
class RayThread {
 public:
  RayThread();
  ~RayThread();
  RayThread(const RayThread&) = delete;
  RayThread& operator=(const RayThread&) = delete;

 private:
  unsigned int saved_ = 0;
};

/// The scene's plants must outlive it, unchanged: vertex normals, texture coordinates and textures
/// are read from them. All functions may be called from any number of threads at once, and the
/// results do not depend on it. Plants with several placements are stored once.
class RayScene {
 public:
  /// All items at all their places. Scene::ground adds an infinite plane that is seen from above
  /// only (its reflectance is shared::groundMeanColor()). Throws Error: a null plant, arrays of
  /// different lengths, indices out of range, a missing texture, more memory than allowed (found
  /// from the scene's size before anything is built).
  explicit RayScene(const Scene& scene, const RaySceneOptions& options = {});
  /// One plant at its own origin, without ground.
  explicit RayScene(const Plant& plant, const RaySceneOptions& options = {});
  explicit RayScene(const Plant&&, const RaySceneOptions& = {}) = delete;
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;
  ~RayScene();

  /// The nearest point of the ray that is not cut, if any.
  std::optional<RayHit> trace(const Ray& ray) const;
  /// trace() and surfaceAt() in one.
  std::optional<Hit> closestHit(const Ray& ray) const;
  /// Whether anything stands in the ray's way; cheaper than trace().
  bool occluded(const Ray& ray) const;
  /// occluded() for each ray: free[i] = 1 where nothing stands in the way of rays[i].
  void visibility(std::span<const Ray> rays, std::span<std::uint8_t> free) const;

  SurfacePoint surfaceAt(const RayHit& hit, const Ray& ray) const;

  /// Whether the alpha cut takes a point of a triangle away, given by its item, instance, mesh,
  /// triangle and barycentric coordinates.
  bool cutAt(const RayHit& point) const;

  /// Where a ray starts that leaves a point of a surface towards the side of `normal` (unit, the
  /// triangle's, turned to that side): so little off the surface that rounding cannot put it on or
  /// behind it, about 2^-21 of the coordinates' size.
  glm::vec3 originOff(const glm::vec3& position, const glm::vec3& normal) const;

  /// How far that is, m.
  float originOffset(const glm::vec3& position) const;

  /// Bytes that Embree holds for the scene.
  std::size_t memoryBytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace verdure

#endif  // VERDURE_RAYS_RAY_SCENE_H_
