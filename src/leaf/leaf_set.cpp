#include <fmt/format.h>

#include <cmath>
#include <string>

#include "verdure/error.h"
#include "verdure/leaf.h"

namespace verdure {
namespace {

/// Checks one map: its size, and that `good` holds for each texel of it.
template <typename T, typename Good>
void checkMap(const LeafSet& set, const std::vector<T>& map, const char* name, const char* range,
              Good good, const std::string& where) {
  if (map.size() != set.texelCount())
    throw Error(where,
                fmt::format("the map {} has {} texels, the leaf {} x {}", name, map.size(),
                            set.width, set.height),
                "give all maps the same size");
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (good(map[i])) continue;
    const auto width = static_cast<std::size_t>(set.width);
    throw Error(where,
                fmt::format("the map {} is not {} at ({}, {})", name, range, i % width, i / width),
                "mend that map");
  }
}

}  // namespace

void checkLeafSet(const LeafSet& set, const std::string& where) {
  if (set.width < 1 || set.height < 1)
    throw Error(where, "the leaf has no texels", "give it maps of at least 1 x 1");
  if (!(set.mm_per_texel > 0) || !std::isfinite(set.mm_per_texel))
    throw Error(where, "its scale is unknown", "say how many millimetres a texel is wide");
  const LeafOptics& o = set.optics;
  const auto check = [&where](bool good, const char* name, float value, const char* range) {
    if (!good)
      throw Error(where, fmt::format("{} is {:g}", name, value), fmt::format("give {}", range));
  };
  check(o.scattering_per_mm > 0 && std::isfinite(o.scattering_per_mm), "scattering_per_mm",
        o.scattering_per_mm, "a number above 0");
  check(o.absorption_per_mm > 0 && std::isfinite(o.absorption_per_mm), "absorption_per_mm",
        o.absorption_per_mm, "a number above 0");
  check(o.anisotropy > -1 && o.anisotropy < 1, "anisotropy", o.anisotropy, "a number in (-1, 1)");
  check(o.refractive_index >= 1 && o.refractive_index < 4, "refractive_index", o.refractive_index,
        "a number in [1, 4)");
  const auto unit = [](float v) { return v >= 0 && v <= 1; };
  const auto color = [&](const glm::vec3& v) { return unit(v.x) && unit(v.y) && unit(v.z); };
  const auto normal = [](const glm::vec3& v) {
    return std::abs(glm::dot(v, v) - 1) < 1e-3f && v.z >= 0;
  };
  const auto finite = [](float v) { return std::isfinite(v); };
  for (const bool front : {true, false}) {
    const LeafSide& side = front ? set.front : set.back;
    const std::string which = front ? "front_" : "back_";
    checkMap(set, side.albedo, (which + "albedo").c_str(), "in [0, 1]", color, where);
    checkMap(set, side.translucency, (which + "translucency").c_str(), "in [0, 1]", color, where);
    checkMap(set, side.normal, (which + "normal").c_str(), "a unit vector out of its side", normal,
             where);
    checkMap(set, side.relief_mm, (which + "relief").c_str(), "finite", finite, where);
  }
  checkMap(set, set.opacity, "opacity", "in [0, 1]", unit, where);
  checkMap(
      set, set.thickness_mm, "thickness", "finite and at least 0",
      [](float v) { return v >= 0 && std::isfinite(v); }, where);
  for (std::size_t i = 0; i < set.thickness_mm.size(); ++i)
    if (set.opacity[i] > 0.5f && !(set.thickness_mm[i] > 0))
      throw Error(where, "the leaf is 0 mm thick somewhere", "mend its thickness map");
}

}  // namespace verdure
