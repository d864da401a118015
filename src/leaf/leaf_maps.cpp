#include "leaf/leaf_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "base/parallel.h"
#include "shared/color.h"
#include "shared/leaf.h"
#include "verdure/error.h"

namespace verdure {
namespace {

/// All of a leaf that is not colour: how its two surfaces lie.
class LeafShape {
 public:
  LeafShape(LeafSet& set, const LeafMaps& maps) : set_(set), maps_(maps) {
    inside_.resize(set.texelCount());
    for (std::size_t i = 0; i < inside_.size(); ++i) inside_[i] = set.opacity[i] >= 0.5f;
  }

  void make() {
    std::vector<glm::vec2> front = makeSide(set_.front, maps_.sides[0], "front");
    const LeafSideMaps& back = maps_.sides[1];
    if (back.normal || usable(back.relief, back.relief_range_mm)) {
      makeSide(set_.back, back, "back");
      return;
    }
    // Both surfaces enclose the thickness: the back's height is what the front's leaves of it.
    const std::size_t n = set_.texelCount();
    const std::vector<glm::vec2> growth =
        slopesFromHeights(set_.thickness_mm, inside_, set_.width, set_.height, set_.mm_per_texel);
    set_.back.relief_mm.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      front[i] = growth[i] - front[i];
      set_.back.relief_mm[i] = set_.thickness_mm[i] - set_.front.relief_mm[i];
    }
    set_.back.normal = normalsOf(front);
    set_.notes.emplace_back("the back's relief and normals are the front's, mirrored");
  }

 private:
  static bool usable(const std::optional<LeafMap>& relief, const std::optional<LeafRange>& range) {
    return relief && (relief->physical || range);
  }

  /// Fills relief and normals from either; returns the slopes.
  std::vector<glm::vec2> makeSide(LeafSide& side, const LeafSideMaps& maps, const char* which) {
    std::vector<glm::vec2> slopes;
    if (maps.normal) {
      side.normal = readNormals(*maps.normal);
      slopes.resize(side.normal.size());
      // Rows run down, y up.
      for (std::size_t i = 0; i < slopes.size(); ++i)
        if (inside_[i])
          slopes[i] =
              glm::vec2(-side.normal[i].x, side.normal[i].y) / std::max(side.normal[i].z, 0.05f);
    }
    if (usable(maps.relief, maps.relief_range_mm)) {
      const LeafRange range = maps.relief_range_mm.value_or(LeafRange{0.0f, 1.0f});
      side.relief_mm.resize(set_.texelCount());
      for (std::size_t i = 0; i < side.relief_mm.size(); ++i)
        side.relief_mm[i] = range.low + (range.high - range.low) * maps.relief->color(i).x;
    } else if (maps.normal) {
      side.relief_mm = heightsFromSlopes(slopes, set_.width, set_.height, set_.mm_per_texel);
      centre(side);
      set_.notes.push_back(fmt::format("the {}'s relief comes from its normals", which));
    } else {
      side.relief_mm.resize(set_.texelCount());
      centre(side);
      set_.notes.push_back(fmt::format("no normals and no relief: the {} is even", which));
    }
    if (!maps.normal) {
      slopes =
          slopesFromHeights(side.relief_mm, inside_, set_.width, set_.height, set_.mm_per_texel);
      side.normal = normalsOf(slopes);
      if (usable(maps.relief, maps.relief_range_mm))
        set_.notes.push_back(fmt::format("the {}'s normals come from its relief", which));
    }
    return slopes;
  }

  /// Heights over the middle plane: half the thickness on the mean.
  void centre(LeafSide& side) const {
    double sum = 0, thickness = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < inside_.size(); ++i) {
      if (!inside_[i]) continue;
      sum += side.relief_mm[i];
      thickness += set_.thickness_mm[i];
      ++count;
    }
    if (count == 0) return;
    const auto shift = static_cast<float>((0.5 * thickness - sum) / static_cast<double>(count));
    for (float& height : side.relief_mm) height += shift;
  }

  static std::vector<glm::vec3> readNormals(const LeafMap& map) {
    std::vector<glm::vec3> normals(map.texelCount());
    parallelFor(normals.size(), 4096, [&](std::size_t i) {
      glm::vec3 n = map.physical ? map.color(i) : 2.0f * map.color(i) - 1.0f;
      n.z = std::max(n.z, 0.0f);
      const float length = glm::length(n);
      normals[i] = length > 1e-3f ? n / length : glm::vec3(0, 0, 1);
    });
    return normals;
  }

  static std::vector<glm::vec3> normalsOf(const std::vector<glm::vec2>& slopes) {
    std::vector<glm::vec3> normals(slopes.size());
    parallelFor(slopes.size(), 4096, [&](std::size_t i) {
      normals[i] = glm::normalize(glm::vec3(-slopes[i].x, slopes[i].y, 1));
    });
    return normals;
  }

