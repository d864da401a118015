#include "plant/skin_branches.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "plant/axis_fit.h"
#include "plant/gltf_accessor.h"
#include "plant/gltf_scene.h"

namespace verdure {
namespace {

/// A joint that goes on a branch is at least this thick by the one before it, turns by at most 70
/// degrees, and begins where that one ends.
constexpr float kLeastThickness = 0.45f, kLeastCosine = 0.34f, kLeastReach = 0.7f;

struct Joint {
  std::string name;
  std::uint32_t parent = kNone;
  std::vector<std::uint32_t> children;
  glm::vec3 head{0.0f}, way{0.0f};  ///< way: unit, or 0 if unknown
  std::vector<glm::vec3> wood;      ///< points that hang on it most
  bool used = false;                ///< it or a joint below it carries something
  float length = 0.0f, radius = 0.0f;
};

/// The joint of each vertex by its greatest weight, kNone where all are 0.
std::vector<std::uint32_t> jointsOfVertices(const GltfDocument& document, const MeshSource& from,
                                            const Json& attributes, const std::string& who) {
  std::vector<std::uint32_t> joint(from.accessor_count, kNone);
  std::vector<float> most(from.accessor_count, 0.0f);
  for (int set = 0; set < 4; ++set) {
    const auto joints =
        readIndex(document, attributes, fmt::format("JOINTS_{}", set).c_str(), "accessors", who);
    const auto weights =
        readIndex(document, attributes, fmt::format("WEIGHTS_{}", set).c_str(), "accessors", who);
    if (!joints || !weights) continue;
    const auto index = readUnsigned(document, *joints, 4, who);
    const auto weight = readFloats(document, *weights, 4, who);
    for (std::size_t i = 0; i < std::min({index.size(), weight.size(), 4 * joint.size()}); ++i) {
      if (!(weight[i] > most[i / 4])) continue;
      most[i / 4] = weight[i];
      joint[i / 4] = index[i];
    }
  }
  std::vector<std::uint32_t> of_vertex(from.vertices_per_instance);
  for (std::size_t v = 0; v < of_vertex.size(); ++v)
    of_vertex[v] = joint[from.vertex_of.empty() ? v : from.vertex_of[v]];
  return of_vertex;
}

class SkinReader {
 public:
  SkinReader(const Plant& plant, const GltfDocument& document, const GltfScene& scene)
      : plant_(plant), document_(document), scene_(scene) {
    const Json& nodes = document.list("nodes");
    parent_of_.assign(nodes.size(), nodes.size());
    for (std::size_t n = 0; n < nodes.size(); ++n)
      if (const Json* children = member(nodes[n], "children"))
        for (const Json& child : *children) parent_of_[child.get<std::size_t>()] = n;
  }

  /// Appends the branches of one skin; `meshes`: joint of each vertex, by mesh.
  void read(std::size_t skin, const std::map<std::size_t, std::vector<std::uint32_t>>& meshes,
            SkinBranches& out) {
    readJoints(skin);
    for (const auto& [m, joint_of] : meshes)
      for (std::size_t v = 0; v < joint_of.size(); ++v) {
        if (joint_of[v] >= joints_.size()) continue;
        Joint& joint = joints_[joint_of[v]];
        joint.used = true;
        if (plant_.meshes[m].kind == PartKind::kWood)
          joint.wood.push_back(plant_.meshes[m].positions[v]);
      }
    orderJoints();
    for (auto j = order_.rbegin(); j != order_.rend(); ++j)
      if (joints_[*j].used && joints_[*j].parent != kNone) joints_[joints_[*j].parent].used = true;
    for (const std::uint32_t j : order_) measure(joints_[j]);
    layBranches(out);
    for (const auto& [m, joint_of] : meshes) {
      std::vector<std::uint32_t>& branch = out.branch_of_vertex[m];
      branch.resize(joint_of.size(), kNone);
      for (std::size_t v = 0; v < joint_of.size(); ++v)
        if (joint_of[v] < joints_.size()) branch[v] = branch_of_[joint_of[v]];
    }
  }

