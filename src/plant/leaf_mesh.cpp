#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "plant/tree_mesh.h"

namespace verdure {
namespace {

/// A leaf's vertices in units of its length and width, and its triangles: the same for all leaves
/// of a tree. x across, y along, both as on the texture; z above the blade, in lengths.
struct Pattern {
  std::vector<glm::vec2> uv;     ///< x in [-0.5, 0.5], y in [0, 1] from the foot
  std::vector<glm::vec3> place;  ///< x: widths, y and z: lengths; for needles see meshNeedles
  std::vector<std::uint32_t> indices;
};

/// Where the midrib, which turns downwards evenly by `curl` from foot to tip, is at y: (y, z) and
/// the direction of the blade's normal there.
struct Arc {
  glm::vec2 point, normal;
};
Arc onMidrib(float y, float curl) {
  if (std::abs(curl) < 1e-3f) return {{y, 0}, {0, 1}};
  // The chord from foot to tip stays along the leaf's axis.
  const float start = 0.5f * curl;
  const float a = start - curl * y;
  return {{(std::sin(start) - std::sin(a)) / curl, (std::cos(a) - std::cos(start)) / curl},
          {-std::sin(a), std::cos(a)}};
}

/// A blade: a hull around the outline, a fan of triangles about a point of the midrib. The two
/// halves are folded up along the midrib, which is curved.
Pattern bladePattern(LeafShape shape, const BladeForm& form, float leaf_scale_x) {
  const std::vector<glm::vec2> right = leafHull(shape);
  const float fold = form.fold_deg * 3.14159265f / 180;
  const float curl = form.curl_deg * 3.14159265f / 180;
  Pattern p;
  const auto add = [&](float x, float y) {
    const Arc arc = onMidrib(y, curl);
    const float lift = std::abs(x) * std::sin(fold) * leaf_scale_x;
    p.uv.emplace_back(x, y);
    p.place.emplace_back(x * std::cos(fold), arc.point.x + lift * arc.normal.x,
                         arc.point.y + lift * arc.normal.y);
  };
  add(0, 0.5f * (right.front().y + right.back().y));  // the fan's centre
  add(0, 0);
  for (const glm::vec2& v : right) add(v.x, v.y);
  add(0, 1);
  for (auto v = right.rbegin(); v != right.rend(); ++v) add(-v->x, v->y);
  const auto rim = static_cast<std::uint32_t>(p.uv.size()) - 1;
  // Seen from +z with x to the right and y upwards, the rim runs counter-clockwise.
  for (std::uint32_t k = 0; k < rim; ++k)
    p.indices.insert(p.indices.end(), {0, 1 + k, 1 + (k + 1) % rim});
  return p;
}

/// One quad.
Pattern cardPattern() {
  Pattern p;
  for (const glm::vec2 c : {glm::vec2(-0.5f, 0), {0.5f, 0}, {0.5f, 1}, {-0.5f, 1}}) {
    p.uv.push_back(c);
    p.place.emplace_back(c.x, c.y, 0.0f);
  }
  p.indices = {0, 1, 2, 0, 2, 3};
  return p;
}

/// A shoot with needles: three half planes, 120 degrees apart, that share the shoot as an edge.
Pattern needlePattern() {
  Pattern p;
  p.uv = {{0, 0}, {0, 1}};
  p.place = {{0, 0, 0}, {0, 1, 0}};
  for (int k = 0; k < 3; ++k) {
    const float angle = 0.5236f + 2.0943951f * static_cast<float>(k);
    const float c = std::cos(angle), s = std::sin(angle);
    const float side = k == 1 ? -0.5f : 0.5f;
    const auto first = static_cast<std::uint32_t>(p.uv.size());
    for (const float y : {0.0f, 1.0f}) {
      p.uv.emplace_back(side, y);
      p.place.emplace_back(0.5f * c, y, 0.5f * s);  // z in widths here
    }
    p.indices.insert(p.indices.end(), {0, first, first + 1, 0, first + 1, 1});
  }
  return p;
}

}  // namespace

Mesh meshLeaves(const Skeleton& skeleton, LeafShape shape, const BladeForm& form,
                LeafForm leaf_form, std::uint32_t mesh_index, Plant& plant) {
  const std::vector<LeafPlace>& places = skeleton.leaves;
  const bool card = leaf_form == LeafForm::kCard;
  const bool needles = shape == LeafShape::kNeedles && !card;
  const float leaf_scale_x = places.empty() ? 1.0f : places[0].width / places[0].length;
  const Pattern pattern = card      ? cardPattern()
                          : needles ? needlePattern()
                                    : bladePattern(shape, form, leaf_scale_x);
  const std::size_t vertices = pattern.uv.size();
  const std::size_t corners = pattern.indices.size();
  const std::size_t triangles = corners / 3;

  Mesh mesh;
  mesh.name = "foliage";
  mesh.kind = PartKind::kFoliage;
  mesh.positions.resize(places.size() * vertices);
  mesh.normals.resize(places.size() * vertices);
  mesh.uvs.resize(places.size() * vertices);
  mesh.indices.resize(places.size() * corners);
  const std::size_t first_leaf = plant.leaves.size();
  const std::size_t first_triangle = plant.leaf_triangles.size();
  plant.leaves.resize(first_leaf + places.size());
  plant.leaf_triangles.resize(first_triangle + places.size() * triangles);

  parallelFor(places.size(), 512, [&](std::size_t i) {
    const LeafPlace& place = places[i];
    const glm::mat3 frame(glm::mat3_cast(place.frame));
    const std::uint32_t variant = place.noise & 3u;
    // Each leaf curls a little differently: 0.6 to 1.4 times the pattern's height.
    const float height =
        needles
            ? place.width
            : place.length * (0.6f + 0.8f * static_cast<float>((place.noise >> 8) & 255u) / 255);
    const std::size_t v0 = i * vertices;
    for (std::size_t v = 0; v < vertices; ++v) {
      const glm::vec3& q = pattern.place[v];
      // Leaf axes: x across, y = upper side, z along; the pattern's z goes to y.
      mesh.positions[v0 + v] = place.position + frame[0] * (-q.x * place.width) +
                               frame[1] * (q.z * height) + frame[2] * (q.y * place.length);
      const glm::vec2 cell(static_cast<float>(variant & 1u), static_cast<float>(variant >> 1));
      mesh.uvs[v0 + v] = 0.5f * (cell + glm::vec2(pattern.uv[v].x + 0.5f, 1 - pattern.uv[v].y));
    }
    Leaf leaf;
    leaf.mesh = mesh_index;
    leaf.first_triangle = static_cast<std::uint32_t>(first_triangle + i * triangles);
    leaf.triangle_count = static_cast<std::uint32_t>(triangles);
    leaf.branch = place.branch;
    leaf.stalk = place.position;
    std::array<glm::vec3, 16> sums{};
    glm::vec3 weighted(0);
    for (std::size_t t = 0; t < triangles; ++t) {
      std::uint32_t local[3];
      for (std::size_t k = 0; k < 3; ++k) {
        local[k] = pattern.indices[3 * t + k];
        mesh.indices[i * corners + 3 * t + k] = static_cast<std::uint32_t>(v0) + local[k];
      }
      plant.leaf_triangles[leaf.first_triangle + t] = static_cast<std::uint32_t>(i * triangles + t);
      const glm::vec3& a = mesh.positions[v0 + local[0]];
      const glm::vec3& b = mesh.positions[v0 + local[1]];
      const glm::vec3& c = mesh.positions[v0 + local[2]];
      const glm::vec3 twice = glm::cross(b - a, c - a);
      const float area = 0.5f * glm::length(twice);
      leaf.area += area;
      weighted += area / 3 * (a + b + c);
      for (const std::uint32_t l : local) sums[l] += twice;
    }
    leaf.centroid = weighted / leaf.area;
    for (std::size_t v = 0; v < vertices; ++v) {
      glm::vec3 normal = glm::normalize(sums[v]);
      if (needles) {
        // A tuft is round: normals point away from a place behind its foot.
        const glm::vec3& q = pattern.place[v];
        normal = glm::normalize(frame[0] * (-q.x * 2) + frame[1] * (q.z * 2) +
                                frame[2] * (0.35f + 0.65f * q.y));
      }
      mesh.normals[v0 + v] = normal;
    }
    plant.leaves[first_leaf + i] = leaf;
  });
  return mesh;
}

}  // namespace verdure
