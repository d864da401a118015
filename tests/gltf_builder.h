#ifndef VERDURE_TESTS_GLTF_BUILDER_H_
#define VERDURE_TESTS_GLTF_BUILDER_H_

#include <sys/wait.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/files.h"
#include "scratch.h"

namespace verdure {

using Json = nlohmann::ordered_json;

/// Puts glTF files together by hand, independently of verdure's own writer.
class GltfBuilder {
 public:
  Json json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}};
  std::vector<std::uint8_t> bin;

  GltfBuilder() {
    json["scenes"] = Json::array({{{"nodes", Json::array()}}});
    for (const char* key : {"nodes", "meshes", "accessors", "bufferViews"})
      json[key] = Json::array();
  }

  template <class T>
  int view(const std::vector<T>& values, int stride = 0) {
    while (bin.size() % 4 != 0) bin.push_back(0);
    Json v = {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", values.size() * sizeof(T)}};
    if (stride != 0) v["byteStride"] = stride;
    const auto* begin = reinterpret_cast<const std::uint8_t*>(values.data());
    bin.insert(bin.end(), begin, begin + values.size() * sizeof(T));
    json["bufferViews"].push_back(v);
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }

  int accessor(int buffer_view, int component_type, std::size_t count, const char* type,
               bool normalized = false, std::size_t offset = 0) {
    Json a = {{"componentType", component_type}, {"count", count}, {"type", type}};
    if (buffer_view >= 0) a["bufferView"] = buffer_view;
    if (normalized) a["normalized"] = true;
    if (offset != 0) a["byteOffset"] = offset;
    json["accessors"].push_back(a);
    return static_cast<int>(json["accessors"].size()) - 1;
  }

  int floats(const std::vector<glm::vec3>& v) {
    const int index = accessor(view(v), 5126, v.size(), "VEC3");
    glm::vec3 low = v[0], high = v[0];
    for (const glm::vec3& p : v) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    json["accessors"].back()["min"] = {low.x, low.y, low.z};
    json["accessors"].back()["max"] = {high.x, high.y, high.z};
    return index;
  }
  int floats(const std::vector<glm::vec2>& v) { return accessor(view(v), 5126, v.size(), "VEC2"); }
  int floats(const std::vector<glm::vec4>& v) { return accessor(view(v), 5126, v.size(), "VEC4"); }
  int indices(const std::vector<std::uint32_t>& v) {
    return accessor(view(v), 5125, v.size(), "SCALAR");
  }

  int mesh(Json primitives, const std::string& name = "") {
    Json m = {{"primitives", primitives.is_array() ? primitives : Json::array({primitives})}};
    if (!name.empty()) m["name"] = name;
    json["meshes"].push_back(m);
    return static_cast<int>(json["meshes"].size()) - 1;
  }

  /// Adds a node; to the scene if `root`.
  int node(Json n, bool root = true) {
    json["nodes"].push_back(std::move(n));
    const int index = static_cast<int>(json["nodes"].size()) - 1;
    if (root) json["scenes"][0]["nodes"].push_back(index);
    return index;
  }

  std::vector<std::uint8_t> glb() const {
    Json j = json;
    if (!j.contains("buffers")) j["buffers"] = Json::array({{{"byteLength", bin.size()}}});
    std::string text = j.dump();
    while (text.size() % 4 != 0) text += ' ';
    std::vector<std::uint8_t> padded = bin;
    while (padded.size() % 4 != 0) padded.push_back(0);
    std::vector<std::uint8_t> out;
    const auto word = [&](std::size_t w) {
      for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(w >> (8 * i)));
    };
    word(0x46546c67);
    word(2);
    word(12 + 8 + text.size() + 8 + padded.size());
    word(text.size());
    word(0x4e4f534a);
    out.insert(out.end(), text.begin(), text.end());
    word(padded.size());
    word(0x004e4942);
    out.insert(out.end(), padded.begin(), padded.end());
    return out;
  }
};

/// The JSON of a GLB file.
inline Json glbJson(const std::filesystem::path& path) {
  const auto bytes = readFile(path);
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, 4);
  return Json::parse(bytes.begin() + 20, bytes.begin() + 20 + length);
}

/// A closed box, counter-clockwise from outside, four vertices a face.
struct BoxMesh {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> uvs;
  std::vector<std::uint32_t> indices;

  explicit BoxMesh(const glm::vec3& reach = glm::vec3(1.0f)) {
    for (int axis = 0; axis < 3; ++axis)
      for (const float side : {-1.0f, 1.0f}) {
        glm::vec3 n(0.0f), u(0.0f);
        n[axis] = side;
        u[(axis + 1) % 3] = 1.0f;
        const glm::vec3 v = glm::cross(n, u);
        const auto base = static_cast<std::uint32_t>(positions.size());
        for (const glm::vec2 c :
             {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
          positions.push_back((n + c.x * u + c.y * v) * reach);
          normals.push_back(n);
          uvs.push_back(0.5f * c + 0.5f);
        }
        for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(base + i);
      }
  }
};

/// A builder with one box named "box", its primitive's JSON and node 0.
struct BoxFile : GltfBuilder {
  BoxMesh box;
  explicit BoxFile(const Json& node_members = Json::object()) {
    const Json primitive = {{"attributes",
                             {{"POSITION", floats(box.positions)},
                              {"NORMAL", floats(box.normals)},
                              {"TEXCOORD_0", floats(box.uvs)}}},
                            {"indices", indices(box.indices)}};
    mesh(primitive, "box");
    Json n = {{"mesh", 0}};
    n.update(node_members);
    node(n);
  }
  Json& primitive() { return json["meshes"][0]["primitives"][0]; }
};

/// Runs tests/npm/validate_gltf.mjs: 0 good, 1 issues, anything else: cannot run here.
inline int runValidator(const std::vector<std::string>& arguments) {
  std::string command = "node '" VERDURE_TEST_DATA "/../npm/validate_gltf.mjs'";
  for (const std::string& argument : arguments) command += " '" + argument + "'";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : 2;
}

}  // namespace verdure

#endif  // VERDURE_TESTS_GLTF_BUILDER_H_
