#include "verdure/leaf_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <string_view>

#include "base/files.h"
#include "base/parallel.h"
#include "leaf/leaf_json.h"
#include "leaf/leaf_maps.h"
#include "shared/color.h"
#include "verdure/error.h"

namespace verdure {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "verdure-leaf";
constexpr int kVersion = 1;

/// An object of leaf.json: names the member in what it throws, and refuses members that it does
/// not know, which are mistyped more often than not.
class Members {
 public:
  Members(const Json& json, std::string where, std::initializer_list<std::string_view> known)
      : json_(json), where_(std::move(where)) {
    if (!json.is_object()) throw Error(where_, "is no object", "see docs/leaves.md");
    for (const auto& [key, value] : json.items())
      if (std::find(known.begin(), known.end(), key) == known.end())
        throw Error(where_, "has an unknown member '" + key + "'", "see docs/leaves.md");
  }

  std::optional<float> number(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end()) return std::nullopt;
    if (!found->is_number() || !std::isfinite(found->get<float>()))
      throw Error(where_, fmt::format("{} is no number", key), "see docs/leaves.md");
    return found->get<float>();
  }
  void number(const char* key, float& value) const {
    if (const auto given = number(key)) value = *given;
  }
  std::optional<std::string> text(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end()) return std::nullopt;
    if (!found->is_string())
      throw Error(where_, fmt::format("{} is no text", key), "see docs/leaves.md");
    return found->get<std::string>();
  }
  std::optional<LeafRange> range(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end()) return std::nullopt;
    if (!found->is_array() || found->size() != 2 || !(*found)[0].is_number() ||
        !(*found)[1].is_number())
      throw Error(where_, fmt::format("{} is no pair of numbers", key), "write [low, high]");
    return LeafRange{(*found)[0].get<float>(), (*found)[1].get<float>()};
  }
  std::optional<LeafMap> map(const char* key, const fs::path& folder) const {
    const auto name = text(key);
    if (!name) return std::nullopt;
    return readLeafMap(folder / *name);
  }

 private:
  const Json& json_;
  std::string where_;
};

LeafSideMaps readSide(const Json& json, const std::string& where, const fs::path& folder) {
  const Members members(json, where,
                        {"albedo", "translucency", "normal", "relief", "relief_range_mm"});
  LeafSideMaps side;
  side.albedo = members.map("albedo", folder);
  side.translucency = members.map("translucency", folder);
  side.normal = members.map("normal", folder);
  side.relief = members.map("relief", folder);
  side.relief_range_mm = members.range("relief_range_mm");
  if (side.relief && !side.relief->physical && !side.relief_range_mm)
    throw Error(where, "has relief of unknown height", "add relief_range_mm: [low, high]");
  return side;
}

LeafMaps readMaps(const fs::path& folder) {
  const Json json = readLeafJson(folder);
  LeafMaps maps;
  maps.where = (folder / kLeafFile).string();
  const Members members(
      json, maps.where,
      {"format", "version", "name", "mm_per_texel", "width_mm", "front", "back", "thickness",
       "thickness_range_mm", "thickness_mm", "opacity", "optics", "notes", "hl2"});
  maps.name = members.text("name").value_or(folder.filename().string());
  maps.mm_per_texel = members.number("mm_per_texel");
  maps.width_mm = members.number("width_mm");
  for (const int s : {0, 1}) {
    const char* key = s == 0 ? "front" : "back";
    if (json.contains(key))
      maps.sides[static_cast<std::size_t>(s)] =
          readSide(json[key], maps.where + ": " + key, folder);
  }
  maps.thickness = members.map("thickness", folder);
  maps.thickness_range_mm = members.range("thickness_range_mm");
  maps.thickness_mm = members.number("thickness_mm");
  maps.opacity = members.map("opacity", folder);
  if (json.contains("optics")) {
    const Members optics(json["optics"], maps.where + ": optics",
                         {"scattering_per_mm", "absorption_per_mm", "anisotropy",
                          "refractive_index", "front_roughness", "back_roughness", "front_index"});
    optics.number("scattering_per_mm", maps.optics.scattering_per_mm);
    optics.number("absorption_per_mm", maps.optics.absorption_per_mm);
    optics.number("anisotropy", maps.optics.anisotropy);
    optics.number("refractive_index", maps.optics.refractive_index);
    optics.number("front_roughness", maps.optics.front_roughness);
    optics.number("back_roughness", maps.optics.back_roughness);
    optics.number("front_index", maps.optics.front_index);
  }
  if (json.contains("notes"))
    for (const Json& note : json["notes"])
      if (note.is_string()) maps.notes.push_back(note.get<std::string>());
  return maps;
}