 private:
  void readJoints(std::size_t skin) {
    const std::string who = document_.label("skins", "skin", skin);
    joints_.clear();
    std::map<std::size_t, std::uint32_t> joint_of_node;
    // Import has checked that these are nodes.
    for (const Json& entry : *member(document_.list("skins")[skin], "joints")) {
      const auto node = entry.get<std::size_t>();
      if (!joint_of_node.emplace(node, static_cast<std::uint32_t>(joints_.size())).second)
        document_.fail(
            fmt::format("{} names joint {} twice", who, document_.label("nodes", "node", node)));
      joints_.emplace_back().name = readString(document_.list("nodes")[node], "name");
      joints_.back().head = glm::vec3(glm::dvec3(scene_.world_from_node[node][3]) - plant_.origin);
    }
    for (const auto& [node, j] : joint_of_node)
      for (std::size_t n = parent_of_[node]; n < parent_of_.size(); n = parent_of_[n])
        if (const auto above = joint_of_node.find(n); above != joint_of_node.end()) {
          joints_[j].parent = above->second;
          break;
        }
    named_ = false;
    for (std::uint32_t j = 0; j < joints_.size(); ++j) {
      const std::uint32_t parent = joints_[j].parent;
      if (parent == kNone) continue;
      joints_[parent].children.push_back(j);
      named_ = named_ || followsByName(joints_[parent].name, joints_[j].name);
    }
  }

  /// Parents before children; readScene has refused cycles.
  void orderJoints() {
    order_.clear();
    for (std::uint32_t j = 0; j < joints_.size(); ++j)
      if (joints_[j].parent == kNone) order_.push_back(j);
    for (std::size_t i = 0; i < order_.size(); ++i)
      order_.insert(order_.end(), joints_[order_[i]].children.begin(),
                    joints_[order_[i]].children.end());
  }

  void measure(Joint& joint) const {
    glm::vec3 ahead(0.0f);
    for (const glm::vec3& p : joint.wood) ahead += p - joint.head;
    float spread = 0.0f;
    for (const glm::vec3& p : joint.wood) spread += glm::length(p - joint.head);
    // A ring about the head alone points nowhere.
    if (!(glm::length(ahead) > 0.2f * spread)) {
      ahead = glm::vec3(0.0f);
      for (const std::uint32_t c : joint.children) ahead += joints_[c].head - joint.head;
    }
    if (glm::length(ahead) > 0.0f) joint.way = glm::normalize(ahead);
    std::vector<float> off;
    for (const glm::vec3& p : joint.wood) {
      const float along = glm::dot(p - joint.head, joint.way);
      joint.length = std::max(joint.length, along);
      off.push_back(glm::length(p - joint.head - along * joint.way));
    }
    if (off.empty()) return;
    std::nth_element(off.begin(), off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2),
                     off.end());
    joint.radius = off[off.size() / 2];
  }

  /// Where the last joint of a branch ends: the middle of the wood that is farthest along, or the
  /// head of a joint beyond that.
  glm::vec3 tailOf(const Joint& joint) const {
    glm::vec3 sum(0.0f);
    float count = 0.0f;
    for (const glm::vec3& p : joint.wood)
      if (glm::dot(p - joint.head, joint.way) >= 0.85f * joint.length) {
        sum += p;
        ++count;
      }
    glm::vec3 tail = count > 0.0f ? sum / count : joint.head;
    for (const std::uint32_t c : joint.children) {
      const glm::vec3& head = joints_[c].head;
      const float along = glm::dot(head - joint.head, joint.way);
      const float off = glm::length(head - joint.head - along * joint.way);
      if (along > glm::dot(tail - joint.head, joint.way) && off < 0.3f * along) tail = head;
    }
    return tail;
  }

  /// Whether names say that b follows on a: "bough.002" on "bough.001".
  static bool followsByName(const std::string& a, const std::string& b) {
    const auto split = [](const std::string& name) {
      const std::size_t stem = name.find_last_not_of("0123456789") + 1;
      const std::string digits = name.substr(std::min(stem, name.size()));
      const bool number = !digits.empty() && digits.size() < 9;
      return std::pair(name.substr(0, stem), number ? std::stol(digits) : -2L);
    };
    const auto [stem_a, number_a] = split(a);
    const auto [stem_b, number_b] = split(b);
    return stem_a == stem_b && number_b == number_a + 1 && number_a >= 0;
  }