  LeafSet& set_;
  const LeafMaps& maps_;
  std::vector<bool> inside_;
};

void checkPositive(const std::string& where, const char* what, std::optional<float> value) {
  if (value && (!(*value > 0) || !std::isfinite(*value)))
    throw Error(where, fmt::format("{} is {:g}", what, *value), "give a number above 0");
}

/// All maps must have one size; the first that is there gives it.
void findSize(LeafSet& set, const LeafMaps& maps) {
  const LeafMap* first = nullptr;
  const auto look = [&](const std::optional<LeafMap>& map) {
    if (!map) return;
    if (first == nullptr) {
      first = &*map;
    } else if (map->width != first->width || map->height != first->height) {
      throw Error(maps.where,
                  fmt::format("{} has {} x {} texels, {} {} x {}", first->where, first->width,
                              first->height, map->where, map->width, map->height),
                  "give all maps the same size");
    }
  };
  for (const LeafSideMaps& side : maps.sides)
    for (const auto* map : {&side.albedo, &side.translucency, &side.normal, &side.relief})
      look(*map);
  look(maps.thickness);
  look(maps.opacity);
  set.width = first->width;
  set.height = first->height;
}

void findScale(LeafSet& set, const LeafMaps& maps, const LeafImportOptions& options) {
  checkPositive(maps.where, "--mm-per-texel", options.mm_per_texel);
  checkPositive(maps.where, "--width-mm", options.width_mm);
  checkPositive(maps.where, "mm_per_texel", maps.mm_per_texel);
  checkPositive(maps.where, "width_mm", maps.width_mm);
  const auto of_width = [&](float mm) { return mm / static_cast<float>(set.width); };
  if (options.mm_per_texel)
    set.mm_per_texel = *options.mm_per_texel;
  else if (options.width_mm)
    set.mm_per_texel = of_width(*options.width_mm);
  else if (maps.mm_per_texel)
    set.mm_per_texel = *maps.mm_per_texel;
  else if (maps.width_mm)
    set.mm_per_texel = of_width(*maps.width_mm);
  else
    throw Error(maps.where, "nothing says how large the leaf is",
                "give the millimetres per texel (--mm-per-texel, or mm_per_texel in leaf.json)");
}

void findOpacity(LeafSet& set, const LeafMaps& maps) {
  const std::optional<LeafMap>& albedo = maps.sides[0].albedo;
  set.opacity.assign(set.texelCount(), 1.0f);
  if (maps.opacity) {
    for (std::size_t i = 0; i < set.opacity.size(); ++i)
      set.opacity[i] = glm::clamp(maps.opacity->color(i).x, 0.0f, 1.0f);
  } else if (albedo->hasAlpha()) {
    for (std::size_t i = 0; i < set.opacity.size(); ++i) set.opacity[i] = albedo->alpha(i);
  } else {
    set.notes.emplace_back("no opacity: the leaf fills its maps");
  }
  if (std::none_of(set.opacity.begin(), set.opacity.end(), [](float o) { return o >= 0.5f; }))
    throw Error(maps.where, "the opacity shows no leaf", "mend its opacity map");
}

void findThickness(LeafSet& set, const LeafMaps& maps, const LeafImportOptions& options) {
  checkPositive(maps.where, "--thickness-mm", options.thickness_mm);
  checkPositive(maps.where, "thickness_mm", maps.thickness_mm);
  set.thickness_mm.resize(set.texelCount());
  if (maps.thickness) {
    LeafRange range = maps.thickness_range_mm.value_or(LeafRange{0.0f, 1.0f});
    if (options.thickness_mm) {
      const float top = maps.thickness->physical ? *std::max_element(maps.thickness->values.begin(),
                                                                     maps.thickness->values.end())
                                                 : 1.0f;
      range = {0.0f, *options.thickness_mm / std::max(top, 1e-30f)};
    } else if (!maps.thickness->physical && !maps.thickness_range_mm) {
      throw Error(maps.thickness->where, "nothing says how many millimetres its white is",
                  "give the thickness (--thickness-mm, or thickness_range_mm in leaf.json)");
    }
    for (std::size_t i = 0; i < set.thickness_mm.size(); ++i)
      set.thickness_mm[i] = range.low + (range.high - range.low) * maps.thickness->color(i).x;
  } else {
    const std::optional<float> even =
        options.thickness_mm ? options.thickness_mm : maps.thickness_mm;
    if (!even)
      throw Error(maps.where, "nothing says how thick the leaf is",
                  "give its thickness (--thickness-mm, or thickness_mm in leaf.json)");
    std::fill(set.thickness_mm.begin(), set.thickness_mm.end(), *even);
    set.notes.push_back(fmt::format("the leaf is {:g} mm thick everywhere", *even));
  }
}

