#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "plant/leaf_shape.h"
#include "plant/tree_mesh.h"

namespace verdure {
namespace {

/// The vertices of one variant of a leaf, and its triangles: the same for all its leaves.
struct Pattern {
  std::vector<glm::vec2> uv;     ///< in the texture
  std::vector<glm::vec3> place;  ///< from the stalk's foot in lengths: across, along, z above
  std::vector<std::uint32_t> indices;
};

/// Where the points of a leaf, from its foot in cell heights, are on the texture.
struct LeafCell {
  const LeafAtlas& atlas;
  std::size_t variant;

  glm::vec2 uv(const glm::vec2& p) const {
    const auto k = static_cast<int>(variant);
    const glm::vec2 corner(k % atlas.columns, k / atlas.columns);
    const glm::vec2 within((atlas.variants[variant].foot + p.x) / atlas.cell_width, 1 - p.y);
    return (corner + within) / glm::vec2(atlas.columns, atlas.rows);
  }
  float reachLeft() const { return atlas.variants[variant].foot; }
  float reachRight() const { return atlas.cell_width - atlas.variants[variant].foot; }
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

/// A blade: a hull around the leaf, a fan of triangles about a point of its axis. The two halves
/// are folded up along the axis, which is curved.
Pattern bladePattern(const LeafCell& cell, const BladeForm& form, float stretch) {
  const LeafHull hull =
      leafHull(cell.atlas.variants[cell.variant].points, cell.reachLeft(), cell.reachRight());
  const float fold = form.fold_deg * 3.14159265f / 180;
  const float curl = form.curl_deg * 3.14159265f / 180;
  Pattern p;
  const auto add = [&](const glm::vec2& v) {
    const Arc arc = onMidrib(v.y, curl);
    const float axis = hull.tip.x * v.y / hull.tip.y, side = v.x - axis;
    const float lift = std::abs(side) * std::sin(fold) * stretch;
    p.uv.push_back(cell.uv(v));
    p.place.emplace_back((axis + side * std::cos(fold)) * stretch,
                         arc.point.x + lift * arc.normal.x, arc.point.y + lift * arc.normal.y);
  };
  const float middle =
      0.25f * (hull.right[0].y + hull.right[1].y + hull.left[0].y + hull.left[1].y);
  add(hull.tip * (middle / hull.tip.y));  // the fan's centre
  add({0, 0});
  for (const glm::vec2& v : hull.right) add(v);
  add(hull.tip);
  for (auto v = hull.left.rbegin(); v != hull.left.rend(); ++v) add(*v);
  const auto rim = static_cast<std::uint32_t>(p.uv.size()) - 1;
  // Seen from +z with x to the right and y upwards, the rim runs counter-clockwise.
  for (std::uint32_t k = 0; k < rim; ++k)
    p.indices.insert(p.indices.end(), {0, 1 + k, 1 + (k + 1) % rim});
  return p;
}

/// How far a leaf reaches to both sides of its foot, and up, in cell heights.
struct Box {
  float left = 0, right = 0, top = 0;
  explicit Box(const LeafCell& cell) {
    for (const glm::vec2& p : cell.atlas.variants[cell.variant].points) {
      left = std::min(left, p.x);
      right = std::max(right, p.x);
      top = std::max(top, p.y);
    }
    left = std::max(left, -cell.reachLeft());
    right = std::min(right, cell.reachRight());
    top = std::min(top, 1.0f);
  }
};

/// One quad.
Pattern cardPattern(const LeafCell& cell, float stretch) {
  Pattern p;
  const Box box(cell);
  for (const glm::vec2 c :
       {glm::vec2(box.left, 0), {box.right, 0}, {box.right, box.top}, {box.left, box.top}}) {
    p.uv.push_back(cell.uv(c));
    p.place.emplace_back(c.x * stretch, c.y, 0.0f);
  }
  p.indices = {0, 1, 2, 0, 2, 3};
  return p;
}

/// A shoot with needles: three half planes, 120 degrees apart, that share the shoot as an edge.
Pattern needlePattern(const LeafCell& cell, float stretch) {
  Pattern p;
  const Box box(cell);
  p.uv = {cell.uv({0, 0}), cell.uv({0, box.top})};
  p.place = {{0, 0, 0}, {0, box.top, 0}};
  for (int k = 0; k < 3; ++k) {
    const float angle = 0.5236f + 2.0943951f * static_cast<float>(k);
    const float c = std::cos(angle), s = std::sin(angle);
    const float side = k == 1 ? box.left : box.right;
    const float wide = std::abs(side) * stretch;
    const auto first = static_cast<std::uint32_t>(p.uv.size());
    for (const float y : {0.0f, box.top}) {
      p.uv.push_back(cell.uv({side, y}));
      p.place.emplace_back(wide * c, y, wide * s);
    }
    p.indices.insert(p.indices.end(), {0, first, first + 1, 0, first + 1, 1});
  }
  return p;
}

}  // namespace

Mesh meshLeaves(const Skeleton& skeleton, const LeafAtlas& atlas, const BladeForm& form,
                LeafForm leaf_form, bool shoots, std::uint32_t mesh_index, Plant& plant) {
  const std::vector<LeafPlace>& places = skeleton.leaves;
  const bool card = leaf_form == LeafForm::kCard;
  const bool needles = shoots && !card;
  const float stretch =
      places.empty() ? 1.0f : places[0].width / places[0].length / atlas.natural_width;
  std::vector<Pattern> patterns;
  for (std::size_t k = 0; k < kLeafVariants; ++k) {
    const LeafCell cell{atlas, k};
    patterns.push_back(card      ? cardPattern(cell, stretch)
                       : needles ? needlePattern(cell, stretch)
                                 : bladePattern(cell, form, stretch));
  }
  const std::size_t vertices = patterns[0].uv.size();
  const std::size_t corners = patterns[0].indices.size();
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
    const Pattern& pattern = patterns[place.noise % kLeafVariants];
    // Each leaf curls a little differently: 0.6 to 1.4 times the pattern's height.
    const float height =
        needles
            ? place.length
            : place.length * (0.6f + 0.8f * static_cast<float>((place.noise >> 8) & 255u) / 255);
    const std::size_t v0 = i * vertices;
    for (std::size_t v = 0; v < vertices; ++v) {
      const glm::vec3& q = pattern.place[v];
      // Leaf axes: x across, y = upper side, z along; the pattern's z goes to y.
      mesh.positions[v0 + v] = place.position + frame[0] * (-q.x * place.length) +
                               frame[1] * (q.z * height) + frame[2] * (q.y * place.length);
      mesh.uvs[v0 + v] = pattern.uv[v];
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
