#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "plant/gltf_attributes.h"

#include "plant/gltf_accessor.h"
#include "plant/gltf_export.h"
#include "plant/gltf_scene.h"

namespace verdure {
namespace {

/// The values of one attribute, per element of the primitive's accessors.
struct AttributeValues {
  const VertexAttribute* attribute = nullptr;
  std::vector<float> values;  ///< components together

  bool operator==(const AttributeValues&) const = default;
};

/// What is to be written of one primitive.
struct PrimitiveValues {
  std::size_t primitive = 0;
  std::vector<AttributeValues> attributes;
  std::vector<bool> used;  ///< elements that the primitive's triangles use; empty = all

  bool operator==(const PrimitiveValues&) const = default;
};

/// What is to be written of all primitives of a mesh as one node shows it.
using MeshUse = std::vector<PrimitiveValues>;

/// Vertex arrays that one or more primitives of a mesh share.
struct Sheet {
  std::size_t position_accessor = 0;
  std::vector<std::size_t> primitives;
  PrimitiveValues all;

  bool accepts(std::size_t accessor, const PrimitiveValues& more) const {
    if (accessor != position_accessor || all.attributes.size() != more.attributes.size())
      return false;
    for (std::size_t a = 0; a < all.attributes.size(); ++a) {
      if (all.attributes[a].attribute != more.attributes[a].attribute) return false;
      const auto n = static_cast<std::size_t>(all.attributes[a].attribute->components);
      const std::vector<float>&mine = all.attributes[a].values, &its = more.attributes[a].values;
      for (std::size_t i = 0; i < all.used.size(); ++i)
        if (all.used[i] && more.used[i] && !std::equal(&mine[n * i], &mine[n * i] + n, &its[n * i]))
          return false;
    }
    return true;
  }

  void add(const PrimitiveValues& more) {
    for (std::size_t a = 0; a < all.attributes.size(); ++a) {
      const auto n = static_cast<std::size_t>(all.attributes[a].attribute->components);
      for (std::size_t i = 0; i < more.used.size(); ++i)
        if (more.used[i])
          std::copy_n(&more.attributes[a].values[n * i], n, &all.attributes[a].values[n * i]);
    }
    for (std::size_t i = 0; i < more.used.size(); ++i)
      if (more.used[i]) all.used[i] = true;
  }
};

std::vector<std::uint8_t> packed(const AttributeValues& values) {
  if (values.attribute->stored == Stored::kFloats) return bytesOf(values.values);
  if (values.attribute->stored == Stored::kIndices)
    return bytesOf(std::vector<std::uint16_t>(values.values.begin(), values.values.end()));
  std::vector<std::uint8_t> bytes;
  bytes.reserve(values.values.size());
  for (const float v : values.values) bytes.push_back(toByte(v));
  return bytes;
}

class AttributeWriter {
 public:
  AttributeWriter(const Plant& plant, const GltfDocument& original,
                  const std::vector<MeshSource>& sources,
                  const std::vector<VertexAttribute>& attributes)
      : plant_(plant),
        attributes_(attributes),
        sources_(sources),
        original_(original),
        document_(original),
        scene_(readScene(original_)) {
    countReferences();
  }

