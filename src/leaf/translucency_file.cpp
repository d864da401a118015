#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "base/files.h"
#include "leaf/leaf_json.h"
#include "verdure/error.h"
#include "verdure/image.h"
#include "verdure/leaf_translucency.h"

namespace verdure {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json writeSide(const LeafTranslucency& baked, const std::vector<glm::vec3>& coefficients,
               const std::string& which, const fs::path& folder) {
  HdrImage exact(baked.width, baked.height);
  exact.rgb = coefficients;
  writeExr(exact, folder / (which + "_hl2.exr"), ExrDepth::kHalf);
  glm::vec3 least(coefficients[0]), most(coefficients[0]);
  for (const glm::vec3& h : coefficients) {
    least = glm::min(least, h);
    most = glm::max(most, h);
  }
  const glm::vec3 scale = glm::max(most - least, 1e-12f);
  Image bytes(baked.width, baked.height);
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    for (int c = 0; c < 3; ++c)
      bytes.rgba[4 * i + static_cast<std::size_t>(c)] =
          toByte((coefficients[i][c] - least[c]) / scale[c]);
    bytes.rgba[4 * i + 3] = 255;
  }
  writePng(bytes, folder / (which + "_hl2.png"));
  return {{"exr", which + "_hl2.exr"},
          {"png", which + "_hl2.png"},
          {"scale", {shortest(scale.x), shortest(scale.y), shortest(scale.z)}},
          {"offset", {shortest(least.x), shortest(least.y), shortest(least.z)}}};
}

}  // namespace

void writeLeafTranslucency(const LeafTranslucency& baked, const fs::path& folder) {
  Json json = readLeafJson(folder);
  checkWritable(folder / kLeafFile);
  json["hl2"] = {{"front", writeSide(baked, baked.front, "front", folder)},
                 {"back", writeSide(baked, baked.back, "back", folder)}};
  writeLeafJson(json, folder);
}

LeafTranslucency readLeafTranslucency(const fs::path& folder) {
  const Json json = readLeafJson(folder);
  const std::string where = (folder / kLeafFile).string();
  if (!json.contains("hl2"))
    throw Error(where, "the leaf is not baked", "run verdure leaf bake on its folder");
  LeafTranslucency baked;
  for (const char* side : {"front", "back"}) {
    const Json file =
        json["hl2"].is_object() && json["hl2"].contains(side) && json["hl2"][side].is_object()
            ? json["hl2"][side].value("exr", Json())
            : Json();
    if (!file.is_string())
      throw Error(where, fmt::format("hl2.{} names no EXR file", side), "bake the leaf again");
    HdrImage image = readExrMap(folder / file.get<std::string>());
    if (baked.width != 0 && (image.width != baked.width || image.height != baked.height))
      throw Error(where, "the coefficients of both sides differ in size", "bake the leaf again");
    baked.width = image.width;
    baked.height = image.height;
    (side == std::string("front") ? baked.front : baked.back) = std::move(image.rgb);
  }
  return baked;
}

}  // namespace verdure
