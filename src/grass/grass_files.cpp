#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "base/files.h"
#include "base/parallel.h"
#include "grass/grass_json.h"
#include "grass/grass_maps.h"
#include "shared/color.h"
#include "shared/grass.h"
#include "verdure/error.h"
#include "verdure/grass.h"
#include "verdure/image.h"

namespace verdure {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Files = std::vector<std::pair<fs::path, std::vector<std::uint8_t>>>;

constexpr const char* kFile = "grass.json";
constexpr const char* kFormat = "verdure-grass";
constexpr int kVersion = 1;
/// Where only colours are given: what a blade transmits, and ranks of this many strips of a tile.
constexpr float kTransmitted = 0.6f;
constexpr int kStrips = 32;

Image colorImage(const GrassMap& map) {
  Image image(map.width, map.height);
  parallelFor(map.texelCount(), 4096, [&](std::size_t i) {
    const glm::vec4& c = map.color[i];
    for (int k = 0; k < 3; ++k) {
      const float straight = c.a > 0 ? glm::clamp(c[k] / c.a, 0.0f, 1.0f) : 0.0f;
      image.rgba[4 * i + static_cast<std::size_t>(k)] = toByte(shared::srgbFromLinear(straight));
    }
    image.rgba[4 * i + 3] = toByte(c.a);
  });
  return image;
}

Image dataImage(const GrassMap& map) {
  Image image(map.width, map.height);
  parallelFor(map.texelCount(), 4096, [&](std::size_t i) {
    const float alpha = map.color[i].a;
    const glm::vec4 d = alpha > 0 ? map.data[i] / alpha : glm::vec4(0.0f);
    image.rgba[4 * i] = toByte(0.5f * d.x + 0.5f);
    image.rgba[4 * i + 1] = toByte(0.5f * d.y + 0.5f);
    image.rgba[4 * i + 2] = toByte(d.z);
    image.rgba[4 * i + 3] = toByte(d.w);
  });
  return image;
}

/// Adds a map's two pictures and returns their names.
Json addMap(const GrassMap& map, const std::string& name, const fs::path& folder,
            std::vector<std::pair<fs::path, Image>>& images) {
  images.emplace_back(folder / (name + ".png"), colorImage(map));
  images.emplace_back(folder / (name + "_data.png"), dataImage(map));
  return {{"color", name + ".png"}, {"data", name + "_data.png"}};
}

/// The ranks of a picture without data, by its place: what has density d is cut in strips of slices
/// and squares of grounds, which end at tiles' borders.
float placeRank(const GrassMap& map, std::size_t i, bool square, std::uint32_t salt) {
  const auto cell = [](std::size_t at, int size) {
    return static_cast<std::uint32_t>(at * std::size_t{4 * kStrips} /
                                      static_cast<std::size_t>(size));
  };
  const auto width = static_cast<std::size_t>(map.width);
  const std::uint32_t row = square ? cell(i / width, map.height) : 0u;
  return static_cast<float>(shared::grassHash(cell(i % width, map.width), row, salt) >> 8u) *
         0x1p-24f;
}

/// What a picture is, where its data is missing.
enum class Place { kSlice, kMiddle, kGround };

GrassMap mapFromImages(const Image& color, const Image& data, Place place, std::uint32_t salt) {
  GrassMap map;
  map.width = color.width;
  map.height = color.height;
  map.color.resize(map.texelCount());
  map.data.resize(map.texelCount());
  std::array<float, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i)
    linear[i] = shared::linearFromSrgb(static_cast<float>(i) / 255.0f);
  bool ranked = false;
  for (std::size_t i = 3; i < data.rgba.size() && !ranked; i += 4) ranked = data.rgba[i] != 255;
  parallelFor(map.texelCount(), 4096, [&](std::size_t i) {
    const std::uint8_t* c = &color.rgba[4 * i];
    const float alpha = static_cast<float>(c[3]) / 255.0f;
    map.color[i] = glm::vec4(linear[c[0]], linear[c[1]], linear[c[2]], 1.0f) * alpha;
    glm::vec4 d(0.0f, 0.0f, place == Place::kGround ? 0.0f : kTransmitted, 0.0f);
    if (!data.empty()) {
      for (int k = 0; k < 4; ++k)
        d[k] = static_cast<float>(data.rgba[4 * i + static_cast<std::size_t>(k)]) / 255.0f;
      glm::vec2 normal(2.0f * d.x - 1.0f, 2.0f * d.y - 1.0f);
      normal /= std::max(1.0f, glm::length(normal));
      d.x = normal.x;
      d.y = normal.y;
    }
    if (!ranked)
      d.w = place == Place::kGround ? 0.0f : placeRank(map, i, place == Place::kMiddle, salt);
    map.data[i] = d * alpha;
  });
  return map;
}

