#include "plant/classify.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

#include "plant/load.h"
#include "verdure/error.h"

namespace verdure {
namespace {

/// What the triangles of a part look like, piece by piece (connected by shared positions).
struct Pieces {
  std::size_t count = 0;
  double largest_share = 0.0;  ///< of the triangles
  double median_triangles = 0.0;
  double flatness = 0.0;  ///< 1 = flat cards and leaves, 1/2 = tubes, 1/3 = balls; by area
};

/// Largest eigenvalue of the symmetric matrix (xx, yy, zz, xy, xz, yz), by the closed form of Smith
/// (1961, "Eigenvalues of a symmetric 3x3 matrix").
double largestEigenvalue(const std::array<double, 6>& m) {
  const double mean = (m[0] + m[1] + m[2]) / 3.0;
  const double x = m[0] - mean, y = m[1] - mean, z = m[2] - mean;
  const double p2 = (x * x + y * y + z * z + 2.0 * (m[3] * m[3] + m[4] * m[4] + m[5] * m[5])) / 6.0;
  if (!(p2 > 0.0)) return mean;
  const double p = std::sqrt(p2);
  const double determinant =
      x * (y * z - m[5] * m[5]) - m[3] * (m[3] * z - m[5] * m[4]) + m[4] * (m[3] * m[5] - y * m[4]);
  const double r = std::clamp(determinant / (2.0 * p2 * p), -1.0, 1.0);
  return mean + 2.0 * p * std::cos(std::acos(r) / 3.0);
}

/// Of larger parts the first triangles are looked at: they say what the others are.
constexpr std::size_t kEnoughTriangles = 50'000;

Pieces measurePieces(const Mesh& mesh) {
  // Pieces are what findLeaves calls leaves: let it find them.
  Plant alone;
  Mesh& copy = alone.meshes.emplace_back();
  copy.kind = PartKind::kFoliage;
  copy.indices.assign(mesh.indices.begin(),
                      mesh.indices.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                 mesh.indices.size(), 3 * kEnoughTriangles)));
  const std::uint32_t last = *std::max_element(copy.indices.begin(), copy.indices.end());
  copy.positions.assign(mesh.positions.begin(), mesh.positions.begin() + last + 1);
  findLeaves(alone);
  Pieces pieces;
  pieces.count = alone.leaves.size();
  std::vector<std::uint32_t> sizes;
  double area_sum = 0.0, flat_sum = 0.0;
  for (const Leaf& piece : alone.leaves) {
    sizes.push_back(piece.triangle_count);
    std::array<double, 6> spread{};
    double area = 0.0;
    for (std::uint32_t k = 0; k < piece.triangle_count; ++k) {
      const std::size_t t = alone.leaf_triangles[piece.first_triangle + k];
      const glm::dvec3 a(mesh.positions[mesh.indices[3 * t]]);
      const glm::dvec3 b(mesh.positions[mesh.indices[3 * t + 1]]);
      const glm::dvec3 c(mesh.positions[mesh.indices[3 * t + 2]]);
      const glm::dvec3 n = glm::cross(b - a, c - a);
      const double length = glm::length(n);
      if (!(length > 0.0)) continue;
      area += length;
      const glm::dvec3 w = n / std::sqrt(length);
      spread[0] += w.x * w.x;
      spread[1] += w.y * w.y;
      spread[2] += w.z * w.z;
      spread[3] += w.x * w.y;
      spread[4] += w.x * w.z;
      spread[5] += w.y * w.z;
    }
    area_sum += area;
    flat_sum += largestEigenvalue(spread);
  }
  if (area_sum > 0.0) pieces.flatness = flat_sum / area_sum;
  if (!sizes.empty()) {
    std::sort(sizes.begin(), sizes.end());
    pieces.median_triangles = sizes[sizes.size() / 2];
    pieces.largest_share = double(sizes.back()) / double(copy.triangleCount());
  }
  return pieces;
}

/// What a base colour texture holds.
struct TextureFacts {
  double transparent = 0.0;  ///< share of texels with alpha below the cut-off
  bool green = false;        ///< mean colour of the opaque texels
};

bool isGreen(const glm::dvec3& color) {
  return color.g > 1.05 * color.r && color.g > 1.1 * color.b;
}

TextureFacts readTexture(const Image& image, float cutoff) {
  TextureFacts facts;
  const std::size_t texels = image.rgba.size() / 4;
  if (texels == 0) return facts;
  const auto limit = cutoff * 255.0f;
  const std::size_t step = std::max<std::size_t>(1, texels / 65536);
  std::size_t seen = 0, transparent = 0;
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < texels; i += step, ++seen) {
    const std::uint8_t* t = &image.rgba[4 * i];
    if (static_cast<float>(t[3]) < limit)
      ++transparent;
    else
      sum += glm::dvec3(t[0], t[1], t[2]);
  }
  facts.transparent = double(transparent) / double(seen);
  facts.green = isGreen(sum);
  return facts;
}

struct Verdict {
  double score = 0.0;
  std::vector<std::string> foliage, wood;  ///< reasons for either

  void add(double points, const std::string& reason) {
    score += points;
    if (points > 0.0) foliage.push_back(reason);
    if (points < 0.0) wood.push_back(reason);
  }
};

