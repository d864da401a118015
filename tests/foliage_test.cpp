// Leaves of grown plants: the atlas of variants, the polygons around them, and what grow() makes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "leaf/leaf_atlas.h"
#include "plant/leaf_shape.h"
#include "verdure/error.h"
#include "verdure/grow.h"
#include "verdure/leaf_grow.h"

namespace verdure {
namespace {

double sumOf(const std::vector<float>& map) {
  return std::accumulate(map.begin(), map.end(), 0.0);
}

/// Whether p lies in the closed polygon.
bool holds(const std::vector<glm::vec2>& polygon, const glm::vec2& p) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const glm::vec2 &a = polygon[i], &b = polygon[j];
    if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x)
      inside = !inside;
  }
  return inside;
}

LeafHull hullOf(const LeafAtlas& atlas, const LeafAtlas::Variant& variant) {
  return leafHull(variant.points, variant.foot, atlas.cell_width - variant.foot);
}

std::vector<glm::vec2> polygonOf(const LeafHull& hull) {
  return {{0, 0}, hull.right[0], hull.right[1], hull.tip, hull.left[1], hull.left[0]};
}

class Atlas : public testing::TestWithParam<int> {
 protected:
  LeafShape shape() const { return static_cast<LeafShape>(GetParam()); }
  LeafAtlas grown(int size) const { return growLeafAtlas(leafSpeciesOf(shape()), size, 0.4f); }
};
INSTANTIATE_TEST_SUITE_P(Foliage, Atlas, testing::Range(0, kLeafShapeCount));

TEST_P(Atlas, KeepsItsLeavesInTheirCells) {
  const LeafAtlas atlas = grown(256);
  ASSERT_EQ(atlas.columns * atlas.rows, kLeafVariants);
  ASSERT_EQ(atlas.variants.size(), static_cast<std::size_t>(kLeafVariants));
  EXPECT_EQ(atlas.set.width, 256);
  const int width = atlas.set.width / atlas.columns, height = atlas.set.height / atlas.rows;
  EXPECT_FLOAT_EQ(atlas.cell_width, static_cast<float>(width) / static_cast<float>(height));
  for (int k = 0; k < kLeafVariants; ++k) {
    const LeafSet cell =
        cropLeaf(atlas.set, k % atlas.columns * width, k / atlas.columns * height, width, height);
    // Nothing at the sides and at the top; the stalk's foot where it is said to be.
    for (int y = 0; y < height; ++y) {
      EXPECT_EQ(cell.opacity[static_cast<std::size_t>(y * width)], 0) << k << " row " << y;
      EXPECT_EQ(cell.opacity[static_cast<std::size_t>(y * width + width - 1)], 0) << k;
    }
    for (int x = 0; x < width; ++x) EXPECT_EQ(cell.opacity[static_cast<std::size_t>(x)], 0) << k;
    const LeafAtlas::Variant& variant = atlas.variants[static_cast<std::size_t>(k)];
    const auto foot =
        static_cast<std::size_t>(variant.foot / atlas.cell_width * static_cast<float>(width));
    const std::size_t last = static_cast<std::size_t>((height - 1) * width);
    EXPECT_GT(cell.opacity[last + foot] + cell.opacity[last + foot - 1], 0.5f) << k;

    // The maps lie where the points say: the polygon around these holds the leaf, and not much
    // else.
    const LeafHull hull = hullOf(atlas, variant);
    const std::vector<glm::vec2> polygon = polygonOf(hull);
    double within = 0, area = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const glm::vec2 p(
            (static_cast<float>(x) + 0.5f) / static_cast<float>(height) - variant.foot,
            1 - (static_cast<float>(y) + 0.5f) / static_cast<float>(height));
        if (!holds(polygon, p)) continue;
        within += cell.opacity[static_cast<std::size_t>(y * width + x)];
        area += 1;
      }
    const bool needles = shape() == LeafShape::kNeedles;
    EXPECT_GT(within / sumOf(cell.opacity), needles ? 0.3 : 0.975) << k;
    EXPECT_GT(within / area, needles || shape() == LeafShape::kPalmate ? 0.3 : 0.5) << k;
  }
}

