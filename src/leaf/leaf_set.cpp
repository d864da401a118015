#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>

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

/// Fills all maps of `out` from those of the leaves: make(map of a leaf by its number, value where
/// there is no leaf) gives one.
template <typename Make>
void makeMaps(LeafSet& out, std::span<const LeafSet> leaves, const Make& make) {
  for (const auto side : {&LeafSet::front, &LeafSet::back}) {
    const auto of = [&leaves, side](const auto map) {
      return [&leaves, side, map ](std::size_t k) -> const auto& {
        return (leaves[k].*side).*map;
      };
    };
    LeafSide& filled = out.*side;
    filled.albedo = make(of(&LeafSide::albedo), glm::vec3(0.0f));
    filled.translucency = make(of(&LeafSide::translucency), glm::vec3(0.0f));
    filled.normal = make(of(&LeafSide::normal), glm::vec3(0, 0, 1));
    filled.relief_mm = make(of(&LeafSide::relief_mm), 0.0f);
  }
  const auto of = [&leaves](const auto map) {
    return [&leaves, map ](std::size_t k) -> const auto& {
      return leaves[k].*map;
    };
  };
  out.thickness_mm = make(of(&LeafSet::thickness_mm), 0.0f);
  out.opacity = make(of(&LeafSet::opacity), 0.0f);
}

/// Copies a rectangle of a map into another.
template <typename T>
void copyTexels(const std::vector<T>& from, int from_width, int x0, int y0, int width, int height,
                std::vector<T>& to, int to_width, int to_x, int to_y) {
  for (int y = 0; y < height; ++y)
    std::copy_n(from.begin() + std::ptrdiff_t{y0 + y} * from_width + x0, width,
                to.begin() + std::ptrdiff_t{to_y + y} * to_width + to_x);
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

LeafSet cropLeaf(const LeafSet& set, int x, int y, int width, int height) {
  checkLeafSet(set, set.name);
  if (width < 1 || height < 1 || x < 0 || y < 0 || x > set.width - width || y > set.height - height)
    throw Error(set.name,
                fmt::format("{} x {} texels at ({}, {}) are not within its {} x {}", width, height,
                            x, y, set.width, set.height),
                "crop a part of the leaf");
  LeafSet out;
  out.name = set.name;
  out.width = width;
  out.height = height;
  out.mm_per_texel = set.mm_per_texel;
  out.optics = set.optics;
  out.notes = set.notes;
  makeMaps(out, {&set, 1}, [&](const auto& map_of, const auto& empty) {
    std::vector<std::decay_t<decltype(empty)>> map(out.texelCount());
    copyTexels(map_of(0), set.width, x, y, width, height, map, width, 0, 0);
    return map;
  });
  return out;
}

LeafSet tileLeaves(std::span<const LeafSet> leaves, int columns) {
  const std::string where = "an atlas of leaves";
  if (leaves.empty() || columns < 1) throw Error(where, "has no leaves", "give it at least one");
  for (const LeafSet& leaf : leaves) {
    checkLeafSet(leaf, leaf.name);
    if (leaf.width != leaves[0].width || leaf.height != leaves[0].height ||
        leaf.mm_per_texel != leaves[0].mm_per_texel)
      throw Error(where, "has leaves of different sizes or scales", "give them one of each");
  }
  const int rows = (static_cast<int>(leaves.size()) + columns - 1) / columns;
  LeafSet atlas;
  atlas.name = leaves[0].name;
  atlas.width = columns * leaves[0].width;
  atlas.height = rows * leaves[0].height;
  atlas.mm_per_texel = leaves[0].mm_per_texel;
  atlas.optics = leaves[0].optics;
  makeMaps(atlas, leaves, [&](const auto& map_of, const auto& empty) {
    std::vector<std::decay_t<decltype(empty)>> map(atlas.texelCount(), empty);
    for (std::size_t k = 0; k < leaves.size(); ++k)
      copyTexels(map_of(k), leaves[0].width, 0, 0, leaves[0].width, leaves[0].height, map,
                 atlas.width, static_cast<int>(k) % columns * leaves[0].width,
                 static_cast<int>(k) / columns * leaves[0].height);
    return map;
  });
  return atlas;
}

}  // namespace verdure
