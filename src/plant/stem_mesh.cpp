#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "plant/tree_mesh.h"

namespace verdure {
namespace {

constexpr float kTwoPi = 6.28318530717958f;

/// Number of vertices around a stem with this radius at its base.
int sidesOf(float radius) {
  if (radius < 0.006f) return 3;
  if (radius < 0.014f) return 4;
  if (radius < 0.03f) return 6;
  if (radius < 0.06f) return 8;
  if (radius < 0.12f) return 12;
  return 16;
}

/// What one stem adds to the mesh.
struct Extent {
  int sides = 3;
  std::uint32_t rings = 0;
  std::uint32_t first_vertex = 0, first_index = 0;

  std::uint32_t column() const { return static_cast<std::uint32_t>(sides) + 1; }
  std::uint32_t vertices() const { return rings * column() + 2; }
  std::uint32_t indices() const {
    return 6 * static_cast<std::uint32_t>(sides) * (rings - 1) +
           6 * static_cast<std::uint32_t>(sides);
  }
};

class StemMesher {
 public:
  StemMesher(const Stem& stem, std::uint32_t number, const Extent& extent, float lobes,
             float lobe_depth, float bark_width, Mesh& mesh)
      : stem_(stem),
        number_(number),
        extent_(extent),
        lobes_(lobes),
        depth_(lobe_depth),
        bark_width_(bark_width),
        mesh_(mesh) {}

  void build() {
    transportFrames();
    placeRings();
    placeCaps();
    connect();
  }

 private:
  std::size_t rings() const { return extent_.rings; }

  glm::vec3 directionAt(std::size_t i) const {
    const auto& p = stem_.points;
    const glm::vec3 before = i > 0 ? p[i].position - p[i - 1].position : glm::vec3(0);
    const glm::vec3 after = i + 1 < p.size() ? p[i + 1].position - p[i].position : glm::vec3(0);
    const float lb = glm::length(before), la = glm::length(after);
    if (lb <= 0) return after / la;
    if (la <= 0) return before / lb;
    const glm::vec3 sum = before / lb + after / la;
    const float ls = glm::length(sum);
    return ls > 1e-3f ? sum / ls : before / lb;
  }

  /// Frames without twist along the stem (parallel transport), so that the bark runs straight.
  void transportFrames() {
    const std::size_t n = stem_.points.size();
    directions_.resize(n);
    normals_.resize(n);
    for (std::size_t i = 0; i < n; ++i) directions_[i] = directionAt(i);
    if (stem_.level == 0 && stem_.start == 0) directions_[0] = glm::vec3(0, 1, 0);
    glm::vec3 normal = stem_.frames[0] * glm::vec3(1, 0, 0);
    for (std::size_t i = 0; i < n; ++i) {
      glm::vec3 next = normal - directions_[i] * glm::dot(normal, directions_[i]);
      if (glm::dot(next, next) < 1e-8f) {
        const glm::vec3 other =
            std::abs(directions_[i].x) < 0.6f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
        next = glm::cross(directions_[i], other);
      }
      normal = glm::normalize(next);
      normals_[i] = normal;
    }
  }

  void put(std::uint32_t vertex, const glm::vec3& position, const glm::vec3& normal,
           const glm::vec2& uv) {
    const std::size_t v = extent_.first_vertex + vertex;
    mesh_.positions[v] = position;
    mesh_.normals[v] = normal;
    mesh_.uvs[v] = uv;
    mesh_.branch_of_vertex[v] = number_;
  }

  void placeRings() {
    const auto& points = stem_.points;
    // Flare and splits change neither the count nor the scale: clones go on like their original.
    const float usual = stem_.radius;
    const float repeats = std::max(1.0f, std::round(kTwoPi * usual / bark_width_));
    float v = stem_.start * repeats / (kTwoPi * usual);
    const auto sides = static_cast<std::uint32_t>(extent_.sides);
    for (std::size_t i = 0; i < rings(); ++i) {
      const float radius = points[i].radius;
      if (i > 0) {
        const float mean = 0.5f * (radius + points[i - 1].radius);
        // Towards the tip the bark would shrink without end.
        const float around = kTwoPi * std::max(mean, 0.45f * usual);
        v += glm::length(points[i].position - points[i - 1].position) * repeats / around;
      }
      const std::size_t before = i > 0 ? i - 1 : 0;
      const std::size_t after = std::min(i + 1, points.size() - 1);
      const float run = glm::length(points[after].position - points[before].position);
      const float slope = std::clamp(
          (points[after].radius - points[before].radius) / std::max(run, 1e-6f), -3.0f, 3.0f);
      const glm::vec3& along = directions_[i];
      const glm::vec3& n = normals_[i];
      const glm::vec3 b = glm::cross(along, n);
      for (std::uint32_t s = 0; s <= sides; ++s) {
        // The seam's second vertex takes the very position of the first.
        const float angle = kTwoPi * static_cast<float>(s % sides) / static_cast<float>(sides);
        const float c = std::cos(angle), d = std::sin(angle);
        const float bulge = 1 + depth_ * std::sin(lobes_ * angle);
        const float bulge_slope = depth_ * lobes_ * std::cos(lobes_ * angle);
        const glm::vec3 radial = c * n + d * b;
        const glm::vec3 around = c * b - d * n;
        const glm::vec3 normal =
            glm::normalize(radial - slope * along - (bulge_slope / bulge) * around);
        put(static_cast<std::uint32_t>(i) * extent_.column() + s,
            points[i].position + radius * bulge * radial, normal,
            {repeats * static_cast<float>(s) / static_cast<float>(sides), -v});
      }
    }
    last_v_ = v;
  }

