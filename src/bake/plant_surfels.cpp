#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "base/parallel.h"
#include "scene/scene.h"
#include "scene/texel_grid.h"
#include "verdure/error.h"
#include "verdure/optical_depth.h"

namespace verdure {
namespace {

using Uvs = std::array<glm::vec2, 3>;

/// Share of a triangle that the alpha cut leaves: of the middles of n^2 equal parts, two a texel.
float opaqueShare(const TexelGrid& texels, float cutoff, const Uvs& uv) {
  const glm::vec2 size(texels.width(), texels.height());
  float longest = 0.0f;
  for (std::size_t c = 0; c < 3; ++c)
    longest = std::max(longest, glm::length((uv[(c + 1) % 3] - uv[c]) * size));
  const int n = std::clamp(static_cast<int>(std::ceil(2.0f * std::min(longest, 64.0f))), 4, 64);
  int opaque = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n - i; ++j)
      for (int half = 0; half < (j + 1 < n - i ? 2 : 1); ++half) {
        const float third = half == 0 ? 1.0f / 3.0f : 2.0f / 3.0f;
        const float u = (static_cast<float>(i) + third) / static_cast<float>(n),
                    v = (static_cast<float>(j) + third) / static_cast<float>(n);
        const glm::vec2 at = uv[0] * (1.0f - u - v) + uv[1] * u + uv[2] * v;
        opaque += texels.alpha(at) >= 255.0f * cutoff ? 1 : 0;
      }
  return static_cast<float>(opaque) / static_cast<float>(n * n);
}

struct UvsHash {
  std::size_t operator()(const Uvs& uv) const {
    std::size_t hash = 1469598103934665603ull;
    for (const glm::vec2& p : uv)
      for (int a = 0; a < 2; ++a) {
        std::uint32_t bits;
        std::memcpy(&bits, &p[a], sizeof bits);
        hash = (hash ^ bits) * 1099511628211ull;
      }
    return hash;
  }
};

}  // namespace

std::vector<Surfel> plantSurfels(const Plant& plant) {
  std::vector<Surfel> surfels(triangleCount(plant));
  std::size_t base = 0;
  for (const Mesh& mesh : plant.meshes) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
      if (!std::isfinite(mesh.positions[i].x + mesh.positions[i].y + mesh.positions[i].z))
        throw Error(plant.name, fmt::format("position {} of part '{}' is not finite", i, mesh.name),
                    "export the plant again");
    for (const std::uint32_t i : mesh.indices)
      if (i >= mesh.positions.size())
        throw Error(plant.name,
                    fmt::format("an index of part '{}' points past its {} vertices", mesh.name,
                                mesh.positions.size()),
                    "export the plant again");
    const Material* const material =
        mesh.material < plant.materials.size() ? &plant.materials[mesh.material] : nullptr;
    const bool cut = material != nullptr && material->alpha_mode != AlphaMode::kOpaque &&
                     material->base_color_texture >= 0 && mesh.uvs.size() == mesh.positions.size();
    const TexelGrid texels =
        cut ? TexelGrid(textureOf(plant, material->base_color_texture)) : TexelGrid();
    const float cutoff = cut ? textureCutoff(*material) : 0.0f;
    const float factor = mesh.kind == PartKind::kWood ? 0.5f : 1.0f;
    parallelChunks(mesh.triangleCount(), 16384, [&](std::size_t begin, std::size_t end) {
      std::unordered_map<Uvs, float, UvsHash> known;  // leaves share their texture coordinates
      for (std::size_t t = begin; t < end; ++t) {
        const std::uint32_t* const corner = &mesh.indices[3 * t];
        const glm::vec3 &a = mesh.positions[corner[0]], &b = mesh.positions[corner[1]],
                        &c = mesh.positions[corner[2]];
        Surfel& out = surfels[base + t];
        out.position = (a + b + c) / 3.0f;
        out.area = factor * 0.5f * glm::length(glm::cross(b - a, c - a));
        out.extent =
            std::max(glm::length(a - out.position),
                     std::max(glm::length(b - out.position), glm::length(c - out.position)));
        if (!cut) continue;
        const Uvs uvs{mesh.uvs[corner[0]], mesh.uvs[corner[1]], mesh.uvs[corner[2]]};
        const auto [at, fresh] = known.try_emplace(uvs, 0.0f);
        if (fresh) at->second = opaqueShare(texels, cutoff, uvs);
        out.area *= at->second;
      }
    });
    base += mesh.triangleCount();
  }
  return surfels;
}

}  // namespace verdure
