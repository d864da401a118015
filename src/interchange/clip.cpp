#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "base/parallel.h"
#include "interchange/clip_joints.h"
#include "interchange/document_files.h"
#include "plant/gltf_accessor.h"
#include "plant/gltf_attributes.h"
#include "plant/gltf_export.h"
#include "plant/gltf_scene.h"

namespace verdure {
namespace {

constexpr double kFadeShare = 0.25;  ///< of the loop, at its end

/// movePlant()'s amplitudes from 0 seconds on; at the end they fade into those before 0, so that
/// the loop closes in place and velocity.
std::vector<glm::vec2> loopAmplitudes(const PlantMotion& motion, const Wind& wind, double seconds,
                                      double t) {
  std::vector<glm::vec2> amplitudes = branchAmplitudes(motion, wind, t);
  const double begin = (1.0 - kFadeShare) * seconds;
  if (t <= begin) return amplitudes;
  const double x = std::min((t - begin) / (seconds - begin), 1.0);
  const auto share = static_cast<float>(x * x * (3.0 - 2.0 * x));
  const std::vector<glm::vec2> before = branchAmplitudes(motion, wind, t - seconds);
  for (std::size_t b = 0; b < amplitudes.size(); ++b)
    amplitudes[b] = glm::mix(amplitudes[b], before[b], share);
  return amplitudes;
}

/// Turn and translation of a joint in its parent's coordinates.
struct JointPose {
  glm::quat turn{1, 0, 0, 0};
  glm::vec3 translation{0.0f};
};

using ClipFrame = std::vector<JointPose>;

ClipFrame localPoses(const ClipJoints& joints, const std::vector<glm::dmat4>& poses) {
  ClipFrame frame(poses.size());
  for (std::size_t j = 1; j < poses.size(); ++j) {
    const glm::dmat4 local = glm::inverse(poses[joints.joints[j].parent]) * poses[j];
    frame[j] = {glm::quat(glm::normalize(glm::quat_cast(glm::dmat3(local)))), glm::vec3(local[3])};
  }
  return frame;
}

void checkOptions(const ClipOptions& options, const Plant& plant,
                  const std::filesystem::path& path) {
  const auto need = [](bool ok, const char* option, const char* range) {
    if (!ok) throw Error(option, "is out of range", std::string("choose ") + range);
  };
  need(options.seconds >= 0.5 && options.seconds <= 60.0, "seconds of the clip", "0.5 to 60");
  need(options.fps >= 5.0 && options.fps <= 120.0, "frames a second of the clip", "5 to 120");
  need(options.joints >= 8 && options.joints <= 4096, "joints of the clip", "8 to 4096");
  checkWind(options.wind);
  checkPlantPath(path);
  if (!matchesSource(plant)) return;
  const GltfDocument& document = plant.source->gltf;
  if (!document.list("animations").empty())
    throw Error(path.string(), "the plant's file has animations of its own",
                "export the plant without them");
  for (const Json& node : document.list("nodes")) {
    if (extension(node, "EXT_mesh_gpu_instancing") != nullptr)
      throw Error(path.string(), "the plant's file has instances, a skin moves one plant",
                  "export a single plant");
    if (member(node, "skin") != nullptr)
      throw Error(path.string(), "the plant's file has a skin of its own",
                  "export the plant without it");
  }
}

class ClipWriter {
 public:
  ClipWriter(const Plant& plant, const PlantMotion& motion, const ClipJoints& joints,
             const ClipOptions& options, ClipFiles& report)
      : plant_(plant), motion_(motion), joints_(joints), options_(options), report_(report) {
    frames_ = std::max<std::size_t>(
        static_cast<std::size_t>(std::lround(options.seconds * options.fps)), 2);
    seconds_ = static_cast<double>(frames_) / options.fps;
  }

  GltfDocument document() {
    document_ = documentWith(plant_, weights());
    addJoints();
    addSkins();
    sampleClip();
    addAnimation();
    return std::move(document_);
  }