  void placeCaps() {
    const auto& points = stem_.points;
    const std::uint32_t foot = extent_.rings * extent_.column();
    put(foot, points[0].position, -directions_[0], {0.5f, 0.0f});
    // A pointed stem ends where its axis ends; a blunt one gets a low dome.
    glm::vec3 tip = points.back().position;
    if (rings() == points.size()) tip += directions_.back() * (0.4f * points.back().radius);
    put(foot + 1, tip, directions_.back(), {0.5f, -last_v_});
  }

  void connect() {
    std::uint32_t* out = mesh_.indices.data() + extent_.first_index;
    const std::uint32_t first = extent_.first_vertex;
    const std::uint32_t column = extent_.column();
    const std::uint32_t foot = first + extent_.rings * column;
    const auto triangle = [&out](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      *out++ = a;
      *out++ = b;
      *out++ = c;
    };
    const auto sides = static_cast<std::uint32_t>(extent_.sides);
    for (std::uint32_t s = 0; s < sides; ++s) triangle(foot, first + s + 1, first + s);
    for (std::uint32_t r = 0; r + 1 < extent_.rings; ++r)
      for (std::uint32_t s = 0; s < sides; ++s) {
        const std::uint32_t a = first + r * column + s;
        triangle(a, a + 1, a + column + 1);
        triangle(a, a + column + 1, a + column);
      }
    const std::uint32_t top = first + (extent_.rings - 1) * column;
    for (std::uint32_t s = 0; s < sides; ++s) triangle(top + s, top + s + 1, foot + 1);
  }

  const Stem& stem_;
  std::uint32_t number_;
  Extent extent_;
  float lobes_, depth_, bark_width_;
  Mesh& mesh_;
  std::vector<glm::vec3> directions_, normals_;
  float last_v_ = 0;
};

}  // namespace

Mesh meshStems(const Skeleton& skeleton, const TreeParameters& parameters, float bark_width,
               float min_radius, float max_radius) {
  const std::vector<Stem>& stems = skeleton.stems;
  std::vector<std::uint32_t> chosen;
  std::vector<Extent> extents;
  std::uint32_t vertices = 0, indices = 0;
  for (std::size_t i = 0; i < stems.size(); ++i) {
    const Stem& stem = stems[i];
    const float radius = stem.points[0].radius;
    if (radius < min_radius || radius >= max_radius) continue;
    Extent e;
    e.sides = sidesOf(radius);
    if (stem.level == 0)
      e.sides = std::max(e.sides, std::min(32, 4 * static_cast<int>(parameters.lobes)));
    // A stem that tapers to (almost) nothing ends in the cap's point instead of a ring.
    const bool pointed = stem.points.back().radius < 0.05f * radius;
    e.rings = static_cast<std::uint32_t>(stem.points.size()) - (pointed ? 1 : 0);
    e.first_vertex = vertices;
    e.first_index = indices;
    vertices += e.vertices();
    indices += e.indices();
    chosen.push_back(static_cast<std::uint32_t>(i));
    extents.push_back(e);
  }
  Mesh mesh;
  mesh.kind = PartKind::kWood;
  mesh.positions.resize(vertices);
  mesh.normals.resize(vertices);
  mesh.uvs.resize(vertices);
  mesh.branch_of_vertex.resize(vertices);
  mesh.indices.resize(indices);
  parallelFor(chosen.size(), 64, [&](std::size_t i) {
    const Stem& stem = stems[chosen[i]];
    const bool trunk = stem.level == 0;
    StemMesher(stem, chosen[i], extents[i], trunk ? parameters.lobes : 0.0f,
               trunk ? parameters.lobe_depth : 0.0f, bark_width, mesh)
        .build();
  });
  return mesh;
}

}  // namespace verdure
