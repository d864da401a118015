#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "plant/gltf_accessor.h"
#include "plant/gltf_export.h"
#include "plant/gltf_scene.h"

namespace verdure {
namespace {

/// The light of one primitive in the space of its mesh, per element of its accessors. Empty arrays:
/// nothing to write.
struct PrimitiveLight {
  std::size_t primitive = 0;
  std::vector<glm::vec3> normals;
  std::vector<float> ambient;
  std::vector<glm::vec2> visibility;
  std::vector<bool> used;  ///< elements that the primitive's triangles use; empty = all

  bool operator==(const PrimitiveLight&) const = default;
};

/// The light of all primitives of a mesh as one node shows it.
using MeshUse = std::vector<PrimitiveLight>;

/// Vertex arrays that one or more primitives of a mesh share.
struct Sheet {
  std::size_t position_accessor = 0;
  std::vector<std::size_t> primitives;
  PrimitiveLight light;

  bool accepts(std::size_t accessor, const PrimitiveLight& more) const {
    if (accessor != position_accessor || light.normals.empty() != more.normals.empty() ||
        light.ambient.empty() != more.ambient.empty() ||
        light.visibility.empty() != more.visibility.empty())
      return false;
    for (std::size_t i = 0; i < light.used.size(); ++i)
      if (light.used[i] && more.used[i] &&
          ((!light.normals.empty() && light.normals[i] != more.normals[i]) ||
           (!light.ambient.empty() && light.ambient[i] != more.ambient[i]) ||
           (!light.visibility.empty() && light.visibility[i] != more.visibility[i])))
        return false;
    return true;
  }

  void add(const PrimitiveLight& more) {
    for (std::size_t i = 0; i < more.used.size(); ++i) {
      if (!more.used[i]) continue;
      if (!more.normals.empty()) light.normals[i] = more.normals[i];
      if (!more.ambient.empty()) light.ambient[i] = more.ambient[i];
      if (!more.visibility.empty()) light.visibility[i] = more.visibility[i];
      light.used[i] = true;
    }
  }
};

class Relighter {
 public:
  Relighter(const Plant& plant, const CrownLight& light, const ExportOptions& options)
      : plant_(plant),
        light_(light),
        options_(options),
        source_(*plant.source),
        original_(plant.source->gltf),
        document_(plant.source->gltf),
        scene_(readScene(original_)) {
    countReferences();
  }

  GltfDocument relight() {
    for (std::size_t first = 0; first < plant_.meshes.size();) {
      // The parts of one node follow each other.
      std::size_t end = first + 1;
      while (end < plant_.meshes.size() && source_.meshes[end].node == source_.meshes[first].node)
        ++end;
      relightNode(first, end);
      first = end;
    }
    return std::move(document_);
  }

 private:
  void countReferences() {
    for (const Json& mesh : original_.list("meshes"))
      for (const Json& primitive : *member(mesh, "primitives")) {
        const auto count = [&](const Json& value) {
          if (value.is_number_integer()) ++accessor_uses_[value.get<std::size_t>()];
        };
        if (const Json* attributes = member(primitive, "attributes"))
          for (const Json& value : *attributes) count(value);
        if (const Json* indices = member(primitive, "indices")) count(*indices);
        if (const Json* targets = member(primitive, "targets"))
          for (const Json& target : *targets)
            for (const Json& value : target) count(value);
      }
    countViews(original_.json);
  }

  void countViews(const Json& json) {
    if (json.is_object()) {
      for (auto it = json.begin(); it != json.end(); ++it) {
        if (it.key() == "bufferView" && it.value().is_number_integer())
          ++view_uses_[it.value().get<std::size_t>()];
        else
          countViews(it.value());
      }
    } else if (json.is_array()) {
      for (const Json& entry : json) countViews(entry);
    }
  }

  void relightNode(std::size_t first, std::size_t end) {
    const MeshSource& from = source_.meshes[first];
    const bool instanced =
        extension(original_.list("nodes")[from.node], "EXT_mesh_gpu_instancing") != nullptr;
    std::vector<MeshUse> uses;
    for (std::size_t m = first; m < end; ++m) {
      const MeshSource& part = source_.meshes[m];
      const Json& primitive = original_.list("meshes")[part.mesh]["primitives"][part.primitive];
      const NodePlacement place = placement(original_, scene_, part.node, primitive, "export");
      uses.resize(place.instances());
      for (std::size_t k = 0; k < place.instances(); ++k) {
        PrimitiveLight local = localLight(m, k, place, primitive);
        if (!local.normals.empty() || !local.ambient.empty()) uses[k].push_back(std::move(local));
      }
    }
    bool any = false;
    for (const MeshUse& use : uses) any = any || !use.empty();
    if (!any) return;
    if (!instanced) {
      document_.json["nodes"][from.node]["mesh"] = meshWith(from.mesh, uses[0], from.node, "");
      return;
    }
    expandInstances(from, uses);
  }