  /// Measures what the clip shows between its frames against movePlant().
  void measure() {
    double wood = 0.0, leaf = 0.0, way = 0.0;
    std::size_t wood_count = 0, leaf_count = 0;
    constexpr int kMoments = 5;
    for (int i = 0; i < kMoments; ++i) {
      // Half-way between two frames, ahead of the fade.
      const auto frame = static_cast<std::size_t>((1.0 - kFadeShare) * (i + 0.5) / kMoments *
                                                  static_cast<double>(frames_));
      const double t = (static_cast<double>(frame) + 0.5) / options_.fps;
      if (t > (1.0 - kFadeShare) * seconds_) continue;
      Plant moved = plant_;
      movePlant(motion_, options_.wind, t, {}, moved);
      const std::vector<glm::mat4> matrices = skinMatrices(frame, 0.5f);
      for (std::size_t m = 0; m < plant_.meshes.size(); ++m) {
        const Mesh& rest = plant_.meshes[m];
        for (std::size_t v = 0; v < rest.positions.size(); ++v) {
          const VertexMotion& hung = motion_.tree.meshes[m][v];
          const JointWeights w = weightsOf(joints_, motion_.tree, hung);
          const glm::vec4 p(rest.positions[v], 1.0f);
          const glm::vec3 shown(glm::mix(matrices[w.low] * p, matrices[w.high] * p, w.share));
          const double error = double{glm::length(shown - moved.meshes[m].positions[v])};
          const double from_rest =
              double{glm::length(moved.meshes[m].positions[v] - rest.positions[v])};
          way += from_rest * from_rest;
          report_.largest = std::max(report_.largest, error);
          (hung.leaf == kNone ? wood : leaf) += error * error;
          ++(hung.leaf == kNone ? wood_count : leaf_count);
        }
      }
    }
    const auto rms = [](double sum, std::size_t count) {
      return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0.0;
    };
    report_.wood_rms = rms(wood, wood_count);
    report_.leaf_rms = rms(leaf, leaf_count);
    report_.motion_rms = rms(way, wood_count + leaf_count);
  }

  std::size_t frames() const { return frames_; }

 private:
  std::vector<VertexAttribute> weights() const {
    const auto of = [this](std::size_t m, std::size_t v) {
      return weightsOf(joints_, motion_.tree, motion_.tree.meshes[m][v]);
    };
    std::vector<VertexAttribute> attributes;
    // A joint without weight is number 0.
    attributes.push_back({"JOINTS_0",
                          4,
                          Stored::kIndices,
                          false,
                          glm::vec4(0.0f),
                          {},
                          [of](std::size_t m, std::size_t v, const glm::dmat4&) {
                            const JointWeights w = of(m, v);
                            return glm::vec4(w.share < 1.0f ? static_cast<float>(w.low) : 0.0f,
                                             w.share > 0.0f ? static_cast<float>(w.high) : 0.0f,
                                             0.0f, 0.0f);
                          }});
    attributes.push_back({"WEIGHTS_0",
                          4,
                          Stored::kFloats,
                          false,
                          glm::vec4(1, 0, 0, 0),
                          {},
                          [of](std::size_t m, std::size_t v, const glm::dmat4&) {
                            const float share = of(m, v).share;
                            return glm::vec4(1.0f - share, share, 0.0f, 0.0f);
                          }});
    return attributes;
  }

  Json& nodes() { return document_.json["nodes"]; }
  Json& rootNodes() {
    const std::size_t scene = document_.json.value("scene", std::size_t{0});
    return document_.json["scenes"][scene]["nodes"];
  }

  void addJoints() {
    if (!document_.json.contains("scenes"))
      throw Error(document_.where, "the file has no scene", "export the plant's scene");
    first_node_ = nodes().size();
    for (std::size_t j = 0; j < joints_.joints.size(); ++j) {
      const ClipJoint& joint = joints_.joints[j];
      Json node = {{"name", "wind"}};
      glm::dvec3 at = plant_.origin;
      if (j > 0) {
        node["name"] = fmt::format("wind {} {:.2f}", joint.branch, joint.place);
        at = glm::dvec3(joint.pivot - joints_.joints[joint.parent].pivot);
        nodes()[first_node_ + joint.parent]["children"].push_back(first_node_ + j);
      }
      node["translation"] = {at.x, at.y, at.z};
      nodes().push_back(std::move(node));
    }
    rootNodes().push_back(first_node_);
  }

  /// A skin for each node with a mesh, because what takes the mesh to its joints holds the node's
  /// transform. The mesh goes to a node of its own at the scene's root: skins make transforms above
  /// void, and the old node may have other children.
  void addSkins() {
    const GltfScene scene = readScene(document_);
    Json joint_nodes = Json::array();
    for (std::size_t j = 0; j < joints_.joints.size(); ++j) joint_nodes.push_back(first_node_ + j);
    for (const std::size_t index : scene.mesh_nodes) {
      glm::dmat4 plant_from_local = scene.world_from_node[index];
      plant_from_local[3] -= glm::dvec4(plant_.origin, 0.0);
      std::vector<glm::mat4> binds;
      for (const ClipJoint& joint : joints_.joints) {
        glm::dmat4 bind = plant_from_local;
        bind[3] -= glm::dvec4(glm::dvec3(joint.pivot), 0.0);
        binds.emplace_back(bind);
      }
      document_.json["skins"].push_back({{"name", "wind"},
                                         {"skeleton", first_node_},
                                         {"joints", joint_nodes},
                                         {"inverseBindMatrices", addAccessor(binds, "MAT4")}});
      Json shown = {{"mesh", nodes()[index]["mesh"]}, {"skin", document_.json["skins"].size() - 1}};
      for (const char* key : {"name", "weights"})
        if (member(nodes()[index], key) != nullptr) shown[key] = nodes()[index][key];
      nodes()[index].erase("mesh");
      nodes()[index].erase("weights");
      rootNodes().push_back(nodes().size());
      nodes().push_back(std::move(shown));
    }
  }

