#ifndef VERDURE_BAKE_RAY_BAKE_H_
#define VERDURE_BAKE_RAY_BAKE_H_

#include <functional>
#include <span>

#include "bake/ray_starts.h"
#include "base/random.h"
#include "rays/ray_scene.h"
#include "verdure/occlusion.h"

namespace verdure {

/// m^2.
double areaOf(const Mesh& mesh, std::size_t triangle);

/// What the bakes by rays share: the plant as a scene, where rays leave its vertices, and the loop
/// over vertices.
class RayBake {
 public:
  static constexpr int kBatch = 64;  ///< rays at once

  /// Throws Error as traceOpenness.
  RayBake(const Plant& plant, const RayOptions& options, const CrownLight* normals = nullptr);
  RayBake(const RayBake&) = delete;
  RayBake& operator=(const RayBake&) = delete;

  /// body(i, random) for each vertex in parallel; the random stream depends on the seed and the
  /// vertex alone. The share done that is told goes from `begin` to `end`.
  void forEachVertex(std::span<const VertexId> vertices, double begin, double end,
                     const std::function<void(std::size_t i, Random& random)>& body) const;
  /// The same for i in [0, count); `stream` keeps the random numbers of several loops apart.
  void forEach(std::size_t count, std::uint64_t stream, double begin, double end,
               const std::function<void(std::size_t i, Random& random)>& body) const;

  /// The normal that a vertex is lit for.
  const glm::vec3& normalOf(VertexId id) const;

 private:
  const Plant& plant_;
  const RayOptions& options_;
  const CrownLight* normals_;

 public:
  const RayScene scene;
  const RayStarts starts;

 private:
  void run(std::size_t count, double begin, double end,
           const std::function<void(std::size_t i)>& body) const;
};

}  // namespace verdure

#endif  // VERDURE_BAKE_RAY_BAKE_H_
