#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/packing.hpp>

#include "base/check.h"
#include "base/random.h"
#include "motion/motion_tables.h"
#include "motion/motion_texture.h"
#include "verdure/error.h"

namespace verdure {
namespace {

// Air, wood that is alive, leaves.
constexpr double kAirDensity = 1.2;      // kg/m^3
constexpr double kWoodDensity = 900.0;   // kg/m^3
constexpr double kLeafMass = 0.2;        // kg/m^2, one side
constexpr double kDrag = 0.3;            // of crowns, which give way: 0.2 to 0.5 in the literature
constexpr double kCrownShare = 0.3;      // frontal area of what a branch carries, by its length^2
constexpr double kLeafProjection = 0.5;  // mean of a leaf's area, seen from the wind
// An even load moves the tip of a beam by 1.6 of what it would move its mass on a spring of the
// same resonance: 0.39 of the load and 0.24 of the mass count (first mode of a cantilever).
constexpr double kTipByMode = 1.6;
constexpr double kTurbulence = 0.3;  // root mean square of the wind by its mean
// Leaves, for wind of 1 m/s: tangents of half the angles.
constexpr float kLeafFlutter = 0.0040f, kLeafTwist = 0.0055f, kLeafLean = 0.0035f;
constexpr float kLeafVariation = 0.4f;
// Cards that are longer stand for twigs, whose leaves turn about stalks of their own.
constexpr float kLongestLeaf = 0.15f;  // m
// Twigs of a few centimetres would tremble faster than any film shows.
constexpr double kMostFrequency = 15.0;  // Hz
constexpr double kWavesPerLeaf = 4.0;    // the smallest eddy, in leaves
constexpr int kWindSize = 512;

double frequencyOf(double length, bool leafless) {
  return std::min(branchFrequency(length, leafless), kMostFrequency);
}

/// Root mean square of the response to turbulence, by what a spring without mass would do.
double amplification(const BranchOscillator& branch) {
  double wind = 0.0, response = 0.0;
  const double fh = branch.frequency_hz;
  const double stiffness = 4.0 * glm::pi<double>() * glm::pi<double>() * fh * fh;
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i) {
    const double f = 2.0 * fh * (i + 0.5) / kSteps;  // as far as textures go
    const double x = branchResponse(branch, f) * stiffness;
    wind += windPower(f, branch.wind_speed);
    response += x * x;
  }
  return std::sqrt(response / wind);
}

BranchMotion motionOf(const MotionBranch& branch, const MotionOptions& options, bool leafless) {
  BranchMotion motion;
  const double length = double{branch.length}, leaves = double{branch.leaf_m2};
  motion.frequency_hz = static_cast<float>(frequencyOf(length, leafless));
  motion.damping_ratio = options.damping_ratio[static_cast<std::size_t>(branch.level)];
  const double mass = std::max(kWoodDensity * double{branch.wood_m3} + kLeafMass * leaves, 1e-6);
  motion.mass_kg = static_cast<float>(mass);
  // Leaves shelter each other: of their crown they fill what Beer's law says.
  const double crown = kCrownShare * length * length;
  const double area = crown * -std::expm1(-kLeafProjection * leaves / crown) +
                      length * double{branch.root_radius + branch.tip_radius};
  const double omega = 2.0 * glm::pi<double>() * double{motion.frequency_hz};
  const double force = 0.5 * kAirDensity * kDrag * area;
  const double deflection =
      double{options.flexibility} * kTipByMode * force / (mass * omega * omega * length);
  motion.mean = static_cast<float>(deflection);
  // The force goes as the speed's square, so it varies by twice the turbulence.
  motion.swing =
      static_cast<float>(deflection * 2.0 * kTurbulence *
                         amplification({double{motion.frequency_hz}, double{motion.damping_ratio},
                                        double{options.spectrum_speed}}));
  return motion;
}

std::vector<LeafMotion> leafMotions(const Plant& plant, const MotionTree& tree) {
  std::vector<LeafMotion> all;
  for (const Leaf& leaf : plant.leaves) {
    LeafMotion motion;
    motion.stalk = leaf.stalk;
    const Mesh& mesh = plant.meshes[leaf.mesh];
    const auto corner = [&](std::uint32_t k, std::size_t c) {
      return mesh.indices[3 * std::size_t{plant.leaf_triangles[leaf.first_triangle + k]} + c];
    };
    glm::vec3 normal(0.0f);
    for (std::uint32_t k = 0; k < leaf.triangle_count; ++k) {
      const glm::vec3 a = mesh.positions[corner(k, 0)], b = mesh.positions[corner(k, 1)],
                      c = mesh.positions[corner(k, 2)];
      glm::vec3 n = glm::cross(b - a, c - a);
      if (glm::dot(n, normal) < 0.0f) n = -n;  // sheets back to back
      normal += n;
      for (const glm::vec3& p : {a, b, c})
        motion.reach = std::max(motion.reach, glm::length(p - leaf.stalk));
    }
    const VertexMotion& hung = tree.meshes[leaf.mesh][corner(0, 0)];
    motion.branch = hung.branch;
    if (hung.branch != kNone) motion.place = hung.places[tree.branches[hung.branch].level];
    const glm::vec3 way = leaf.centroid - leaf.stalk;
    if (glm::length(way) > 1e-6f) motion.axis = glm::normalize(way);
    normal -= glm::dot(normal, motion.axis) * motion.axis;
    if (!(glm::length(normal) > 1e-12f)) {
      const glm::vec3 any =
          std::abs(motion.axis.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
      normal = glm::cross(glm::cross(motion.axis, any), motion.axis);
    }
    motion.normal = glm::normalize(normal);
    all.push_back(motion);
  }
  return all;
}

PackedMotionTexture packed(const MotionTexture& texture) {
  PackedMotionTexture out;
  out.size = {static_cast<std::uint32_t>(texture.width),
              static_cast<std::uint32_t>(texture.height)};
  out.texels.resize(std::size_t{out.size.x} * out.size.y);
  float longest = 0.0f;
  for (std::size_t i = 0; i < out.texels.size(); ++i) {
    out.texels[i] = glm::packHalf2x16({texture.values[2 * i], texture.values[2 * i + 1]});
    const glm::vec2 value = glm::unpackHalf2x16(out.texels[i]);
    longest = std::max(longest, glm::dot(value, value));
  }
  out.farthest = std::sqrt(longest);
  return out;
}

class TableBuilder {
 public:
  TableBuilder(const Plant& plant, const PlantMotion& motion, const MotionOptions& options)
      : plant_(plant), motion_(motion), options_(options) {}

  MotionTables build() {
    addBeams();
    addDrives();
    addLeaves();
    addVertices();
    return std::move(out_);
  }

 private:
  void addBeams() {
    for (const MotionBranch& branch : motion_.tree.branches) {
      shared::MotionBeam beam{branch.root,
                              branch.length,
                              branch.t,
                              branch.fit.x,
                              branch.r,
                              branch.fit.y,
                              glm::uvec4(shared::kHangsOnNothing),
                              glm::vec4(0.0f)};
      if (branch.parent != kNone) {
        const shared::MotionBeam& parent = out_.beams[branch.parent];
        beam.carriers = {branch.parent, parent.carriers.x, parent.carriers.y, parent.carriers.z};
        beam.places = {branch.place, parent.places.x, parent.places.y, parent.places.z};
      }
      out_.beams.push_back(beam);
    }
  }

  /// Levels of one damping ratio share their textures, as many as they are. A branch that reads a
  /// texture of another resonance scales the wind's spectrum with it, so textures are spread evenly
  /// over the slope of (4.15) at the branches' resonances, and a branch reads the nearest one.
  void addDrives() {
    out_.drives.resize(motion_.branches.size());
    out_.farthest.resize(motion_.branches.size());
    std::array<bool, kMotionLevels> done{};
    for (std::size_t level = 0; level < kMotionLevels; ++level) {
      if (done[level]) continue;
      const float damping = options_.damping_ratio[level];
      std::size_t levels = 0;
      std::vector<std::uint32_t> members;
      for (std::size_t other = level; other < kMotionLevels; ++other) {
        if (options_.damping_ratio[other] != damping) continue;
        done[other] = true;
        const std::size_t before = members.size();
        for (std::uint32_t b = 0; b < motion_.branches.size(); ++b)
          if (motion_.tree.branches[b].level == static_cast<int>(other)) members.push_back(b);
        levels += members.size() > before ? 1 : 0;
      }
      if (!members.empty()) addTextures(members, double{damping}, levels);
    }
  }

  void addTextures(const std::vector<std::uint32_t>& members, double damping, std::size_t count) {
    // The slope without its 5/3, [0, 1).
    const double speed = double{options_.spectrum_speed};
    const auto slopeOf = [&](std::uint32_t b) {
      const double frequency = double{motion_.branches[b].frequency_hz};
      return frequency / (frequency + speed);
    };
    double low = 1.0, high = 0.0;
    for (const std::uint32_t b : members) {
      low = std::min(low, slopeOf(b));
      high = std::max(high, slopeOf(b));
    }
    const double step = (high - low) / static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<std::uint32_t> near;
      for (const std::uint32_t b : members) {
        const auto nearest =
            step > 0.0 ? std::min(static_cast<std::size_t>((slopeOf(b) - low) / step), count - 1)
                       : 0;
        if (nearest == i) near.push_back(b);
      }
      if (near.empty()) continue;
      const double slope = low + (static_cast<double>(i) + 0.5) * step;
      addTexture(near, {speed * slope / (1.0 - slope), damping, speed});
    }
  }

  void addTexture(const std::vector<std::uint32_t>& members, const BranchOscillator& typical) {
    MotionTextureOptions size;
    size.width = options_.texture_width;
    size.height = options_.texture_height;
    size.seed = hash(options_.seed) + out_.texels.size();
    size.layout = options_.thesis_textures ? MotionLayout::kRadial : MotionLayout::kSeparable;
    const MotionTexture texture = makeMotionTexture(typical, size);
    const auto first = static_cast<std::uint32_t>(out_.texels.size());
    const PackedMotionTexture halves = packed(texture);
    out_.texels.insert(out_.texels.end(), halves.texels.begin(), halves.texels.end());
    for (const std::uint32_t b : members) {
      const BranchMotion& motion = motion_.branches[b];
      out_.farthest[b] = halves.farthest;
      out_.drives[b] = {
          makeTrajectory(texture, double{motion.frequency_hz}, hash(options_.seed + 1) + b), first,
          halves.size.x | halves.size.y << 16, motion.mean, motion.swing};
    }
  }

  void addLeaves() {
    float longest = 0.0f;
    for (std::size_t i = 0; i < motion_.leaves.size(); ++i) {
      const LeafMotion& leaf = motion_.leaves[i];
      longest = std::max(longest, leaf.reach);
      Random random(hash(options_.seed + 2), i);
      const float stiff = std::max(leaf.reach, kLongestLeaf) / kLongestLeaf;
      const float flexible = options_.flexibility * (1.0f + random.vary(kLeafVariation)) / stiff;
      out_.leaves.push_back({leaf.stalk, leaf.place, leaf.axis, leaf.branch, leaf.normal,
                             flexible * kLeafFlutter, flexible * kLeafLean, flexible * kLeafTwist,
                             glm::uvec2(0)});
    }
    const MotionTexture texture = makeWindTexture(kWavesPerLeaf * std::max(double{longest}, 1e-3),
                                                  kWindSize, 2, hash(options_.seed + 3));
    out_.wind = packed(texture);
    out_.wind_extent = static_cast<float>(texture.extent);
  }

  void addVertices() {
    out_.loads.resize(motion_.tree.branches.size());
    for (std::size_t m = 0; m < plant_.meshes.size(); ++m) {
      const Mesh& mesh = plant_.meshes[m];
      std::vector<glm::uvec2>& hangs = out_.hangs.emplace_back();
      for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const VertexMotion& motion = motion_.tree.meshes[m][v];
        glm::uvec2 hang(shared::kHangsOnNothing);
        if (motion.branch != kNone) {
          const int level = motion_.tree.branches[motion.branch].level;
          hang = {motion.branch, std::bit_cast<std::uint32_t>(motion.places[level])};
          if (motion.leaf != kNone) hang = {shared::kHangsOnLeaf | motion.leaf, 0};
        }
        hangs.push_back(hang);
        addLoad(mesh.positions[v], motion);
      }
    }
  }