  /// The light of part `m` for instance `k`, taken back to the space of the accessors.
  PrimitiveLight localLight(std::size_t m, std::size_t k, const NodePlacement& place,
                            const Json& primitive) const {
    const MeshSource& from = source_.meshes[m];
    const MeshLight& light = light_.meshes[m];
    PrimitiveLight local;
    local.primitive = from.primitive;
    const bool has_normals = member(primitive["attributes"], "NORMAL") != nullptr;
    // What a bake left alone stays as it is in the file, bit by bit.
    const bool write_normals =
        !light.normals.empty() && !(has_normals && light.normals == plant_.meshes[m].normals);
    const std::size_t used = from.vertices_per_instance;
    if (!from.vertex_of.empty()) local.used.assign(from.accessor_count, false);
    if (write_normals) {
      local.normals.assign(from.accessor_count, glm::vec3(0.0f, 1.0f, 0.0f));
      if (has_normals && !from.vertex_of.empty()) keepOldNormals(primitive, local.normals);
    }
    if (!light.ambient.empty()) local.ambient.assign(from.accessor_count, 1.0f);
    if (!light.visibility.empty()) local.visibility.assign(from.accessor_count, glm::vec2(1.0f));
    for (std::size_t i = 0; i < used; ++i) {
      const std::size_t v = from.vertex_of.empty() ? i : from.vertex_of[i];
      if (!local.used.empty()) local.used[v] = true;
      if (write_normals) {
        const glm::dmat3 m3(place.transform(k, v));
        const glm::dvec3 n = glm::transpose(m3) * glm::dvec3(light.normals[k * used + i]);
        const double length = glm::length(n);
        if (length > 1e-30) local.normals[v] = glm::vec3(n / length);
      }
      if (!light.ambient.empty()) local.ambient[v] = light.ambient[k * used + i];
      if (!light.visibility.empty()) local.visibility[v] = light.visibility[k * used + i];
    }
    return local;
  }

  void keepOldNormals(const Json& primitive, std::vector<glm::vec3>& normals) const {
    const auto old =
        readFloats(original_, primitive["attributes"]["NORMAL"].get<std::size_t>(), 3, "export");
    for (std::size_t i = 0; i < normals.size() && 3 * i + 2 < old.size(); ++i) {
      const glm::vec3 n(old[3 * i], old[3 * i + 1], old[3 * i + 2]);
      const float length = glm::length(n);
      if (length > 1e-6f && std::isfinite(length)) normals[i] = n / length;
    }
  }

  /// The mesh that shows `mesh` in this light: the mesh itself for the first light, a copy for each
  /// other.
  std::size_t meshWith(std::size_t mesh, const MeshUse& use, std::size_t node,
                       const std::string& suffix) {
    auto& copies = copies_[mesh];
    for (const auto& [index, light] : copies)
      if (light == use) return index;
    std::size_t index = mesh;
    if (!copies.empty()) {
      Json copy = original_.list("meshes")[mesh];
      const std::string node_name = readString(original_.list("nodes")[node], "name");
      copy["name"] =
          fmt::format("{} ({}{})", readString(copy, "name", fmt::format("mesh {}", mesh)),
                      node_name.empty() ? fmt::format("node {}", node) : node_name, suffix);
      index = document_.list("meshes").size();
      document_.json["meshes"].push_back(std::move(copy));
    }
    writeMesh(index, mesh, use);
    copies.emplace_back(index, use);
    return index;
  }

  void writeMesh(std::size_t index, std::size_t original, const MeshUse& use) {
    std::vector<Sheet> sheets;
    for (const PrimitiveLight& light : use) {
      const Json& primitive = original_.list("meshes")[original]["primitives"][light.primitive];
      const auto accessor = primitive["attributes"]["POSITION"].get<std::size_t>();
      Sheet* home = nullptr;
      // Only primitives that use parts of common arrays need to share.
      for (Sheet& sheet : sheets)
        if (home == nullptr && !light.used.empty() && !sheet.light.used.empty() &&
            sheet.accepts(accessor, light))
          home = &sheet;
      if (home == nullptr) {
        home = &sheets.emplace_back();
        home->position_accessor = accessor;
        home->light = light;
      } else {
        home->add(light);
      }
      home->primitives.push_back(light.primitive);
    }
    for (const Sheet& sheet : sheets) {
      const bool in_place = index == original;
      const std::size_t count =
          sheet.light.normals.empty() ? sheet.light.ambient.size() : sheet.light.normals.size();
      if (!sheet.light.normals.empty())
        writeAttribute(index, sheet, "NORMAL", "VEC3", kFloat, false, bytesOf(sheet.light.normals),
                       count, in_place);
      if (sheet.light.ambient.empty()) continue;
      writeAttribute(index, sheet, "_AO", "SCALAR", kFloat, false, bytesOf(sheet.light.ambient),
                     count, in_place);
      if (!sheet.light.visibility.empty())
        writeAttribute(index, sheet, "_VISIBILITY", "VEC2", kFloat, false,
                       bytesOf(sheet.light.visibility), count, in_place);
      if (!options_.color1) continue;
      // COLOR_1 may not stand without a COLOR_0, which multiplies the base colour: white.
      const Json& first = document_.list("meshes")[index]["primitives"][sheet.primitives[0]];
      if (member(first["attributes"], "COLOR_0") == nullptr)
        writeAttribute(index, sheet, "COLOR_0", "VEC4", kUnsignedByte, true,
                       std::vector<std::uint8_t>(count * 4, 255), count, in_place);
      writeAttribute(index, sheet, "COLOR_1", "VEC4", kUnsignedByte, true,
                     ambientColors(sheet.light.ambient), count, in_place);
    }
  }