TEST_P(Atlas, HoldsLeavesOfOneScale) {
  const int size = 128;
  const std::string species = leafSpeciesOf(shape());
  const std::vector<LeafSet> leaves = growLeaves({species, 1, size, 0.4f}, kLeafVariants);
  ASSERT_EQ(leaves.size(), static_cast<std::size_t>(kLeafVariants));
  for (std::size_t k = 0; k < leaves.size(); ++k) {
    EXPECT_EQ(leaves[k].mm_per_texel, leaves[0].mm_per_texel);
    // A leaf is as large in the common frame as in its own.
    const LeafSet alone = growLeaf({species, static_cast<std::uint32_t>(1 + k), size, 0.4f});
    const auto area = [](const LeafSet& set) {
      return sumOf(set.opacity) * static_cast<double>(set.mm_per_texel * set.mm_per_texel);
    };
    EXPECT_NEAR(area(leaves[k]) / area(alone), 1, 0.02) << k;
    EXPECT_LE(alone.mm_per_texel, leaves[k].mm_per_texel * 1.0001f);
  }
  const LeafSet first = growLeaf({species, 1, size, 0.4f});
  const LeafSet same = growLeaves({species, 1, size, 0.4f}, 1).front();
  EXPECT_EQ(first.opacity, same.opacity);
  EXPECT_EQ(first.front.albedo, same.front.albedo);
}

TEST_P(Atlas, HullKeepsAllButTheEnds) {
  const LeafAtlas atlas = grown(32);
  if (shape() == LeafShape::kNeedles) GTEST_SKIP() << "shoots are crossed strips";
  for (const LeafAtlas::Variant& variant : atlas.variants) {
    const LeafHull hull = hullOf(atlas, variant);
    std::vector<glm::vec2> polygon = polygonOf(hull);
    const glm::vec2 middle = 0.5f * hull.tip;
    for (glm::vec2& p : polygon) p += 0.012f * glm::normalize(p - middle);
    for (const glm::vec2& p : variant.points) {
      const float along = p.y / hull.tip.y;
      if (along < 0.05f || along > 0.98f) continue;
      EXPECT_TRUE(holds(polygon, p)) << p.x << ", " << p.y;
    }
    for (const glm::vec2& p : polygonOf(hull)) {
      EXPECT_GE(p.x, -variant.foot - 1e-5f);
      EXPECT_LE(p.x, atlas.cell_width - variant.foot + 1e-5f);
    }
  }
}

TEST(Foliage, TileAndCropAreInverse) {
  std::vector<LeafSet> leaves = growLeaves({"hedge", 3, 64, 0.7f}, 3);
  const LeafSet atlas = tileLeaves(leaves, 2);
  for (int k = 0; k < 3; ++k) {
    const LeafSet cell = cropLeaf(atlas, k % 2 * 64, k / 2 * 64, 64, 64);
    const LeafSet& leaf = leaves[static_cast<std::size_t>(k)];
    EXPECT_EQ(cell.front.albedo, leaf.front.albedo);
    EXPECT_EQ(cell.back.normal, leaf.back.normal);
    EXPECT_EQ(cell.back.relief_mm, leaf.back.relief_mm);
    EXPECT_EQ(cell.thickness_mm, leaf.thickness_mm);
    EXPECT_EQ(cell.opacity, leaf.opacity);
    EXPECT_EQ(cell.mm_per_texel, leaf.mm_per_texel);
  }
  EXPECT_THROW(cropLeaf(atlas, 0, 0, 129, 1), Error);
  EXPECT_THROW(cropLeaf(atlas, -1, 0, 1, 1), Error);
  EXPECT_THROW(cropLeaf(atlas, 0, 0, 0, 1), Error);
  EXPECT_THROW(growLeaves({"hedge", 1, 64, 0.4f}, 0), Error);
}

