#include "plant/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "plant/gltf_document.h"
#include "plant/normals.h"

namespace verdure {
namespace {

/// Farther from the origin than this many plant sizes, float positions lose what a bake needs.
constexpr double kFarInSizes = 8.0;

/// The point that positions are relative to: 0, or for far plants a whole-metre point at the foot.
glm::dvec3 chooseOrigin(const std::vector<RawPart>& parts) {
  glm::dvec3 low(std::numeric_limits<double>::max());
  glm::dvec3 high(std::numeric_limits<double>::lowest());
  for (const RawPart& part : parts)
    for (const glm::dvec3& p : part.world) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  if (!(low.x <= high.x)) return glm::dvec3(0.0);
  const glm::dvec3 center = 0.5 * (low + high);
  if (glm::length(center) <= kFarInSizes * glm::length(high - low)) return glm::dvec3(0.0);
  return {std::round(center.x), std::floor(low.y), std::round(center.z)};
}

/// Replaces normals that are missing or have no direction; says so.
void mendNormals(Mesh& mesh, std::vector<std::string>& notes) {
  if (mesh.normals.empty()) {
    mesh.normals = angleWeightedNormals(mesh.positions, mesh.indices);
    notes.push_back(fmt::format("part '{}' had no normals: mended from its triangles", mesh.name));
    return;
  }
  std::size_t bad = 0;
  std::vector<glm::vec3> computed;
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    if (mesh.normals[i] != glm::vec3(0.0f)) continue;
    if (computed.empty()) computed = angleWeightedNormals(mesh.positions, mesh.indices);
    mesh.normals[i] = computed[i];
    ++bad;
  }
  if (bad > 0)
    notes.push_back(fmt::format("part '{}' had {} normals without direction: mended", mesh.name,
                                withCommas(bad)));
}

Plant finish(RawPlant raw, const LoadOptions& options, const std::string& where) {
  Plant plant = std::move(raw.plant);
  plant.origin = chooseOrigin(raw.parts);
  if (plant.origin != glm::dvec3(0.0))
    plant.notes.push_back(fmt::format("far from the origin: positions are relative to ({}, {}, {})",
                                      plant.origin.x, plant.origin.y, plant.origin.z));
  std::vector<PartNames> names;
  for (RawPart& part : raw.parts) {
    Mesh& mesh = part.mesh;
    mesh.positions.reserve(part.world.size());
    for (const glm::dvec3& p : part.world) {
      const glm::vec3 position(p - plant.origin);
      if (!std::isfinite(position.x + position.y + position.z))
        throw Error(where, fmt::format("part '{}' has positions beyond all bounds", mesh.name),
                    "export the file again");
      mesh.positions.push_back(position);
    }
    part.world = {};
    mendNormals(mesh, plant.notes);
    names.push_back(std::move(part.names));
    plant.meshes.push_back(std::move(mesh));
  }
  classifyParts(plant, names, options, where);
  findLeaves(plant);
  keepStems(std::move(raw.stems), plant);
  return plant;
}

}  // namespace

std::string withCommas(std::size_t number) {
  const std::string digits = std::to_string(number);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

Plant loadPlant(const std::filesystem::path& path, const LoadOptions& options) {
  std::string type = path.extension().string();
  std::transform(type.begin(), type.end(), type.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool gltf = type == ".glb" || type == ".gltf";
  if (!gltf && type != ".obj" && type != ".fbx" && type != ".dae" && type != ".ply")
    throw Error(path.string(), "is not a kind of file that can be loaded",
                "use .glb, .gltf, .obj, .fbx, .dae or .ply");
  try {
    RawPlant raw = gltf ? importGltf(path) : importAssimp(path);
    if (raw.plant.name.empty()) raw.plant.name = path.stem().string();
    return finish(std::move(raw), options, path.string());
  } catch (const std::bad_alloc&) {
    throw Error(path.string(), "needs more memory than there is", "use a smaller plant");
  } catch (const std::length_error&) {
    throw Error(path.string(), "claims more data than can exist", "export the file again");
  }
}

}  // namespace verdure