  /// Gives the sheet's primitives an attribute: in the accessor and buffer view of the old one
  /// where nothing else uses them, so that replaced bytes do not stay in the file.
  void writeAttribute(std::size_t mesh, const Sheet& sheet, const char* semantic, const char* type,
                      int component_type, bool normalized, std::vector<std::uint8_t> bytes,
                      std::size_t count, bool in_place) {
    Json& primitives = document_.json["meshes"][mesh]["primitives"];
    std::optional<std::size_t> accessor, view;
    const Json* old = member(primitives[sheet.primitives[0]]["attributes"], semantic);
    if (in_place && old != nullptr && old->is_number_integer()) {
      const auto index = old->get<std::size_t>();
      std::size_t mine = 0;
      for (const std::size_t p : sheet.primitives) {
        const Json* same = member(primitives[p]["attributes"], semantic);
        if (same != nullptr && *same == *old) ++mine;
      }
      if (accessor_uses_[index] == mine && mine == sheet.primitives.size()) {
        accessor = index;
        const Json* old_view = member(document_.list("accessors")[index], "bufferView");
        if (old_view != nullptr && view_uses_[old_view->get<std::size_t>()] == 1)
          view = old_view->get<std::size_t>();
      }
    }
    view = appendView(document_, std::move(bytes), kArrayBuffer, 0, view);
    Json& accessors = document_.json["accessors"];
    if (!accessor) {
      accessor = accessors.size();
      accessors.push_back(Json::object());
    }
    Json& json = accessors[*accessor];
    for (const char* key : {"byteOffset", "normalized", "min", "max", "sparse"}) json.erase(key);
    json["bufferView"] = *view;
    json["componentType"] = component_type;
    json["count"] = count;
    json["type"] = type;
    if (normalized) json["normalized"] = true;
    for (const std::size_t p : sheet.primitives) primitives[p]["attributes"][semantic] = *accessor;
  }

  /// Lit instances differ, so each becomes a node of its own below the node that had them.
  void expandInstances(const MeshSource& from, const std::vector<MeshUse>& uses) {
    const auto instances = readInstances(original_, from.node);
    Json& nodes = document_.json["nodes"];
    const std::string name =
        readString(nodes[from.node], "name", fmt::format("node {}", from.node));
    Json children = Json::array();
    if (const Json* old = member(nodes[from.node], "children")) children = *old;
    for (std::size_t k = 0; k < instances.size(); ++k) {
      Json node = {{"name", fmt::format("{} {}", name, k)},
                   {"mesh", meshWith(from.mesh, uses[k], from.node, fmt::format(" {}", k))}};
      const Instance& at = instances[k];
      const double length = glm::length(at.rotation);
      const glm::dvec4 q = length > 0.0 ? at.rotation / length : glm::dvec4(0, 0, 0, 1);
      node["translation"] = {at.translation.x, at.translation.y, at.translation.z};
      node["rotation"] = {q.x, q.y, q.z, q.w};
      node["scale"] = {at.scale.x, at.scale.y, at.scale.z};
      children.push_back(nodes.size());
      nodes.push_back(std::move(node));
    }
    Json& parent = nodes[from.node];
    parent["children"] = std::move(children);
    parent.erase("mesh");
    parent["extensions"].erase("EXT_mesh_gpu_instancing");
    if (parent["extensions"].empty()) parent.erase("extensions");
    for (const Json& node : nodes)
      if (extension(node, "EXT_mesh_gpu_instancing") != nullptr) return;
    for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
      Json kept = Json::array();
      for (const Json& entry : document_.list(key))
        if (entry != "EXT_mesh_gpu_instancing") kept.push_back(entry);
      if (kept.empty())
        document_.json.erase(key);
      else
        document_.json[key] = std::move(kept);
    }
  }

  const Plant& plant_;
  const CrownLight& light_;
  const ExportOptions& options_;
  const SourceDocument& source_;
  const GltfDocument& original_;
  GltfDocument document_;
  GltfScene scene_;
  std::map<std::size_t, std::size_t> accessor_uses_, view_uses_;
  std::map<std::size_t, std::vector<std::pair<std::size_t, MeshUse>>> copies_;  // by glTF mesh
};

}  // namespace

GltfDocument relitDocument(const Plant& plant, const CrownLight& light,
                           const ExportOptions& options) {
  return Relighter(plant, light, options).relight();
}

}  // namespace verdure