Verdict judge(const Plant& plant, const Mesh& mesh, const PartNames& names) {
  const Material& material = plant.materials[mesh.material];
  Verdict verdict;
  // The material's name says most: meshes and nodes are often named after the whole plant.
  const double by_material = nameScore(material.name);
  const double by_mesh = nameScore(names.mesh), by_node = nameScore(names.node);
  double name_points = by_material;
  if (name_points == 0.0)
    name_points = std::abs(by_mesh) >= std::abs(by_node) ? by_mesh : by_node;
  else
    name_points += 0.25 * (by_mesh + by_node);
  verdict.add(name_points, "name");

  TextureFacts texture;
  if (material.base_color_texture >= 0)
    texture =
        readTexture(plant.textures[static_cast<std::size_t>(material.base_color_texture)].image,
                    material.alpha_mode == AlphaMode::kMask ? material.alpha_cutoff : 0.5f);
  if (material.alpha_mode != AlphaMode::kOpaque)
    verdict.add(texture.transparent > 0.05 ? 3.5 : 0.5,
                material.alpha_mode == AlphaMode::kMask ? "alpha mask" : "alpha blend");
  else if (texture.transparent > 0.2)
    verdict.add(1.5, "cut-out texture");
  if (material.double_sided) verdict.add(1.0, "double-sided");

  const bool green =
      material.base_color_texture >= 0 && texture.green
          ? true
          : material.base_color_texture < 0 && isGreen(glm::dvec3(material.base_color));
  if (green) verdict.add(1.0, "green");

  const Pieces pieces = measurePieces(mesh);
  const bool all = mesh.triangleCount() <= kEnoughTriangles;
  const std::string count =
      (all ? "" : "over ") + withCommas(pieces.count) + (pieces.count == 1 ? " piece" : " pieces");
  if (pieces.flatness > 0.75)
    verdict.add(1.5, "flat pieces");
  else if (pieces.flatness < 0.62)
    verdict.add(-1.5, "round pieces");
  if (pieces.count >= 30 && pieces.largest_share < 0.1 && pieces.median_triangles <= 16.0)
    verdict.add(pieces.median_triangles <= 8.0 ? 2.0 : 1.0, count);
  else if (pieces.count <= 3 || pieces.largest_share > 0.5)
    verdict.add(-0.5, count);
  else if (pieces.median_triangles > 40.0)
    verdict.add(-0.5, "large pieces");
  return verdict;
}

bool anyMatches(const std::vector<std::string>& patterns, const Plant& plant, const Mesh& mesh,
                const PartNames& names) {
  return std::any_of(patterns.begin(), patterns.end(), [&](const std::string& pattern) {
    return matchesPattern(plant.materials[mesh.material].name, pattern) ||
           (!names.mesh.empty() && matchesPattern(names.mesh, pattern)) ||
           (!names.node.empty() && matchesPattern(names.node, pattern)) ||
           matchesPattern(mesh.name, pattern);
  });
}

/// Every pattern must match something.
void checkPatterns(const Plant& plant, const std::vector<PartNames>& names,
                   const std::vector<std::string>& patterns, const std::string& where) {
  std::set<std::string> known;
  for (std::size_t i = 0; i < plant.meshes.size(); ++i)
    for (const std::string& name : {plant.materials[plant.meshes[i].material].name, names[i].mesh,
                                    names[i].node, plant.meshes[i].name})
      if (!name.empty()) known.insert(name);
  for (const std::string& pattern : patterns) {
    if (std::any_of(known.begin(), known.end(),
                    [&](const std::string& name) { return matchesPattern(name, pattern); }))
      continue;
    std::string list;
    for (const std::string& name : known) {
      if (list.size() > 400) {
        list += ", ...";
        break;
      }
      if (!list.empty()) list += ", ";
      list += name;
    }
    throw Error(where, "no material, mesh or node is named '" + pattern + "'",
                "the file has " + list);
  }
}

std::string joined(const std::vector<std::string>& reasons) {
  std::string text;
  for (const std::string& reason : reasons) {
    if (!text.empty()) text += ", ";
    text += reason;
  }
  return text.empty() ? "nothing speaks for foliage" : text;
}

}  // namespace

void classifyParts(Plant& plant, const std::vector<PartNames>& names, const LoadOptions& options,
                   const std::string& where) {
  checkPatterns(plant, names, options.foliage, where);
  checkPatterns(plant, names, options.wood, where);
  for (std::size_t i = 0; i < plant.meshes.size(); ++i) {
    Mesh& mesh = plant.meshes[i];
    const bool foliage = anyMatches(options.foliage, plant, mesh, names[i]);
    const bool wood = anyMatches(options.wood, plant, mesh, names[i]);
    if (foliage && wood)
      throw Error(where, "part '" + mesh.name + "' is named both as foliage and as wood",
                  "name it once");
    std::string reasons = "as told";
    if (foliage || wood) {
      mesh.kind = foliage ? PartKind::kFoliage : PartKind::kWood;
    } else if (names[i].recorded) {
      mesh.kind = *names[i].recorded;
      reasons = "recorded in the file";
    } else {
      const Verdict verdict = judge(plant, mesh, names[i]);
      mesh.kind = verdict.score > 0.0 ? PartKind::kFoliage : PartKind::kWood;
      const bool is_foliage = mesh.kind == PartKind::kFoliage;
      reasons = joined(is_foliage ? verdict.foliage : verdict.wood);
      const auto& against = is_foliage ? verdict.wood : verdict.foliage;
      if (!against.empty()) reasons += "; although " + joined(against);
      reasons += fmt::format(" (score {:+.1f})", verdict.score);
    }
    plant.notes.push_back(fmt::format("part '{}' is {}: {}", mesh.name,
                                      mesh.kind == PartKind::kFoliage ? "foliage" : "wood",
                                      reasons));
  }
}

}  // namespace verdure
