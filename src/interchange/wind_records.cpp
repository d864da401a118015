#include "interchange/wind_records.h"

#include <fmt/format.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "plant/gltf_document.h"

namespace verdure {
namespace {

/// The digits that a float has.
double digits(float v) {
  return std::strtod(fmt::format("{:.8g}", v).c_str(), nullptr);
}

Json numbers(const glm::vec3& v) {
  return {digits(v.x), digits(v.y), digits(v.z)};
}

}  // namespace

std::string windRecords(const Plant& plant, const PlantMotion& motion,
                        const WindQuantities& quantities) {
  const bool leafless = plant.leaves.empty();
  Json json = {
      {"format", "verdure wind 1"},
      {"generator", gltfGenerator()},
      {"plant", plant.name},
      {"coordinates", "metres, +Y up, as in the file's scene less origin_m"},
      {"origin_m", {plant.origin.x, plant.origin.y, plant.origin.z}},
      {"provenance",
       {{"parent", "the plant's branches; below level 3 merged into the branch that carries them"},
        {"place", "measured: share of the parent's length at which it leaves"},
        {"root_m", "measured"},
        {"axis", "measured: from root to tip"},
        {"across", "chosen: any direction across the axis; the other is cross(axis, across)"},
        {"length_m", "measured: from root to tip, straight"},
        {"root_radius_m", "measured"},
        {"tip_radius_m", "measured"},
        {"bend_c2, bend_c4",
         "computed: deflection c2 x^2 + c4 x^4 of a tapered cantilever under an even load, Habel "
         "2009, (4.7), (4.8)"},
        {"mass_kg", "computed: wood 900 kg/m^3, leaves 0.2 kg/m^2, of all that it carries"},
        {"frequency_hz", leafless
                             ? "computed: 2.5 * 2.55 length_m^-0.59, Habel 2009, (4.20), "
                               "without leaves, at most 15"
                             : "computed: 2.55 length_m^-0.59, Habel 2009, (4.20), at most 15"},
        {"damping_ratio", "chosen: by level"},
        {"gain_mean_per_m2s2",
         "computed: the tip's deflection downwind in lengths, by drag 0.3, times the wind's speed "
         "squared in m/s"},
        {"gain_swing_per_m2s2",
         "computed: root mean square of the tip's swinging, along each direction across, likewise"},
        {"phase", "chosen: a hash; as _LEAF_PHASE and vertex colours have it for wood"}}},
      {"largest_deflection_m_at_1_m_s",
       {{"trunk", digits(quantities.largest().tree)},
        {"branches", digits(quantities.largest().branch)},
        {"all", digits(quantities.largest().sway)}}},
      {"leaves", motion.leaves.size()},
      {"notes", plant.notes}};
  std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace);
  text.resize(text.rfind('}') - 1);
  text += ",\n  \"branches\": [";
  for (std::size_t b = 0; b < motion.tree.branches.size(); ++b) {
    const MotionBranch& branch = motion.tree.branches[b];
    const BranchMotion& swing = motion.branches[b];
    const Json parent = branch.parent == kNone ? Json(nullptr) : Json(branch.parent);
    const Json record = {{"branch", b},
                         {"parent", parent},
                         {"level", branch.level},
                         {"place", digits(branch.place)},
                         {"root_m", numbers(branch.root)},
                         {"axis", numbers(branch.t)},
                         {"across", numbers(branch.r)},
                         {"length_m", digits(branch.length)},
                         {"root_radius_m", digits(branch.root_radius)},
                         {"tip_radius_m", digits(branch.tip_radius)},
                         {"bend_c2", digits(branch.fit.x)},
                         {"bend_c4", digits(branch.fit.y)},
                         {"mass_kg", digits(swing.mass_kg)},
                         {"frequency_hz", digits(swing.frequency_hz)},
                         {"damping_ratio", digits(swing.damping_ratio)},
                         {"gain_mean_per_m2s2", digits(swing.mean)},
                         {"gain_swing_per_m2s2", digits(swing.swing)},
                         {"phase", quantities.phaseOf(static_cast<std::uint32_t>(b))}};
    text += (b == 0 ? "\n    " : ",\n    ") + record.dump();
  }
  return text + "\n  ]\n}\n";
}

}  // namespace verdure
