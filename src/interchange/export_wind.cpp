#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "interchange/document_files.h"
#include "interchange/pivot_painter.h"
#include "interchange/wind_records.h"
#include "interchange/wind_targets.h"
#include "plant/gltf_attributes.h"
#include "plant/gltf_stems.h"

namespace verdure {
namespace {

/// The first set of texture coordinates that nothing in the file uses; not the first of all.
int freeUvSet(const Plant& plant) {
  int set = 1;
  if (!matchesSource(plant)) return set;
  for (const Json& mesh : plant.source->gltf.list("meshes"))
    for (const Json& primitive : *member(mesh, "primitives"))
      while (member(primitive["attributes"], fmt::format("TEXCOORD_{}", set).c_str()) != nullptr)
        ++set;
  return set;
}

VertexAttribute filler(const std::string& name, int components, float value) {
  const glm::vec4 all(value);
  return {name,
          components,
          components == 4 ? Stored::kShares : Stored::kFloats,
          true,
          all,
          {},
          [all](std::size_t, std::size_t, const glm::dmat4&) { return all; }};
}

/// The target's attributes for the plant, with those that glTF wants before them: sets are numbered
/// without gaps.
std::vector<VertexAttribute> attributesOf(const WindTargetTable& table, const Plant& plant,
                                          const WindQuantities& quantities, int uv_set) {
  std::vector<VertexAttribute> attributes;
  for (const WindAttribute& from : table.attributes) {
    VertexAttribute to;
    to.name = from.name;
    if (from.name == "TEXCOORD") {
      to.name = fmt::format("TEXCOORD_{}", uv_set);
      for (int set = 0; set < uv_set; ++set)
        attributes.push_back(filler(fmt::format("TEXCOORD_{}", set), 2, 0.0f));
    }
    // COLOR_0 multiplies the base colour: white.
    if (from.name == "COLOR_1") attributes.push_back(filler("COLOR_0", 4, 1.0f));
    to.components = static_cast<int>(from.channels.size());
    to.stored = from.bytes ? Stored::kShares : Stored::kFloats;
    if (from.leaves_only)
      to.wanted = [&plant](std::size_t mesh, const Json&) {
        return plant.meshes[mesh].kind == PartKind::kFoliage;
      };
    to.value = [&quantities, channels = from.channels](std::size_t mesh, std::size_t vertex,
                                                       const glm::dmat4& plant_from_local) {
      glm::vec4 value(0.0f);
      for (std::size_t c = 0; c < channels.size(); ++c)
        value[static_cast<int>(c)] = quantities.of(channels[c], mesh, vertex, plant_from_local);
      return value;
    };
    attributes.push_back(std::move(to));
  }
  return attributes;
}

bool fileHas(const Plant& plant, const char* attribute) {
  return plant.source && std::find(plant.source->attributes.begin(), plant.source->attributes.end(),
                                   attribute) != plant.source->attributes.end();
}

std::vector<std::uint8_t> bytesOf(const std::string& text) {
  return {text.begin(), text.end()};
}

void addPivotPainter(const Plant& plant, const PlantMotion& motion, int uv_set,
                     const std::filesystem::path& path, FileBytes& files, WindFiles& report) {
  const MotionTree& tree = motion.tree;
  if (tree.branches.size() > kMostElements)
    throw Error(path.string(),
                fmt::format("the plant has {} branches, Pivot Painter 2 numbers {}",
                            tree.branches.size(), kMostElements),
                "use a smaller plant");
  const std::string mesh = path.stem().string();
  const auto folder = path.parent_path();
  files.emplace_back(folder / pivotTextureName(mesh, uv_set), pivotTexture(tree, plant.origin));
  files.emplace_back(folder / axisTextureName(mesh, uv_set), axisTexture(tree));
  double farthest = 0.0;
  std::size_t long_ones = 0;
  for (const MotionBranch& branch : tree.branches) {
    const glm::dvec3 root = glm::abs(glm::dvec3(branch.root) + plant.origin);
    farthest = std::max({farthest, root.x, root.y, root.z});
    if (branch.length > 20.48f) ++long_ones;
  }
  if (farthest > 655.0)
    report.notes.push_back(
        "pivots beyond 655 m do not fit a half: put the plant at the origin before");
  else if (farthest > 10.24)
    report.notes.push_back(fmt::format("halves place pivots {:.0f} m away within {} cm", farthest,
                                       std::exp2(std::floor(std::log2(100.0 * farthest)) - 11.0)));
  if (long_ones > 0)
    report.notes.push_back(
        fmt::format("branches longer than 20.48 m are written as that: {}", long_ones));
}

}  // namespace

WindFiles exportWind(const Plant& plant, const PlantMotion& motion, const std::string& target,
                     const std::filesystem::path& path) {
  const WindTargetTable& table = windTargetTable(target);
  checkPlantPath(path);
  WindFiles report;
  report.branches = motion.tree.branches.size();
  report.leaves = motion.leaves.size();
  const WindQuantities quantities(plant, motion);
  const int uv_set = freeUvSet(plant);
  const std::vector<VertexAttribute> attributes = attributesOf(table, plant, quantities, uv_set);
  for (const VertexAttribute& attribute : attributes)
    if (!attribute.filler) report.attributes.push_back(attribute.name);
  for (const char* name : {"COLOR_1", "_BRANCH"})
    if (fileHas(plant, name) &&
        std::count(report.attributes.begin(), report.attributes.end(), name))
      report.notes.push_back(std::string("the file's own ") + name + " is replaced");
  std::size_t still = 0;
  for (const auto& mesh : motion.tree.meshes)
    for (const VertexMotion& vertex : mesh)
      if (vertex.branch == kNone) ++still;
  if (still > 0)
    report.notes.push_back(
        fmt::format("{} vertices hang on no branch: {}", still,
                    target == kPivotPainter ? "they go with the first one" : "they stand still"));
  FileBytes files;
  if (target == kPivotPainter) addPivotPainter(plant, motion, uv_set, path, files, report);
  files.emplace_back(path.parent_path() / (path.stem().string() + ".wind.json"),
                     bytesOf(windRecords(plant, motion, quantities)));
  GltfDocument document = documentWith(plant, attributes);
  if (target == "attributes") writeStems(plant, document);
  writeAll(std::move(document), path, std::move(files), report);
  return report;
}

}  // namespace verdure