TEST(Foliage, HasMapsAndTheLightThroughThem) {
  for (const SpeciesInfo& species : speciesList()) {
    GrowOptions options;
    options.species = species.name;
    options.texture_size = 64;
    const Plant plant = grow(options);
    int foliage = 0;
    for (const Mesh& mesh : plant.meshes) {
      const Material& material = plant.materials[mesh.material];
      EXPECT_EQ(mesh.name, material.name);
      if (mesh.kind != PartKind::kFoliage) {
        EXPECT_FALSE(material.leaf.has_value());
        continue;
      }
      ++foliage;
      ASSERT_TRUE(material.leaf.has_value());
      for (const int texture : {material.base_color_texture, material.normal_texture,
                                material.leaf->back_color, material.leaf->back_normal,
                                material.leaf->front_translucency, material.leaf->back_translucency,
                                material.leaf->front_light, material.leaf->back_light}) {
        ASSERT_GE(texture, 0);
        ASSERT_LT(texture, static_cast<int>(plant.textures.size()));
      }
      // The share of leaf in what its triangles show.
      const Image& image =
          plant.textures[static_cast<std::size_t>(material.base_color_texture)].image;
      for (const glm::vec2& uv : mesh.uvs) {
        ASSERT_GE(uv.x, 0);
        ASSERT_LE(uv.x, 1);
        ASSERT_GE(uv.y, 0);
        ASSERT_LE(uv.y, 1);
      }
      // Six points of each triangle.
      double leaf = 0;
      const float far = 0.8168476f, near = 0.0915762f, half = 0.4459485f, rest = 0.1081030f;
      const glm::vec3 places[] = {{far, near, near},  {near, far, near},  {near, near, far},
                                  {rest, half, half}, {half, rest, half}, {half, half, rest}};
      for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t)
        for (const glm::vec3& place : places) {
          glm::vec2 uv(0);
          for (std::uint32_t c = 0; c < 3; ++c)
            uv += place[static_cast<int>(c)] * mesh.uvs[mesh.indices[3 * t + c]];
          leaf += image.at(static_cast<int>(uv.x * static_cast<float>(image.width)),
                           static_cast<int>(uv.y * static_cast<float>(image.height)))[3] >= 128;
        }
      EXPECT_GT(leaf / (6.0 * static_cast<double>(mesh.triangleCount())), 0.35) << species.name;
    }
    EXPECT_EQ(foliage, 1);
  }
}

TEST(Foliage, IsAsWideAsAsked) {
  // LeafScaleX is the width of a leaf by its length: twice as much makes cards twice as wide.
  const auto widthOf = [](const char* scale) {
    GrowOptions options;
    options.species = "hedge";
    options.texture_size = 128;
    options.leaf_form = LeafForm::kCard;
    options.set = {{"LeafScaleX", scale}};
    const Plant plant = grow(options);
    const Mesh& mesh = plant.meshes[1];
    float sum = 0, cards = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); v += 4, ++cards)
      sum += glm::length(mesh.positions[v + 1] - mesh.positions[v]) /
             glm::length(mesh.positions[v + 2] - mesh.positions[v + 1]);
    return sum / cards;
  };
  const float one = widthOf("0.4"), two = widthOf("0.8");
  EXPECT_NEAR(one, 0.4f, 0.01f);  // the variants' mean, as often as the tree has them
  EXPECT_NEAR(two, 0.8f, 0.02f);
}

TEST(Foliage, TurnsInAutumn) {
  const auto redness = [](float age) {
    GrowOptions options;
    options.species = "quaking-aspen";
    options.texture_size = 64;
    options.leaf_age = age;
    const Plant plant = grow(options);
    const Material& material = plant.materials[plant.meshes[1].material];
    const Image& image =
        plant.textures[static_cast<std::size_t>(material.base_color_texture)].image;
    double red = 0, green = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        if (image.at(x, y)[3] >= 128) {
          red += image.at(x, y)[0];
          green += image.at(x, y)[1];
        }
    return red / green;
  };
  EXPECT_LT(redness(0.4f), 0.9);
  EXPECT_GT(redness(1.0f), 1.0);
  GrowOptions bad;
  bad.leaf_age = 1.5f;
  EXPECT_THROW(grow(bad), Error);
}

}  // namespace
}  // namespace verdure
