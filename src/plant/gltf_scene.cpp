#include "plant/gltf_scene.h"

#include <fmt/format.h>

#include <glm/gtc/quaternion.hpp>

#include "plant/gltf_accessor.h"

namespace verdure {
namespace {

/// Far beyond any forest; keeps a small file from asking for all memory.
constexpr std::size_t kMaxInstances = 1'000'000;

glm::dmat4 compose(const glm::dvec3& translation, const glm::dvec4& rotation,
                   const glm::dvec3& scale) {
  glm::dquat q(rotation.w, rotation.x, rotation.y, rotation.z);
  const double length = glm::length(q);
  q = length > 1e-12 ? q / length : glm::dquat(1.0, 0.0, 0.0, 0.0);
  glm::dmat4 m(glm::mat3_cast(q));
  for (int c = 0; c < 3; ++c) m[c] *= scale[c];
  m[3] = glm::dvec4(translation, 1.0);
  return m;
}

glm::dmat4 localTransform(const GltfDocument& document, const Json& node, const std::string& who) {
  glm::dmat4 m(1.0);
  if (readNumbers(document, node, "matrix", {&m[0][0], 16}, who)) return m;
  Instance trs;
  readNumbers(document, node, "translation", {&trs.translation[0], 3}, who);
  readNumbers(document, node, "rotation", {&trs.rotation[0], 4}, who);
  readNumbers(document, node, "scale", {&trs.scale[0], 3}, who);
  return compose(trs.translation, trs.rotation, trs.scale);
}

/// Node numbers in an array member.
std::vector<std::size_t> nodeList(const GltfDocument& document, const Json& object, const char* key,
                                  const std::string& who) {
  std::vector<std::size_t> nodes;
  const Json* list = member(object, key);
  if (list == nullptr) return nodes;
  const std::size_t count = document.list("nodes").size();
  if (!list->is_array()) document.fail(fmt::format("{}: '{}' is not a list", who, key));
  for (const Json& entry : *list) {
    if (!entry.is_number_integer() || entry.get<std::size_t>() >= count)
      document.fail(fmt::format("{}: '{}' names node {}, but the file has {} nodes", who, key,
                                entry.dump(-1, ' ', true).substr(0, 40), count));
    nodes.push_back(entry.get<std::size_t>());
  }
  return nodes;
}

}  // namespace

GltfScene readScene(const GltfDocument& document) {
  const Json& nodes = document.list("nodes");
  const std::size_t count = nodes.size();
  std::vector<std::vector<std::size_t>> children(count);
  std::vector<std::size_t> parent(count, count);
  for (std::size_t n = 0; n < count; ++n) {
    const std::string who = document.label("nodes", "node", n);
    children[n] = nodeList(document, nodes[n], "children", who);
    for (const std::size_t child : children[n]) {
      if (parent[child] != count)
        document.fail(document.label("nodes", "node", child) + " has two parents");
      parent[child] = n;
    }
  }
  GltfScene scene;
  scene.world_from_node.assign(count, glm::dmat4(1.0));
  std::vector<std::size_t> stack;
  std::size_t visited = 0;
  for (std::size_t n = 0; n < count; ++n)
    if (parent[n] == count) stack.push_back(n);
  while (!stack.empty()) {
    const std::size_t n = stack.back();
    stack.pop_back();
    ++visited;
    const glm::dmat4 local = localTransform(document, nodes[n], document.label("nodes", "node", n));
    scene.world_from_node[n] =
        parent[n] == count ? local : scene.world_from_node[parent[n]] * local;
    stack.insert(stack.end(), children[n].begin(), children[n].end());
  }
  // Every node has at most one parent: those that no root reaches go round in a circle.
  if (visited != count) document.fail("its nodes form a cycle");

  const Json& scenes = document.list("scenes");
  std::vector<std::size_t> roots;
  if (scenes.empty()) {
    for (std::size_t n = 0; n < count; ++n)
      if (parent[n] == count) roots.push_back(n);
  } else {
    const std::size_t chosen =
        readIndex(document, document.json, "scene", "scenes", "the file").value_or(0);
    roots = nodeList(document, scenes[chosen], "nodes", document.label("scenes", "scene", chosen));
  }
  std::vector<bool> seen(count, false);
  stack.assign(roots.rbegin(), roots.rend());
  while (!stack.empty()) {
    const std::size_t n = stack.back();
    stack.pop_back();
    if (seen[n]) continue;
    seen[n] = true;
    if (readIndex(document, nodes[n], "mesh", "meshes", document.label("nodes", "node", n)))
      scene.mesh_nodes.push_back(n);
    stack.insert(stack.end(), children[n].rbegin(), children[n].rend());
  }
  if (scene.mesh_nodes.empty())
    document.fail("its scene shows no mesh", "export the plant's mesh with the scene");
  return scene;
}

std::vector<Instance> readInstances(const GltfDocument& document, std::size_t node) {
  std::vector<Instance> instances;
  const Json* ext = extension(document.list("nodes")[node], "EXT_mesh_gpu_instancing");
  if (ext == nullptr) return instances;
  const std::string who = document.label("nodes", "node", node) + " (EXT_mesh_gpu_instancing)";
  const Json* attributes = member(*ext, "attributes");
  if (attributes == nullptr) document.fail(who + " has no attributes");
  const auto read = [&](const char* key, std::size_t components) {
    const auto accessor = readIndex(document, *attributes, key, "accessors", who);
    std::vector<float> values;
    if (!accessor) return values;
    values = readFloats(document, *accessor, components, who);
    const std::size_t count = values.size() / components;
    if (count > kMaxInstances || (!instances.empty() && count != instances.size()))
      document.fail(fmt::format("{}: {} has {} elements", who, key, count));
    for (const float v : values)
      if (!std::isfinite(v))
        document.fail(fmt::format("{}: {} holds a number that is not finite", who, key));
    instances.resize(count);
    return values;
  };
  const auto translations = read("TRANSLATION", 3);
  const auto rotations = read("ROTATION", 4);
  const auto scales = read("SCALE", 3);
  for (std::size_t i = 0; i < instances.size(); ++i)
    for (std::size_t c = 0; c < 4; ++c) {
      const int k = static_cast<int>(c);
      if (c < 3 && !translations.empty()) instances[i].translation[k] = translations[3 * i + c];
      if (!rotations.empty()) instances[i].rotation[k] = rotations[4 * i + c];
      if (c < 3 && !scales.empty()) instances[i].scale[k] = scales[3 * i + c];
    }
  return instances;
}

namespace {

/// Adds JOINTS_n / WEIGHTS_n, weighted, to each vertex's matrix.
void addJoints(const GltfDocument& document, const std::vector<glm::dmat4>& joints,
               const Json& attributes, int set, std::vector<glm::dmat4>& matrices,
               std::vector<double>& sums, const std::string& who) {
  const auto joint_accessor =
      readIndex(document, attributes, fmt::format("JOINTS_{}", set).c_str(), "accessors", who);
  const auto weight_accessor =
      readIndex(document, attributes, fmt::format("WEIGHTS_{}", set).c_str(), "accessors", who);
  if (!joint_accessor || !weight_accessor) return;
  const auto indices = readUnsigned(document, *joint_accessor, 4, who);
  const auto weights = readFloats(document, *weight_accessor, 4, who);
  if (indices.size() != weights.size())
    document.fail(who + ": JOINTS and WEIGHTS differ in length");
  if (set == 0) {
    matrices.assign(weights.size() / 4, glm::dmat4(0.0));
    sums.assign(weights.size() / 4, 0.0);
  }
  if (matrices.size() != weights.size() / 4)
    document.fail(who + ": sets of JOINTS differ in length");
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] == 0.0f) continue;
    if (!std::isfinite(weights[i]) || indices[i] >= joints.size())
      document.fail(
          fmt::format("{}: vertex {} names joint {} of {}", who, i / 4, indices[i], joints.size()));
    matrices[i / 4] += static_cast<double>(weights[i]) * joints[indices[i]];
    sums[i / 4] += static_cast<double>(weights[i]);
  }
}

}  // namespace