/// One tile, four times to the right, and down as well if `down`.
Image repeated(const Image& image, bool down) {
  Image all(4 * image.width, down ? 4 * image.height : image.height);
  for (int y = 0; y < all.height; ++y)
    for (int x = 0; x < all.width; x += image.width)
      std::copy_n(image.at(0, y % image.height), 4 * image.width, all.at(x, y));
  return all;
}

/// How the pictures of a folder are read.
struct Reader {
  fs::path folder;
  std::string where;
  bool one_tile = false;

  GrassMap read(const Json& json, const std::string& what, Place place, std::uint32_t salt) const {
    const GrassMembers members(json, where + ": " + what, {"color", "data"});
    std::string color_name, data_name;
    members.at("color");
    members.text("color", color_name);
    members.text("data", data_name);
    Image color = picture(color_name, place), data;
    if (!data_name.empty()) {
      data = picture(data_name, place);
      if (data.width != color.width || data.height != color.height)
        throw Error((folder / data_name).string(),
                    fmt::format("is {} x {} texels, its colours are {} x {}", data.width,
                                data.height, color.width, color.height),
                    "make both of one size");
    }
    if (color.width % 4 != 0 || (place != Place::kSlice && color.height % 4 != 0))
      throw Error((folder / color_name).string(),
                  fmt::format("is {} x {} texels, which four tiles cannot share", color.width,
                              color.height),
                  "give four tiles of one size, or one and \"tiles\": 1");
    return mapFromImages(color, data, place, salt);
  }

 private:
  Image picture(const std::string& name, Place place) const {
    const Image image = readImage(folder / name);
    const int times = one_tile ? 4 : 1;
    if (image.width > 16384 / times || image.height > 16384 / times)
      throw Error((folder / name).string(),
                  fmt::format("is {} x {} texels", image.width, image.height),
                  "give 16384 at most, 4096 for one tile");
    return one_tile ? repeated(image, place != Place::kSlice) : image;
  }
};

Json readJson(const fs::path& path) {
  const std::vector<std::uint8_t> bytes = readFile(path);
  Json json;
  try {
    json = Json::parse(bytes.begin(), bytes.end());
  } catch (const Json::parse_error& e) {
    throw Error(path.string(), fmt::format("is no JSON at byte {}", e.byte), "mend the file");
  }
  if (!json.is_object() || json.value("format", Json()) != kFormat)
    throw Error(path.string(), fmt::format("is no grass: format is not '{}'", kFormat),
                "see docs/grass.md");
  if (json.value("version", Json()) != kVersion)
    throw Error(path.string(), "has a version that this program does not know",
                fmt::format("version {} is the newest", kVersion));
  return json;
}

void readSpacing(const GrassMembers& members, glm::vec2& spacing_m) {
  const Json& json = members.at("spacing_m");
  if (json.is_array() && json.size() == 2 && json[0].is_number() && json[1].is_number()) {
    spacing_m = {json[0].get<float>(), json[1].get<float>()};
  } else if (json.is_number()) {
    spacing_m = glm::vec2(json.get<float>());
  } else {
    throw Error(members.where(), "spacing_m is neither a number nor a pair of numbers",
                "write metres, or [across u, across v]");
  }
}

}  // namespace