  static void grow(const glm::vec3& p, Bounds& box, bool& any) {
    box.min = any ? glm::min(box.min, p) : p;
    box.max = any ? glm::max(box.max, p) : p;
    any = true;
  }

  void addLoad(const glm::vec3& position, const VertexMotion& motion) {
    if (motion.branch == kNone) return grow(position, out_.still, out_.any_still);
    MotionTables::Load& load = out_.loads[motion.branch];
    grow(position, load.box, load.any);
    if (motion.leaf != kNone)
      load.leaf_reach = std::max(load.leaf_reach, motion_.leaves[motion.leaf].reach);
    std::size_t step = 0;
    forEachCarrier(motion_.tree, motion, [&](std::uint32_t b, float place) {
      const MotionBranch& branch = motion_.tree.branches[b];
      const glm::vec3 pivot = branch.root + branch.t * (place * branch.length);
      load.reach[step] = std::max(load.reach[step], glm::length(position - pivot));
      ++step;
    });
  }

  const Plant& plant_;
  const PlantMotion& motion_;
  const MotionOptions& options_;
  MotionTables out_;
};

}  // namespace

PlantMotion plantMotion(const Plant& plant, const MotionOptions& options) {
  const auto need = [](bool ok, const char* what, const std::string& range) {
    if (!ok) throw Error("motion", std::string(what) + " is out of range", range);
  };
  need(options.flexibility > 0.0f && options.flexibility <= 100.0f, "flexibility",
       "choose a number above 0, up to 100");
  need(options.spectrum_speed > 0.0f && std::isfinite(options.spectrum_speed), "spectrum_speed",
       "choose a number above 0");
  need(options.texture_width >= 512, "texture_width", "choose 512 to 8192");
  PlantMotion motion;
  motion.tree = motionTree(plant);
  const bool leafless = plant.leaves.empty();
  for (const MotionBranch& branch : motion.tree.branches)
    motion.branches.push_back(motionOf(branch, options, leafless));
  motion.leaves = leafMotions(plant, motion.tree);
  motion.tables =
      std::make_shared<const MotionTables>(TableBuilder(plant, motion, options).build());
  return motion;
}

}  // namespace verdure