NodePlacement placement(const GltfDocument& document, const GltfScene& scene, std::size_t node,
                        const Json& primitive, const std::string& who) {
  NodePlacement result;
  const Json& json = document.list("nodes")[node];
  const Json* attributes = member(primitive, "attributes");
  const auto skin = readIndex(document, json, "skin", "skins", who);
  if (skin && attributes != nullptr && member(*attributes, "JOINTS_0") != nullptr) {
    const std::string skin_label = document.label("skins", "skin", *skin);
    const auto joint_nodes =
        nodeList(document, document.list("skins")[*skin], "joints", skin_label);
    std::vector<float> inverse_bind;
    if (const auto accessor = readIndex(document, document.list("skins")[*skin],
                                        "inverseBindMatrices", "accessors", skin_label))
      inverse_bind = readFloats(document, *accessor, 16, skin_label);
    if (!inverse_bind.empty() && inverse_bind.size() < joint_nodes.size() * 16)
      document.fail(skin_label + " has fewer inverse bind matrices than joints");
    std::vector<glm::dmat4> joints;
    for (std::size_t j = 0; j < joint_nodes.size(); ++j) {
      glm::dmat4 bind(1.0);
      if (!inverse_bind.empty())
        for (std::size_t i = 0; i < 16; ++i)
          bind[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = inverse_bind[j * 16 + i];
      joints.push_back(scene.world_from_node[joint_nodes[j]] * bind);
    }
    std::vector<double> sums;
    for (int set = 0; set < 4; ++set)
      addJoints(document, joints, *attributes, set, result.world_from_local, sums, who);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      if (sums[i] > 1e-9)
        result.world_from_local[i] /= sums[i];
      else
        result.world_from_local[i] = glm::dmat4(1.0);
    }
    result.skinned = true;
    return result;
  }
  const glm::dmat4& world_from_node = scene.world_from_node[node];
  if (extension(json, "EXT_mesh_gpu_instancing") == nullptr) {
    result.world_from_local = {world_from_node};
    return result;
  }
  for (const Instance& instance : readInstances(document, node))
    result.world_from_local.push_back(
        world_from_node * compose(instance.translation, instance.rotation, instance.scale));
  if (result.world_from_local.empty())
    document.fail(who + ": EXT_mesh_gpu_instancing has no instances");
  return result;
}

glm::dmat3 normalTransform(const glm::dmat4& m) {
  const glm::dvec3 x(m[0]), y(m[1]), z(m[2]);
  const glm::dmat3 cofactors(glm::cross(y, z), glm::cross(z, x), glm::cross(x, y));
  return glm::dot(x, cofactors[0]) < 0.0 ? -cofactors : cofactors;
}

}  // namespace verdure