  /// The joint with which a branch goes on, kNone if it ends.
  std::uint32_t nextOf(const Joint& joint) const {
    if (named_) {
      for (const std::uint32_t c : joint.children)
        if (joints_[c].used && followsByName(joint.name, joints_[c].name)) return c;
      return kNone;
    }
    float reach = joint.length;
    if (joint.wood.empty())
      for (const std::uint32_t c : joint.children)
        reach = std::max(reach, glm::length(joints_[c].head - joint.head));
    std::uint32_t best = kNone;
    float most = 0.0f;
    for (const std::uint32_t c : joint.children) {
      const Joint& child = joints_[c];
      if (!child.used) continue;
      const bool known = joint.way != glm::vec3(0.0f) && child.way != glm::vec3(0.0f);
      const float cosine = known ? glm::dot(joint.way, child.way) : 1.0f;
      const float thickness = joint.radius > 0.0f && child.radius > 0.0f
                                  ? std::min(child.radius / joint.radius, 1.0f)
                                  : 1.0f;
      if (cosine < kLeastCosine || thickness < kLeastThickness ||
          glm::length(child.head - joint.head) < kLeastReach * reach)
        continue;
      const float score = thickness * (0.4f + cosine);
      if (score > most) {
        most = score;
        best = c;
      }
    }
    return best;
  }

  void layBranches(SkinBranches& out) {
    branch_of_.assign(joints_.size(), kNone);
    for (const std::uint32_t start : order_) {
      if (branch_of_[start] != kNone || !joints_[start].used) continue;
      const auto number = static_cast<std::uint32_t>(out.branches.size());
      Branch branch;
      if (joints_[start].parent != kNone) {
        branch.parent = branch_of_[joints_[start].parent];
        branch.level = out.branches[branch.parent].level + 1;
      }
      std::vector<glm::vec3> wood;
      std::uint32_t last = start;
      for (std::uint32_t j = start; j != kNone; j = nextOf(joints_[j])) {
        branch_of_[j] = number;
        last = j;
        branch.points.push_back({joints_[j].head, 0.0f});
        wood.insert(wood.end(), joints_[j].wood.begin(), joints_[j].wood.end());
      }
      const Joint& end = joints_[last];
      branch.points.push_back({tailOf(end), 0.0f});
      std::vector<std::pair<float, float>> samples;
      for (const glm::vec3& p : wood) samples.push_back(placeOnAxis(branch.points, p));
      fitRadii(std::move(samples), branch.points);
      if (branch.parent != kNone) {
        const std::vector<BranchPoint>& carrier = out.branches[branch.parent].points;
        const float length = axisLength(carrier);
        if (length > 0.0f)
          branch.parent_offset = placeOnAxis(carrier, branch.points[0].position).first / length;
      }
      out.branches.push_back(std::move(branch));
    }
  }

  const Plant& plant_;
  const GltfDocument& document_;
  const GltfScene& scene_;
  std::vector<std::size_t> parent_of_;  ///< of nodes; their number for none
  std::vector<Joint> joints_;
  bool named_ = false;  ///< names say which joints are one branch
  std::vector<std::uint32_t> order_, branch_of_;
};

}  // namespace

SkinBranches branchesOfSkins(const Plant& plant) {
  SkinBranches result;
  result.branch_of_vertex.resize(plant.meshes.size());
  if (!plant.source || plant.source->meshes.size() != plant.meshes.size()) return result;
  const GltfDocument& document = plant.source->gltf;
  if (document.list("skins").empty()) return result;
  std::map<std::size_t, std::map<std::size_t, std::vector<std::uint32_t>>> meshes_of_skin;
  std::map<std::size_t, bool> has_wood;
  for (std::size_t m = 0; m < plant.meshes.size(); ++m) {
    const MeshSource& from = plant.source->meshes[m];
    const std::string who = document.label("meshes", "mesh", from.mesh);
    const auto skin = readIndex(document, document.list("nodes")[from.node], "skin", "skins", who);
    const Json& primitive =
        (*member(document.list("meshes")[from.mesh], "primitives"))[from.primitive];
    const Json& attributes = *member(primitive, "attributes");
    if (!skin || member(attributes, "JOINTS_0") == nullptr ||
        plant.meshes[m].positions.size() != from.vertices_per_instance)
      continue;
    meshes_of_skin[*skin][m] = jointsOfVertices(document, from, attributes, who);
    has_wood[*skin] = has_wood[*skin] || plant.meshes[m].kind == PartKind::kWood;
  }
  if (meshes_of_skin.empty()) return result;
  const GltfScene scene = readScene(document);
  SkinReader reader(plant, document, scene);
  for (const auto& [skin, meshes] : meshes_of_skin)
    if (has_wood[skin]) reader.read(skin, meshes, result);
  return result;
}

}  // namespace verdure