void saveGrass(const GrassSet& set, const fs::path& folder) {
  checkGrassSet(set, folder.string());
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (!fs::is_directory(folder, problem))
    throw Error(folder.string(), "is no folder and cannot be made one", "choose another folder");
  checkWritable(folder / kFile);
  std::vector<std::pair<fs::path, Image>> images;
  Json json;
  json["format"] = kFormat;
  json["version"] = kVersion;
  json["name"] = set.name;
  json["height_m"] = shortestNumber(set.height_m);
  json["spacing_m"] =
      Json::array({shortestNumber(set.spacing_m.x), shortestNumber(set.spacing_m.y)});
  if (set.spacing_m.x == set.spacing_m.y) json["spacing_m"] = shortestNumber(set.spacing_m.x);
  json["tile_m"] = shortestNumber(set.tile_m);
  json["slices"] = Json::array();
  for (std::size_t i = 0; i < set.slices.size(); ++i)
    json["slices"].push_back(addMap(set.slices[i], fmt::format("slice_{:02}", i), folder, images));
  json["opaque"] = addMap(set.opaque, "opaque", folder, images);
  json["ground"] = addMap(set.ground, "ground", folder, images);
  if (!set.middle.empty()) json["middle"] = addMap(set.middle, "middle", folder, images);
  if (!set.species.plants.empty()) json["species"] = speciesToJson(set.species);
  const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";

  Files files(images.size());
  parallelFor(images.size(), 1, [&](std::size_t i) {
    files[i] = {images[i].first, encodePng(images[i].second)};
  });
  files.emplace_back(folder / kFile, std::vector<std::uint8_t>(text.begin(), text.end()));
  writeFiles(files);
}

GrassSet loadGrass(const fs::path& path) {
  std::error_code problem;
  const fs::path file = fs::is_directory(path, problem) ? path / kFile : path;
  const Json json = readJson(file);
  const GrassMembers members(json, file.string(),
                             {"format", "version", "name", "height_m", "spacing_m", "tile_m",
                              "tiles", "slices", "opaque", "ground", "middle", "species"});
  GrassSet set;
  set.name = file.parent_path().filename().string();
  members.text("name", set.name);
  for (const char* needed : {"height_m", "tile_m", "slices"}) members.at(needed);
  members.number("height_m", set.height_m);
  members.number("tile_m", set.tile_m);
  readSpacing(members, set.spacing_m);
  int tiles = 4;
  members.number("tiles", tiles);
  if (tiles != 1 && tiles != 4)
    throw Error(file.string(), fmt::format("tiles is {}", tiles), "give 1 or 4");

  const Reader reader{file.parent_path(), file.string(), tiles == 1};
  for (const Json& slice : members.array("slices")) {
    const std::size_t i = set.slices.size();
    set.slices.push_back(reader.read(slice, fmt::format("slice {}", i), Place::kSlice,
                                     static_cast<std::uint32_t>(i)));
    const GrassMap& last = set.slices.back();
    const GrassMap& first = set.slices.front();
    if (last.width != first.width || last.height != first.height)
      throw Error(fmt::format("{}: slice {}", file.string(), i),
                  fmt::format("is {} x {} texels, others are {} x {}", last.width, last.height,
                              first.width, first.height),
                  "make all of one size");
  }
  if (set.slices.empty()) throw Error(file.string(), "has no slices", "give at least one");
  if (members.has("species"))
    set.species = speciesFromJson(members.at("species"), file.string() + ": species");
  set.opaque = members.has("opaque")
                   ? reader.read(members.at("opaque"), "opaque", Place::kSlice, 101u)
                   : opaqueMap(set.slices);
  set.ground = members.has("ground")
                   ? reader.read(members.at("ground"), "ground", Place::kGround, 102u)
                   : evenMap(4, 4, set.species.soil_color);
  if (members.has("middle"))
    set.middle = reader.read(members.at("middle"), "middle", Place::kMiddle, 103u);
  checkGrassSet(set, file.string());
  return set;
}

}  // namespace verdure