std::vector<glm::vec3> readColors(const LeafMap& map) {
  std::vector<glm::vec3> colors(map.texelCount());
  parallelFor(colors.size(), 4096, [&](std::size_t i) {
    glm::vec3 c = map.color(i);
    if (!map.physical)
      c = {shared::linearFromSrgb(c.x), shared::linearFromSrgb(c.y), shared::linearFromSrgb(c.z)};
    colors[i] = glm::clamp(c, 0.0f, 1.0f);
  });
  return colors;
}

void findColors(LeafSet& set, const LeafMaps& maps) {
  const auto& [front, back] = maps.sides;
  set.front.albedo = readColors(*front.albedo);
  if (back.albedo) {
    set.back.albedo = readColors(*back.albedo);
  } else {
    set.back.albedo = set.front.albedo;
    for (glm::vec3& c : set.back.albedo) c = glm::mix(c, glm::vec3(1), 0.1f);
    set.notes.emplace_back("the back's albedo is the front's, a tenth of the way to white");
  }
  const auto& given = front.translucency ? front.translucency : back.translucency;
  if (given) {
    set.front.translucency = readColors(*given);
    set.back.translucency = back.translucency && front.translucency ? readColors(*back.translucency)
                                                                    : set.front.translucency;
    if (!(front.translucency && back.translucency))
      set.notes.emplace_back("one translucency stands for both sides");
  } else {
    for (LeafSide* side : {&set.front, &set.back}) {
      side->translucency = side->albedo;
      for (glm::vec3& c : side->translucency) c = shared::leafTransmittance(c);
    }
    set.notes.emplace_back("no translucency: it is guessed from the albedo");
  }
  // What one side throws back and what leaves on the other come from the same light.
  std::size_t inside = 0;
  std::array<std::size_t, 2> over{};
  for (std::size_t i = 0; i < set.texelCount(); ++i) {
    const bool is_leaf = set.opacity[i] >= 0.5f;
    const auto limit = [&](glm::vec3& thrown_back, glm::vec3& let_through) {
      const glm::vec3 sum = thrown_back + let_through;
      const float most = std::max({sum.x, sum.y, sum.z});
      if (most <= 1.0f) return std::size_t{0};
      thrown_back /= most;
      let_through /= most;
      return std::size_t{is_leaf && most > 1.01f};  // less may be the rounding to 8 bits
    };
    over[0] += limit(set.front.albedo[i], set.back.translucency[i]);
    over[1] += limit(set.back.albedo[i], set.front.translucency[i]);
    if (is_leaf) ++inside;
  }
  const auto percent = [inside](std::size_t count) {
    return 100.0 * static_cast<double>(count) / static_cast<double>(inside);
  };
  if (over[0] + over[1] > 0)
    set.notes.push_back(fmt::format(
        "albedo and translucency are scaled down where they sum to more than 1: {:.1f} % of the "
        "leaf for light on the front, {:.1f} % for light on the back",
        percent(over[0]), percent(over[1])));
}

}  // namespace

LeafMap decodeLeafMap(std::span<const std::uint8_t> file, const std::string& where) {
  LeafMap map;
  map.where = where;
  Image16 image = decodeImage16(file, where);
  map.width = image.width;
  map.height = image.height;
  map.channels = image.channels;
  map.values.resize(image.values.size());
  for (std::size_t i = 0; i < image.values.size(); ++i)
    map.values[i] = static_cast<float>(image.values[i]) / 65535.0f;
  return map;
}

LeafMap readLeafMap(const std::filesystem::path& path) {
  if (path.extension() != ".exr") return decodeLeafMap(readFile(path), path.string());
  const HdrImage image = readExrMap(path);
  LeafMap map;
  map.where = path.string();
  map.width = image.width;
  map.height = image.height;
  map.channels = 3;
  map.physical = true;
  map.values.reserve(3 * image.rgb.size());
  for (const glm::vec3& v : image.rgb) map.values.insert(map.values.end(), {v.x, v.y, v.z});
  return map;
}

LeafSet makeLeafSet(LeafMaps maps, const LeafImportOptions& options) {
  if (!maps.sides[0].albedo)
    throw Error(maps.where, "the front has no albedo",
                "give a map of its colour (front.albedo in leaf.json, or NAME_Color)");
  checkPositive(maps.where, "--relief-mm", options.relief_mm);
  if (options.relief_mm)
    for (LeafSideMaps& side : maps.sides)
      if (side.relief && !side.relief->physical)
        side.relief_range_mm = LeafRange{-0.5f * *options.relief_mm, 0.5f * *options.relief_mm};
  LeafSet set;
  set.name = options.name.empty() ? maps.name : options.name;
  set.optics = maps.optics;
  set.notes = std::move(maps.notes);
  findSize(set, maps);
  findScale(set, maps, options);
  findOpacity(set, maps);
  findThickness(set, maps, options);
  findColors(set, maps);
  LeafShape(set, maps).make();
  checkLeafSet(set, maps.where);
  return set;
}

}  // namespace verdure
