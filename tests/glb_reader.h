#ifndef VERDURE_TESTS_GLB_READER_H_
#define VERDURE_TESTS_GLB_READER_H_

#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "gltf_builder.h"

namespace verdure {

/// Reads a .glb and poses its skins, independently of verdure's own reader.
class GlbReader {
 public:
  explicit GlbReader(const std::filesystem::path& path)
      : json(glbJson(path)), bytes_(readFile(path)) {
    std::uint32_t length = 0;
    std::memcpy(&length, bytes_.data() + 12, 4);
    bin_ = bytes_.data() + 28 + length;
  }

  Json json;

  /// Elements of an accessor, `width` numbers each (set by the call).
  std::vector<float> values(std::size_t index, std::size_t* width = nullptr) const {
    const Json& a = json["accessors"][index];
    const Json& view = json["bufferViews"][a["bufferView"].get<std::size_t>()];
    const std::string type = a["type"];
    const std::size_t n = type == "SCALAR" ? 1
                          : type == "VEC2" ? 2
                          : type == "VEC3" ? 3
                          : type == "VEC4" ? 4
                                           : 16;
    if (width != nullptr) *width = n;
    const int kind = a["componentType"];
    const std::size_t size = kind == 5126 || kind == 5125 ? 4 : kind == 5123 ? 2 : 1;
    const std::size_t stride = view.value("byteStride", n * size);
    const std::uint8_t* at =
        bin_ + view.value("byteOffset", std::size_t{0}) + a.value("byteOffset", std::size_t{0});
    std::vector<float> out;
    for (std::size_t i = 0; i < a["count"].get<std::size_t>(); ++i)
      for (std::size_t c = 0; c < n; ++c) {
        const std::uint8_t* p = at + i * stride + c * size;
        float f = 0.0f;
        std::uint32_t u = 0;
        std::memcpy(&u, p, size);
        if (kind == 5126)
          std::memcpy(&f, p, 4);
        else
          f = static_cast<float>(u);
        if (a.value("normalized", false)) f /= kind == 5121 ? 255.0f : 65535.0f;
        out.push_back(f);
      }
    return out;
  }

  const Json& primitive(std::size_t mesh, std::size_t p = 0) const {
    return json["meshes"][mesh]["primitives"][p];
  }
  bool has(std::size_t mesh, const std::string& name) const {
    return primitive(mesh)["attributes"].contains(name);
  }
  std::vector<glm::vec4> attribute(std::size_t mesh, const std::string& name) const {
    std::size_t n = 0;
    const auto flat = values(primitive(mesh)["attributes"][name].get<std::size_t>(), &n);
    std::vector<glm::vec4> out(flat.size() / n, glm::vec4(0.0f));
    for (std::size_t i = 0; i < flat.size(); ++i) out[i / n][static_cast<int>(i % n)] = flat[i];
    return out;
  }

  /// World matrices of all nodes with animation 0 at a time, linear between keys as glTF 2.0,
  /// appendix C, says.
  std::vector<glm::dmat4> pose(double time) const {
    Json nodes = json["nodes"];
    if (json.contains("animations") && time >= 0.0)
      for (const Json& channel : json["animations"][0]["channels"]) {
        const Json& sampler =
            json["animations"][0]["samplers"][channel["sampler"].get<std::size_t>()];
        std::size_t n = 0;
        const auto keys = values(sampler["input"]);
        const auto out = values(sampler["output"], &n);
        std::size_t k = 0;
        while (k + 2 < keys.size() && double{keys[k + 1]} <= time) ++k;
        const double share = std::min(
            std::max((time - double{keys[k]}) / (double{keys[k + 1]} - double{keys[k]}), 0.0), 1.0);
        Json& node = nodes[channel["target"]["node"].get<std::size_t>()];
        const std::string path = channel["target"]["path"];
        if (path == "rotation") {
          const auto at = [&](std::size_t i) {
            return glm::dquat(out[i * 4 + 3], out[i * 4], out[i * 4 + 1], out[i * 4 + 2]);
          };
          const glm::dquat q = glm::slerp(at(k), at(k + 1), share);
          node[path] = {q.x, q.y, q.z, q.w};
        } else {
          node[path] = Json::array();
          for (std::size_t c = 0; c < n; ++c)
            node[path].push_back((1.0 - share) * double{out[k * n + c]} +
                                 share * double{out[(k + 1) * n + c]});
        }
      }
    std::vector<glm::dmat4> world(nodes.size(), glm::dmat4(1.0));
    for (const Json& root : json["scenes"][json.value("scene", 0u)]["nodes"])
      place(nodes, root.get<std::size_t>(), glm::dmat4(1.0), world);
    return world;
  }

  /// Where the vertices of a node with a skin are.
  std::vector<glm::dvec3> skinned(std::size_t node, const std::vector<glm::dmat4>& world) const {
    const Json& skin = json["skins"][json["nodes"][node]["skin"].get<std::size_t>()];
    const auto mesh = json["nodes"][node]["mesh"].get<std::size_t>();
    const auto binds = values(skin["inverseBindMatrices"].get<std::size_t>());
    std::vector<glm::dmat4> joints;
    for (std::size_t j = 0; j < skin["joints"].size(); ++j) {
      glm::dmat4 bind;
      for (std::size_t i = 0; i < 16; ++i)
        bind[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = double{binds[16 * j + i]};
      joints.push_back(world[skin["joints"][j].get<std::size_t>()] * bind);
    }
    const auto position = attribute(mesh, "POSITION"), joint = attribute(mesh, "JOINTS_0"),
               weight = attribute(mesh, "WEIGHTS_0");
    std::vector<glm::dvec3> out;
    for (std::size_t v = 0; v < position.size(); ++v) {
      glm::dvec4 sum(0.0);
      for (int c = 0; c < 4; ++c)
        sum += double{weight[v][c]} * (joints.at(static_cast<std::size_t>(joint[v][c])) *
                                       glm::dvec4(glm::dvec3(position[v]), 1.0));
      out.emplace_back(sum);
    }
    return out;
  }

 private:
  static void place(const Json& nodes, std::size_t index, const glm::dmat4& parent,
                    std::vector<glm::dmat4>& world) {
    const Json& node = nodes[index];
    glm::dmat4 local(1.0);
    if (node.contains("matrix"))
      for (std::size_t i = 0; i < 16; ++i)
        local[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = node["matrix"][i];
    if (node.contains("rotation")) {
      const Json& q = node["rotation"];
      local = glm::mat4_cast(glm::dquat(q[3], q[0], q[1], q[2]));
    }
    if (node.contains("scale"))
      for (int c = 0; c < 3; ++c)
        local[c] *= node["scale"][static_cast<std::size_t>(c)].get<double>();
    if (node.contains("translation"))
      for (int c = 0; c < 3; ++c) local[3][c] = node["translation"][static_cast<std::size_t>(c)];
    world[index] = parent * local;
    if (!node.contains("children")) return;
    for (const Json& child : node["children"])
      place(nodes, child.get<std::size_t>(), world[index], world);
  }

  std::vector<std::uint8_t> bytes_;
  const std::uint8_t* bin_ = nullptr;
};

}  // namespace verdure

#endif  // VERDURE_TESTS_GLB_READER_H_
