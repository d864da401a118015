#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "base/random.h"
#include "plant/gltf_scene.h"
#include "verdure/layout.h"

namespace verdure {
namespace {

constexpr double kFarM = 10e3;

/// What placements cannot hold, counted.
struct Lost {
  std::size_t tilts = 0, uneven = 0, mirrored = 0;
};

Placement placementOf(const glm::dmat4& world, Lost& lost) {
  glm::dmat3 axes(world);
  const glm::dvec3 lengths(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
  const double determinant = glm::determinant(axes);
  const double scale = std::cbrt(std::abs(determinant));
  if (!(scale > 0.0)) return {.scale = 0.0f};
  for (int a = 0; a < 3; ++a) axes[a] /= lengths[a];
  lost.mirrored += determinant < 0.0;
  lost.uneven += glm::any(glm::greaterThan(glm::abs(lengths / scale - 1.0), glm::dvec3(0.01)));
  lost.tilts += axes[1].y < 1.0 - 1e-4;
  Placement place;
  // The turn about +Y that is nearest to the rotation.
  place.angle = static_cast<float>(std::atan2(axes[2].x - axes[0].z, axes[0].x + axes[2].z));
  place.scale = static_cast<float>(scale);
  return place;
}

}  // namespace

Layout loadLayout(const std::filesystem::path& path) {
  GltfDocument document = readGltf(path);
  decompressGltf(document);
  const GltfScene scene = readScene(document);
  Layout layout;
  std::vector<glm::dvec3> positions;
  std::vector<std::vector<glm::dmat4>> seen;  // of each node
  Lost lost;
  std::size_t flat = 0;
  for (const std::size_t node : scene.mesh_nodes) {
    if (extension(document.list("nodes")[node], "EXT_mesh_gpu_instancing") == nullptr) continue;
    const NodePlacement instances =
        placement(document, scene, node, Json::object(), document.label("nodes", "node", node));
    // Wood and leaves may be nodes of their own at the same places: one plant.
    const auto& worlds = instances.world_from_local;
    if (std::find(seen.begin(), seen.end(), worlds) != seen.end()) continue;
    seen.push_back(worlds);
    for (const glm::dmat4& world : worlds) {
      Placement place = placementOf(world, lost);
      if (place.scale == 0.0f) {
        ++flat;
        continue;
      }
      place.plant = static_cast<std::uint32_t>(layout.nodes);
      place.phase = static_cast<std::uint32_t>(hash(layout.places.size()));
      layout.places.push_back(place);
      positions.emplace_back(world[3]);
    }
    ++layout.nodes;
  }
  if (layout.places.empty())
    document.fail("has no instances (EXT_mesh_gpu_instancing)", "export the places as instances");

  glm::dvec3 low = positions[0], high = positions[0];
  for (const glm::dvec3& p : positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  glm::dvec3 moved(0.0);
  const auto note = [&layout](const std::string& text) { layout.notes.push_back(text); };
  if (glm::any(glm::greaterThan(glm::max(glm::abs(low), glm::abs(high)), glm::dvec3(kFarM)))) {
    moved = glm::round(0.5 * (low + high));
    moved.y = std::floor(low.y);
    note(fmt::format(
        "its instances are far from the origin: moved there by {:.0f}, {:.0f}, {:.0f} m", -moved.x,
        -moved.y, -moved.z));
  }
  for (std::size_t i = 0; i < positions.size(); ++i)
    layout.places[i].position = glm::vec3(positions[i] - moved);
  if (lost.tilts > 0) note(fmt::format("{} instances are tilted: they stand upright", lost.tilts));
  if (lost.uneven > 0)
    note(fmt::format("{} instances are scaled unevenly: they are as large on the mean",
                     lost.uneven));
  if (lost.mirrored > 0)
    note(fmt::format("{} instances are mirrored: they are not", lost.mirrored));
  if (flat > 0) note(fmt::format("{} instances have no size: left out", flat));
  return layout;
}

}  // namespace verdure