/// A folder of maps with ambientCG's names.
LeafMaps findMaps(const fs::path& folder) {
  LeafMaps maps;
  maps.where = folder.string();
  maps.name = fs::absolute(folder / ".").parent_path().filename().string();
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  LeafSideMaps& front = maps.sides[0];
  const std::pair<const char*, std::optional<LeafMap>*> kinds[] = {
      {"_Color", &front.albedo},        {"_NormalGL", &front.normal},
      {"_Opacity", &maps.opacity},      {"_Scattering", &front.translucency},
      {"_Displacement", &front.relief}, {"_Thickness", &maps.thickness},
  };
  bool rough = false;
  for (const fs::path& file : files) {
    std::string kind = file.extension().string();
    std::transform(kind.begin(), kind.end(), kind.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (kind != ".png" && kind != ".jpg" && kind != ".jpeg" && kind != ".exr") continue;
    const std::string stem = file.stem().string();
    rough = rough || stem.ends_with("_Roughness");
    for (const auto& [ending, map] : kinds) {
      if (!stem.ends_with(ending)) continue;
      if (*map)
        throw Error(
            maps.where,
            fmt::format("{} and {} are both named {}", fs::path((*map)->where).filename().string(),
                        file.filename().string(), ending),
            "leave one of them in the folder");
      *map = readLeafMap(file);
      if (map == &front.albedo)
        maps.name = stem.substr(0, stem.size() - std::string_view(ending).size());
    }
  }
  if (rough)
    maps.notes.emplace_back("the map of roughness is not used: one roughness stands for a side");
  return maps;
}

Image colorImage(const LeafSet& set, const std::vector<glm::vec3>& colors) {
  Image image(set.width, set.height);
  parallelFor(colors.size(), 4096, [&](std::size_t i) {
    for (int c = 0; c < 3; ++c)
      image.rgba[4 * i + static_cast<std::size_t>(c)] =
          toByte(shared::srgbFromLinear(glm::clamp(colors[i][c], 0.0f, 1.0f)));
    image.rgba[4 * i + 3] = 255;
  });
  return image;
}

std::uint16_t toShort(float value) {
  return static_cast<std::uint16_t>(glm::clamp(value, 0.0f, 1.0f) * 65535.0f + 0.5f);
}

/// Writes numbers as greys between their least and largest, and returns these two.
Json writeGreys(const LeafSet& set, const std::vector<float>& values, const fs::path& path) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const float low = *least, high = *most;
  Image16 image{set.width, set.height, 1, std::vector<std::uint16_t>(values.size())};
  for (std::size_t i = 0; i < values.size(); ++i)
    image.values[i] = high > low ? toShort((values[i] - low) / (high - low)) : std::uint16_t{0};
  writeFile(path, encodePng(image));
  return Json::array({shortest(low), shortest(high)});
}

