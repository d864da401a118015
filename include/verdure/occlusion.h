#ifndef VERDURE_OCCLUSION_H_
#define VERDURE_OCCLUSION_H_

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "verdure/plant.h"

/// What rays from a plant's vertices find: how much of the world a vertex sees, and how much light
/// reaches it.
///
/// Where rays start: a vertex of a leaf looks to both sides of it, and the triangles that meet at
/// the vertex do not block (it sees them edge-on); the rest of its leaf does. A vertex of wood
/// looks from just outside along its normal, so the wood below blocks: on a lone straight trunk one
/// half of all directions is free, on a lone flat leaf every direction is.
namespace verdure {

struct VertexId {
  std::uint32_t mesh = 0;  ///< index into Plant::meshes
  std::uint32_t vertex = 0;
};

/// All vertices of a plant, mesh by mesh.
std::vector<VertexId> allVertices(const Plant& plant);

/// How light is traced.
struct RayOptions {
  int rays = 256;   ///< for each vertex (and side of a leaf), 1 to 65536
  int bounces = 3;  ///< most surfaces that light meets on its way, 0 to 64; 0: surfaces are black
  /// Ground at this height, an infinite plane of shared::groundMeanColor(); vertices below it stand
  /// for where the plant enters it. Not set: light comes from below too.
  std::optional<float> ground_height;
  std::uint32_t seed = 1;
  /// Of the rays' scene; of the light that its surfaces pass on; of a result.
  std::size_t max_memory_bytes = std::size_t{8} << 30;
  /// Called now and then with the share done in [0, 1], from one thread at a time. Returns whether
  /// to go on: after false the call throws Error.
  std::function<bool(double share)> progress;
};

/// What a vertex sees of the whole sphere of directions, all surfaces opaque but for their alpha
/// cut, the plant alone in the world (with a ground the directions below the horizon are not free).
struct Openness {
  float share = 1.0f;         ///< of all directions that are free, [0, 1]
  glm::vec3 direction{0.0f};  ///< mean of the free directions (the "bent normal"), length <= 1
  /// Share of an even sky's light that reaches the side of a given normal: the free directions of
  /// its hemisphere, weighted by the cosine. 1 if no normals were given.
  float light = 1.0f;
};

/// RayOptions::bounces is not used. `normals`, if any: a unit normal for each vertex asked for.
/// Results are for the vertices in order and do not depend on
/// which other vertices are asked for, nor on threads. Throws Error: options out of range, a vertex
/// that the plant has not, another number of normals than of vertices, a scene over
/// max_memory_bytes, cancelled.
std::vector<Openness> traceOpenness(const Plant& plant, std::span<const VertexId> vertices,
                                    const RayOptions& options = {},
                                    std::span<const glm::vec3> normals = {});

/// Ambient occlusion: the light that reaches a vertex's hemisphere, weighted by the cosine to its
/// normal, from a world of even light 1, linear RGB (1 = open). Light is reflected diffusely by
/// every surface and diffusely transmitted by leaves (shared::leafTransmittance); with bounces = 0
/// it is the plain share of free sky. With bounces the light that all surfaces of the plant pass on
/// is found first, however few the vertices. `normals`, if given, replace the mesh's own (light of
/// this plant: a vertex whose crown normal looks out of the crown is lit from there). Throws as
/// traceOpenness.
std::vector<glm::vec3> traceAmbient(const Plant& plant, std::span<const VertexId> vertices,
                                    const RayOptions& options = {},
                                    const CrownLight* normals = nullptr);

/// The luminance of traceAmbient() for every vertex, kept at or above 1/255, beside the normals
/// that it was traced for: `normals`, or the plant's own.
CrownLight bakeAmbient(const Plant& plant, const RayOptions& options = {},
                       const CrownLight* normals = nullptr);

}  // namespace verdure

#endif  // VERDURE_OCCLUSION_H_