  template <class T>
  std::size_t addAccessor(const std::vector<T>& values, const char* type) {
    Json& accessors = document_.json["accessors"];
    accessors.push_back({{"bufferView", appendView(document_, bytesOf(values), 0, 0)},
                         {"componentType", kFloat},
                         {"count", values.size()},
                         {"type", type}});
    return accessors.size() - 1;
  }

  void sampleClip() {
    clip_.clear();
    for (std::size_t i = 0; i < frames_; ++i)
      clip_.push_back(
          localPoses(joints_, poseJoints(joints_, motion_.tree,
                                         loopAmplitudes(motion_, options_.wind, seconds_,
                                                        static_cast<double>(i) / options_.fps))));
    clip_.push_back(clip_.front());
    // The shorter way from frame to frame.
    for (std::size_t i = 1; i < clip_.size(); ++i)
      for (std::size_t j = 0; j < joints_.joints.size(); ++j)
        if (glm::dot(clip_[i][j].turn, clip_[i - 1][j].turn) < 0.0f)
          clip_[i][j].turn = -clip_[i][j].turn;
  }

  void addAnimation() {
    std::vector<float> times;
    for (std::size_t i = 0; i <= frames_; ++i)
      times.push_back(static_cast<float>(static_cast<double>(i) / options_.fps));
    const std::size_t input = addAccessor(times, "SCALAR");
    document_.json["accessors"][input]["min"] = {times.front()};
    document_.json["accessors"][input]["max"] = {times.back()};
    Json samplers = Json::array(), channels = Json::array();
    const auto add = [&](std::size_t joint, const char* path, std::size_t output) {
      channels.push_back({{"sampler", samplers.size()},
                          {"target", {{"node", first_node_ + joint}, {"path", path}}}});
      samplers.push_back({{"input", input}, {"interpolation", "LINEAR"}, {"output", output}});
    };
    for (std::size_t j = 1; j < joints_.joints.size(); ++j) {
      std::vector<glm::vec4> turns;
      std::vector<glm::vec3> translations;
      for (const ClipFrame& frame : clip_) {
        const glm::quat& q = frame[j].turn;
        turns.emplace_back(q.x, q.y, q.z, q.w);
        translations.push_back(frame[j].translation);
      }
      add(j, "rotation", addAccessor(turns, "VEC4"));
      add(j, "translation", addAccessor(translations, "VEC3"));
    }
    if (channels.empty()) return;
    document_.json["animations"].push_back(
        {{"name", "wind"}, {"samplers", std::move(samplers)}, {"channels", std::move(channels)}});
  }

  /// From the plant at rest to the plant `share` of the way from a frame to the next.
  std::vector<glm::mat4> skinMatrices(std::size_t frame, float share) const {
    std::vector<glm::mat4> poses, matrices;
    for (std::size_t j = 0; j < joints_.joints.size(); ++j) {
      const JointPose &a = clip_[frame][j], &b = clip_[frame + 1][j];
      glm::mat4 local = glm::mat4_cast(glm::slerp(a.turn, b.turn, share));
      local[3] = glm::vec4(glm::mix(a.translation, b.translation, share), 1.0f);
      poses.push_back(j == 0 ? local : poses[joints_.joints[j].parent] * local);
      glm::mat4 bind(1.0f);
      bind[3] = glm::vec4(-joints_.joints[j].pivot, 1.0f);
      matrices.push_back(poses[j] * bind);
    }
    return matrices;
  }

  const Plant& plant_;
  const PlantMotion& motion_;
  const ClipJoints& joints_;
  const ClipOptions& options_;
  ClipFiles& report_;
  std::size_t frames_ = 0, first_node_ = 0;
  double seconds_ = 0.0;
  GltfDocument document_;
  std::vector<ClipFrame> clip_;
};

}  // namespace

ClipFiles exportClip(const Plant& plant, const PlantMotion& motion, const ClipOptions& options,
                     const std::filesystem::path& path) {
  checkOptions(options, plant, path);
  const ClipJoints joints = chooseJoints(plant, motion, static_cast<std::size_t>(options.joints));
  ClipFiles report;
  report.branches = motion.tree.branches.size();
  report.leaves = motion.leaves.size();
  report.joints = joints.joints.size();
  report.bent_branches = joints.bent_branches;
  report.attributes = {"JOINTS_0", "WEIGHTS_0"};
  ClipWriter writer(plant, motion, joints, options, report);
  GltfDocument document = writer.document();
  report.frames = writer.frames();
  writer.measure();
  writeAll(std::move(document), path, {}, report);
  return report;
}

}  // namespace verdure