  GltfDocument write() {
    for (std::size_t first = 0; first < sources_.size();) {
      if (sources_[first].accessor_count == 0) {  // not in the document
        ++first;
        continue;
      }
      // The parts of one node follow each other.
      std::size_t end = first + 1;
      while (end < sources_.size() && sources_[end].node == sources_[first].node) ++end;
      writeNode(first, end);
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

  void writeNode(std::size_t first, std::size_t end) {
    const MeshSource& from = sources_[first];
    const bool instanced =
        extension(original_.list("nodes")[from.node], "EXT_mesh_gpu_instancing") != nullptr;
    std::vector<MeshUse> uses;
    for (std::size_t m = first; m < end; ++m) {
      const MeshSource& part = sources_[m];
      const Json& primitive = original_.list("meshes")[part.mesh]["primitives"][part.primitive];
      const NodePlacement place = placement(original_, scene_, part.node, primitive, "export");
      uses.resize(place.instances());
      for (std::size_t k = 0; k < place.instances(); ++k) {
        PrimitiveValues local = localValues(m, k, place, primitive);
        if (!local.attributes.empty()) uses[k].push_back(std::move(local));
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

  /// The values of part `m` for instance `k`, in the space of the accessors.
  PrimitiveValues localValues(std::size_t m, std::size_t k, const NodePlacement& place,
                              const Json& primitive) const {
    const MeshSource& from = sources_[m];
    PrimitiveValues local;
    local.primitive = from.primitive;
    const std::size_t used = from.vertices_per_instance;
    const auto element = [&](std::size_t i) {
      return from.vertex_of.empty() ? i : std::size_t{from.vertex_of[i]};
    };
    if (!from.vertex_of.empty()) {
      local.used.assign(from.accessor_count, false);
      for (std::size_t i = 0; i < used; ++i) local.used[element(i)] = true;
    }
    for (const VertexAttribute& a : attributes_) {
      const bool there = member(primitive["attributes"], a.name.c_str()) != nullptr;
      if ((a.filler && there) || (a.wanted && !a.wanted(m, primitive))) continue;
      AttributeValues& made = local.attributes.emplace_back(AttributeValues{&a, {}});
      const auto n = static_cast<std::size_t>(a.components);
      made.values.resize(from.accessor_count * n);
      for (std::size_t i = 0; i < from.accessor_count; ++i)
        std::copy_n(&a.unused[0], n, &made.values[n * i]);
      if (a.name == "NORMAL" && there && !from.vertex_of.empty())
        keepOldNormals(primitive, made.values);
      for (std::size_t i = 0; i < used; ++i) {
        glm::dmat4 plant_from_local = place.transform(k, element(i));
        plant_from_local[3] -= glm::dvec4(plant_.origin, 0.0);
        const glm::vec4 value = a.value(m, k * used + i, plant_from_local);
        std::copy_n(&value[0], n, &made.values[n * element(i)]);
      }
    }
    return local;
  }

  void keepOldNormals(const Json& primitive, std::vector<float>& normals) const {
    const auto old =
        readFloats(original_, primitive["attributes"]["NORMAL"].get<std::size_t>(), 3, "export");
    for (std::size_t i = 0; i + 2 < std::min(normals.size(), old.size()); i += 3) {
      const glm::vec3 n(old[i], old[i + 1], old[i + 2]);
      const float length = glm::length(n);
      for (int c = 0; c < 3; ++c)
        if (length > 1e-6f && std::isfinite(length))
          normals[i + static_cast<std::size_t>(c)] = n[c] / length;
    }
  }

  /// The mesh that shows `mesh` with these values: the mesh itself for the first, a copy for each
  /// other.
  std::size_t meshWith(std::size_t mesh, const MeshUse& use, std::size_t node,
                       const std::string& suffix) {
    auto& copies = copies_[mesh];
    for (const auto& [index, values] : copies)
      if (values == use) return index;
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
    for (const PrimitiveValues& values : use) {
      const Json& primitive = original_.list("meshes")[original]["primitives"][values.primitive];
      const auto accessor = primitive["attributes"]["POSITION"].get<std::size_t>();
      Sheet* home = nullptr;
      // Only primitives that use parts of common arrays need to share.
      for (Sheet& sheet : sheets)
        if (home == nullptr && !values.used.empty() && !sheet.all.used.empty() &&
            sheet.accepts(accessor, values))
          home = &sheet;
      if (home == nullptr) {
        home = &sheets.emplace_back();
        home->position_accessor = accessor;
        home->all = values;
      } else {
        home->add(values);
      }
      home->primitives.push_back(values.primitive);
    }
    for (const Sheet& sheet : sheets)
      for (const AttributeValues& values : sheet.all.attributes)
        writeAttribute(index, sheet, values, index == original);
  }

  /// Gives the sheet's primitives an attribute: in the accessor and buffer view of the old one
  /// where nothing else uses them, so that replaced bytes do not stay in the file.
  void writeAttribute(std::size_t mesh, const Sheet& sheet, const AttributeValues& values,
                      bool in_place) {
    constexpr const char* kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    const VertexAttribute& attribute = *values.attribute;
    const char* const semantic = attribute.name.c_str();
    const std::size_t count = values.values.size() / static_cast<std::size_t>(attribute.components);
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
    view = appendView(document_, packed(values), kArrayBuffer, 0, view);
    Json& accessors = document_.json["accessors"];
    if (!accessor) {
      accessor = accessors.size();
      accessors.push_back(Json::object());
    }
    Json& json = accessors[*accessor];
    for (const char* key : {"byteOffset", "normalized", "min", "max", "sparse"}) json.erase(key);
    json["bufferView"] = *view;
    json["componentType"] = attribute.stored == Stored::kShares    ? kUnsignedByte
                            : attribute.stored == Stored::kIndices ? kUnsignedShort
                                                                   : kFloat;
    json["count"] = count;
    json["type"] = kTypes[attribute.components - 1];
    if (attribute.stored == Stored::kShares) json["normalized"] = true;
    for (const std::size_t p : sheet.primitives) primitives[p]["attributes"][semantic] = *accessor;
  }

  /// Instances with values differ, so each becomes a node of its own below the node that had them.
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
  const std::vector<VertexAttribute>& attributes_;
  const std::vector<MeshSource>& sources_;
  const GltfDocument& original_;
  GltfDocument document_;
  GltfScene scene_;
  std::map<std::size_t, std::size_t> accessor_uses_, view_uses_;
  std::map<std::size_t, std::vector<std::pair<std::size_t, MeshUse>>> copies_;  // by glTF mesh
};

/// Where the parts of a plant are in its newDocument(): a node, a mesh and a primitive for each
/// that has triangles.
std::vector<MeshSource> sourcesOfNew(const Plant& plant) {
  std::vector<MeshSource> sources;
  std::size_t written = 0;
  for (const Mesh& mesh : plant.meshes) {
    MeshSource& source = sources.emplace_back();
    source.node = written + 1;
    source.mesh = written;
    if (mesh.indices.empty()) continue;
    source.vertices_per_instance = source.accessor_count = mesh.positions.size();
    ++written;
  }
  return sources;
}

}  // namespace

bool matchesSource(const Plant& plant) {
  if (!plant.source || plant.source->meshes.size() != plant.meshes.size()) return false;
  for (std::size_t i = 0; i < plant.meshes.size(); ++i) {
    const MeshSource& from = plant.source->meshes[i];
    if (from.vertices_per_instance == 0 ||
        plant.meshes[i].positions.size() % from.vertices_per_instance != 0)
      return false;
  }
  return true;
}

glm::vec4 localPoint(const glm::dmat4& plant_from_local, const glm::vec3& point) {
  return glm::vec4(glm::inverse(plant_from_local) * glm::dvec4(glm::dvec3(point), 1.0));
}

glm::vec4 localNormal(const glm::dmat4& plant_from_local, const glm::vec3& normal) {
  const glm::dvec3 n = glm::transpose(glm::dmat3(plant_from_local)) * glm::dvec3(normal);
  const double length = glm::length(n);
  return length > 1e-30 ? glm::vec4(glm::vec3(n / length), 0.0f) : glm::vec4(0, 1, 0, 0);
}

GltfDocument documentWith(const Plant& plant, const std::vector<VertexAttribute>& attributes) {
  if (matchesSource(plant))
    return AttributeWriter(plant, plant.source->gltf, plant.source->meshes, attributes).write();
  const GltfDocument made = newDocument(plant, nullptr, {});
  return AttributeWriter(plant, made, sourcesOfNew(plant), attributes).write();
}

GltfDocument relitDocument(const Plant& plant, const CrownLight& light,
                           const ExportOptions& options) {
  const auto has_ambient = [&light](std::size_t m, const Json&) {
    return !light.meshes[m].ambient.empty();
  };
  std::vector<VertexAttribute> attributes;
  // What a bake left alone stays as it is in the file, bit by bit.
  attributes.push_back({"NORMAL", 3, Stored::kFloats, false, glm::vec4(0, 1, 0, 0),
                        [&](std::size_t m, const Json& primitive) {
                          return !light.meshes[m].normals.empty() &&
                                 !(member(primitive["attributes"], "NORMAL") != nullptr &&
                                   light.meshes[m].normals == plant.meshes[m].normals);
                        },
                        [&light](std::size_t m, std::size_t v, const glm::dmat4& plant_from_local) {
                          return localNormal(plant_from_local, light.meshes[m].normals[v]);
                        }});
  attributes.push_back({"_AO", 1, Stored::kFloats, false, glm::vec4(1.0f), has_ambient,
                        [&light](std::size_t m, std::size_t v, const glm::dmat4&) {
                          return glm::vec4(light.meshes[m].ambient[v]);
                        }});
  attributes.push_back({"_VISIBILITY", 2, Stored::kFloats, false, glm::vec4(1.0f),
                        [&light](std::size_t m, const Json&) {
                          const MeshLight& mesh = light.meshes[m];
                          return !mesh.ambient.empty() && !mesh.visibility.empty();
                        },
                        [&light](std::size_t m, std::size_t v, const glm::dmat4&) {
                          return glm::vec4(light.meshes[m].visibility[v], 0.0f, 0.0f);
                        }});
  if (options.color1) {
    // COLOR_1 may not stand without a COLOR_0, which multiplies the base colour: white.
    attributes.push_back(
        {"COLOR_0", 4, Stored::kShares, true, glm::vec4(1.0f), has_ambient,
         [](std::size_t, std::size_t, const glm::dmat4&) { return glm::vec4(1.0f); }});
    attributes.push_back({"COLOR_1", 4, Stored::kShares, false, glm::vec4(1.0f), has_ambient,
                          [&light](std::size_t m, std::size_t v, const glm::dmat4&) {
                            return glm::vec4(glm::vec3(light.meshes[m].ambient[v]), 1.0f);
                          }});
  }
  return documentWith(plant, attributes);
}

}  // namespace verdure
