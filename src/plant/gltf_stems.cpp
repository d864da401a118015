#include "plant/gltf_stems.h"

#include <algorithm>
#include <cmath>

#include "plant/gltf_accessor.h"
#include "plant/gltf_export.h"

namespace verdure {
namespace {

constexpr const char* kStems = "the file's branches";

/// Throws Error for anything that is not whole.
FileStems stemsIn(const GltfDocument& document, const Json& json) {
  FileStems read;
  std::vector<Branch>& branches = read.branches;
  const auto broken = [&](const char* what) -> Error { return {kStems, what}; };
  readNumbers(document, json, "origin", {&read.origin[0], 3}, kStems);
  const auto points_at = readIndex(document, json, "points", "accessors", kStems);
  const auto stems_at = readIndex(document, json, "stems", "accessors", kStems);
  if (!points_at || !stems_at) throw broken("have no points");
  const auto points = readFloats(document, *points_at, 4, kStems);
  const auto stems = readFloats(document, *stems_at, 4, kStems);
  for (const float value : points)
    if (!std::isfinite(value)) throw broken("have points that are not finite");
  for (std::size_t i = 0; i < stems.size(); i += 4) {
    const auto whole = [&](float value, double low, double high) {
      if (!(double{value} >= low && double{value} <= high) || std::floor(value) != value)
        throw broken("are not numbered");
      return static_cast<std::int64_t>(value);
    };
    Branch& branch = branches.emplace_back();
    const std::int64_t parent = whole(stems[i], -1.0, static_cast<double>(i / 4) - 1.0);
    if (parent >= 0) branch.parent = static_cast<std::uint32_t>(parent);
    branch.level = static_cast<int>(whole(stems[i + 1], 0.0, 255.0));
    branch.parent_offset = stems[i + 2];
    if (!(branch.parent_offset >= 0.0f && branch.parent_offset <= 1.0f))
      throw broken("leave their parents beside them");
    const auto count = static_cast<double>(points.size() / 4);
    const auto first = static_cast<std::size_t>(whole(stems[i + 3], 0.0, count));
    const std::size_t end =
        i + 4 < stems.size()
            ? static_cast<std::size_t>(whole(stems[i + 7], static_cast<double>(first) + 2.0, count))
            : points.size() / 4;
    if (end < first + 2 || (i == 0 && first != 0)) throw broken("have no points");
    for (std::size_t p = 4 * first; p < 4 * end; p += 4) {
      if (!(points[p + 3] >= 0.0f)) throw broken("have negative radii");
      branch.points.push_back({{points[p], points[p + 1], points[p + 2]}, points[p + 3]});
    }
  }
  if (const auto stalks_at = readIndex(document, json, "stalks", "accessors", kStems)) {
    const auto stalks = readFloats(document, *stalks_at, 3, kStems);
    for (std::size_t i = 0; i < stalks.size(); i += 3)
      read.stalks.emplace_back(stalks[i], stalks[i + 1], stalks[i + 2]);
  }
  return read;
}

/// Whether stalks are where leaves could have them: as far from their centres as corners are, or
/// twice that.
bool fitLeaves(const std::vector<glm::vec3>& stalks, const Plant& plant) {
  if (stalks.size() != plant.leaves.size()) return false;
  for (std::size_t l = 0; l < stalks.size(); ++l) {
    const Leaf& leaf = plant.leaves[l];
    const Mesh& mesh = plant.meshes[leaf.mesh];
    float reach = 0.0f;
    for (std::uint32_t k = 0; k < leaf.triangle_count; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        reach = std::max(
            reach,
            glm::length(
                mesh.positions
                    [mesh.indices[3 * std::size_t{plant.leaf_triangles[leaf.first_triangle + k]} +
                                  c]] -
                leaf.centroid));
    if (!(glm::length(stalks[l] - leaf.centroid) <= 2.0f * reach)) return false;
  }
  return true;
}

/// Within the meshes' bounds and a fifth around.
bool liesAmongMeshes(const Plant& plant, const std::vector<Branch>& branches) {
  const Bounds box = bounds(plant);
  const glm::vec3 margin(0.2f * glm::length(box.size()));
  for (const Branch& branch : branches)
    for (const BranchPoint& point : branch.points)
      if (glm::any(glm::lessThan(point.position, box.min - margin)) ||
          glm::any(glm::greaterThan(point.position, box.max + margin)))
        return false;
  return true;
}

const Json* stemsOf(const GltfDocument& document) {
  const Json* json = member(document.json, "asset");
  for (const char* key : {"extras", "verdure", "stems"})
    if (json != nullptr) json = member(*json, key);
  return json;
}

}  // namespace

std::vector<std::vector<float>> stemIds(const Plant& plant) {
  std::vector<std::vector<float>> ids;
  if (plant.branches.empty()) return ids;
  const auto number = [](std::uint32_t branch) {
    return branch == kNone ? -1.0f : static_cast<float>(branch);
  };
  for (const Mesh& mesh : plant.meshes) {
    std::vector<float>& of_mesh = ids.emplace_back(mesh.positions.size(), -1.0f);
    std::transform(mesh.branch_of_vertex.begin(), mesh.branch_of_vertex.end(), of_mesh.begin(),
                   number);
  }
  for (const Leaf& leaf : plant.leaves) {
    const Mesh& mesh = plant.meshes[leaf.mesh];
    for (std::uint32_t k = 0; k < leaf.triangle_count; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        ids[leaf.mesh]
           [mesh.indices[3 * std::size_t{plant.leaf_triangles[leaf.first_triangle + k]} + c]] =
               number(leaf.branch);
  }
  return ids;
}

void writeStems(const Plant& plant, GltfDocument& document) {
  if (plant.branches.empty()) return;
  std::vector<std::string> notes;
  if (readStems(document, notes).branches.size() == plant.branches.size()) return;  // its own
  std::vector<glm::vec4> points, stems;
  for (const Branch& branch : plant.branches) {
    stems.emplace_back(branch.parent == kNone ? -1.0f : static_cast<float>(branch.parent),
                       branch.level, branch.parent_offset, points.size());
    for (const BranchPoint& point : branch.points)
      points.emplace_back(point.position, point.radius);
  }
  Json& extras = document.json["asset"]["extras"];
  if (!extras.is_object() && !extras.is_null()) return;  // someone else's
  if (extras.contains("verdure") && !extras["verdure"].is_object()) return;
  std::vector<glm::vec3> stalks;
  for (const Leaf& leaf : plant.leaves) stalks.push_back(leaf.stalk);
  const auto add = [&](const auto& values, const char* type) {
    document.json["accessors"].push_back(
        {{"bufferView", appendView(document, bytesOf(values), 0, 0)},
         {"componentType", kFloat},
         {"count", values.size()},
         {"type", type}});
    return document.json["accessors"].size() - 1;
  };
  extras["verdure"]["stems"] = {{"origin", {plant.origin.x, plant.origin.y, plant.origin.z}},
                                {"points", add(points, "VEC4")},
                                {"stems", add(stems, "VEC4")}};
  if (!stalks.empty()) extras["verdure"]["stems"]["stalks"] = add(stalks, "VEC3");
}

bool namesStems(const GltfDocument& document) {
  return stemsOf(document) != nullptr;
}

FileStems readStems(const GltfDocument& document, std::vector<std::string>& notes) {
  const Json* const json = stemsOf(document);
  if (json == nullptr) return {};
  try {
    return stemsIn(document, *json);
  } catch (const Error& e) {
    notes.push_back("branches left out: " + std::string(e.what()));
    return {};
  }
}

void keepStems(FileStems stems, Plant& plant) {
  const glm::dvec3 offset = stems.origin - plant.origin;
  const auto moved = [&](const glm::vec3& p) { return glm::vec3(glm::dvec3(p) + offset); };
  for (Branch& branch : stems.branches)
    for (BranchPoint& point : branch.points) point.position = moved(point.position);
  for (glm::vec3& stalk : stems.stalks) stalk = moved(stalk);
  if (liesAmongMeshes(plant, stems.branches))
    plant.branches = std::move(stems.branches);
  else
    plant.notes.push_back("branches left out: they lie elsewhere than the meshes");
  if (!plant.branches.empty() && fitLeaves(stems.stalks, plant))
    for (std::size_t l = 0; l < plant.leaves.size(); ++l) plant.leaves[l].stalk = stems.stalks[l];
  const auto count = static_cast<std::uint32_t>(plant.branches.size());
  for (Mesh& mesh : plant.meshes)
    for (std::uint32_t& branch : mesh.branch_of_vertex)
      if (branch >= count) branch = kNone;
  for (Leaf& leaf : plant.leaves) {
    const Mesh& mesh = plant.meshes[leaf.mesh];
    leaf.branch = kNone == leaf.branch || leaf.branch >= count ? kNone : leaf.branch;
    if (!mesh.branch_of_vertex.empty())
      leaf.branch =
          mesh.branch_of_vertex[mesh.indices[3 * std::size_t{
                                                     plant.leaf_triangles[leaf.first_triangle]}]];
  }
  for (Mesh& mesh : plant.meshes)
    if (mesh.kind == PartKind::kFoliage || count == 0) mesh.branch_of_vertex.clear();
  // A tool may keep what is known of the branches and drop what hangs on them.
  bool any = std::any_of(plant.leaves.begin(), plant.leaves.end(),
                         [](const Leaf& leaf) { return leaf.branch != kNone; });
  for (const Mesh& mesh : plant.meshes)
    any = any || std::any_of(mesh.branch_of_vertex.begin(), mesh.branch_of_vertex.end(),
                             [](std::uint32_t branch) { return branch != kNone; });
  if (any || plant.branches.empty()) return;
  plant.branches.clear();
  plant.notes.push_back("branches left out: no vertex says which is its own");
}

}  // namespace verdure