Json writeSide(const LeafSet& set, const LeafSide& side, const std::string& which,
               const fs::path& folder) {
  writePng(colorImage(set, side.albedo), folder / (which + "_albedo.png"));
  writePng(colorImage(set, side.translucency), folder / (which + "_translucency.png"));
  Image16 normals{set.width, set.height, 3, {}};
  normals.values.reserve(3 * side.normal.size());
  for (const glm::vec3& n : side.normal)
    for (int c = 0; c < 3; ++c) normals.values.push_back(toShort(0.5f * n[c] + 0.5f));
  writeFile(folder / (which + "_normal.png"), encodePng(normals));
  Json json;
  for (const char* map : {"albedo", "translucency", "normal", "relief"})
    json[map] = which + "_" + map + ".png";
  json["relief_range_mm"] = writeGreys(set, side.relief_mm, folder / (which + "_relief.png"));
  return json;
}

}  // namespace

nlohmann::ordered_json readLeafJson(const fs::path& folder) {
  const fs::path path = folder / kLeafFile;
  const std::vector<std::uint8_t> bytes = readFile(path);
  Json json;
  try {
    json = Json::parse(bytes.begin(), bytes.end());
  } catch (const Json::parse_error& e) {
    throw Error(path.string(), fmt::format("is no JSON at byte {}", e.byte), "mend the file");
  }
  if (!json.is_object() || json.value("format", Json()) != kFormat)
    throw Error(path.string(), fmt::format("is no leaf: format is not '{}'", kFormat),
                "see docs/leaves.md");
  if (json.value("version", Json()) != kVersion)
    throw Error(path.string(), "has a version that this program does not know",
                fmt::format("version {} is the newest", kVersion));
  return json;
}

double shortest(float value) {
  const std::string digits = fmt::format("{}", value);
  double number = 0.0;
  std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return number;
}

void writeLeafJson(const nlohmann::ordered_json& json, const fs::path& folder) {
  writeFile(folder / kLeafFile, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void writeLeafSet(const LeafSet& set, const fs::path& folder) {
  checkLeafSet(set, folder.string());
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (!fs::is_directory(folder, problem))
    throw Error(folder.string(), "is no folder and cannot be made one", "choose another folder");
  checkWritable(folder / kLeafFile);
  Json json;
  json["format"] = kFormat;
  json["version"] = kVersion;
  json["name"] = set.name;
  json["mm_per_texel"] = shortest(set.mm_per_texel);
  json["front"] = writeSide(set, set.front, "front", folder);
  json["back"] = writeSide(set, set.back, "back", folder);
  json["thickness"] = "thickness.png";
  json["thickness_range_mm"] = writeGreys(set, set.thickness_mm, folder / "thickness.png");
  Image opacity(set.width, set.height);
  for (std::size_t i = 0; i < set.opacity.size(); ++i) {
    std::fill_n(opacity.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i), 3,
                toByte(set.opacity[i]));
    opacity.rgba[4 * i + 3] = 255;
  }
  writePng(opacity, folder / "opacity.png");
  json["opacity"] = "opacity.png";
  const LeafOptics& o = set.optics;
  json["optics"] = {{"scattering_per_mm", shortest(o.scattering_per_mm)},
                    {"absorption_per_mm", shortest(o.absorption_per_mm)},
                    {"anisotropy", shortest(o.anisotropy)},
                    {"refractive_index", shortest(o.refractive_index)},
                    {"front_roughness", shortest(o.front_roughness)},
                    {"back_roughness", shortest(o.back_roughness)},
                    {"front_index", shortest(o.front_index)}};
  json["notes"] = set.notes;
  writeLeafJson(json, folder);
}

LeafSet readLeafSet(const fs::path& folder, const LeafImportOptions& options) {
  return makeLeafSet(readMaps(folder), options);
}

LeafSet importLeafSet(const fs::path& folder, const LeafImportOptions& options) {
  std::error_code status;
  if (!fs::is_directory(folder, status))
    throw Error(folder.string(), "is no folder", "name a folder of maps, or a .glb or .gltf");
  if (fs::exists(folder / kLeafFile, status)) return readLeafSet(folder, options);
  return makeLeafSet(findMaps(folder), options);
}

}  // namespace verdure
