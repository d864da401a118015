// Traced grass against its slices as polygons.
#include "render/grass_billboards.h"

#include <cstdlib>

#include "grass_sets.h"
#include "render/frame.h"
#include "render_fixture.h"
#include "verdure/compare.h"

namespace verdure {
namespace {

using namespace test;

/// Mesa's software driver takes one level of detail for four pixels unless told otherwise, although
/// each has its own.
[[maybe_unused]] const int kOwnLevels = setenv("GALLIVM_PERF", "no_quad_lod", 0);

/// A level meadow from near, with a card that stands in it.
class Meadow {
 public:
  Meadow() : device_("", true), drawer_(device_), set_(smallSet()), card_(whiteQuad()) {
    card_.meshes[0] = {};
    addQuad(card_.meshes[0], {0.1f, -0.1f, 0.3f}, {0.3f, 0.0f, 0.2f}, {0.0f, 0.5f, 0.0f});
    view_ = smallView(320, 240);
    view_.hdr = false;
    view_.terms = presetTerms("habel");
    view_.camera = {{0.2f, 0.75f, 1.7f}, {0.0f, 0.0f, 0.1f}, 0.6f};
    view_.exposure.ev = 14.5f;
    view_.exposure.white = 4.0f;
    view_.bloom = 0.0f;
  }
  ~Meadow() { EXPECT_EQ(device_.validationMessages(), 0); }

  View& view() { return view_; }
  const GrassBillboards& billboards() const { return drawer_.billboards(); }

  Image draw(const std::optional<BillboardTrial>& trial, float scatter = 0.6f) {
    Scene scene;
    scene.items.push_back({.plant = &card_, .world_from_plant = {glm::mat4(1.0f)}});
    GrassLayer layer;
    layer.set = &set_;
    layer.density = 0.8f;
    layer.scatter = scatter;
    layer.most_slices = 256;
    layer.middle = layer.medium = layer.blades = false;
    scene.grass = {layer};
    GpuScene packed(device_, packScene(scene), drawer_.sceneLayouts());
    drawer_.forgetScene();
    drawer_.tryBillboards(trial);
    return drawer_.draw(packed, view_).image;
  }

 private:
  gpu::Device device_;
  FrameDrawer drawer_;
  GrassSet set_;
  Plant card_;
  View view_;
};

TEST(GrassBillboards, LookLikeRays) {
  Meadow meadow;
  const Image rays = meadow.draw(std::nullopt);
  // Edges of polygons have four samples a pixel, rays one.
  EXPECT_LT(meanFlip(rays, meadow.draw(BillboardTrial{.radius_m = 9.0f, .cut = true})), 0.04);
  const std::uint32_t pieces = meadow.billboards().count();
  // Those a tile long cross each other: no order is right.
  EXPECT_LT(meanFlip(rays, meadow.draw(BillboardTrial{.radius_m = 9.0f})), 0.08);
  EXPECT_LT(5 * meadow.billboards().count(), pieces);
  // What another meadow of the same plants would be.
  EXPECT_GT(meanFlip(rays, meadow.draw(std::nullopt, 0.3f)), 0.08);
}

TEST(GrassBillboards, EndAtTheirRadius) {
  Meadow meadow;
  meadow.draw(BillboardTrial{.radius_m = 9.0f});
  const std::uint32_t all = meadow.billboards().count();
  meadow.draw(BillboardTrial{.radius_m = 1.5f});
  EXPECT_LT(meadow.billboards().count(), all / 4);
  EXPECT_GT(meadow.billboards().count(), 0u);
  // A pixel's slices one behind the other grow with the square of the distance.
  meadow.draw(BillboardTrial{});
  const float radius = meadow.billboards().radius();
  meadow.view().camera.eye.y *= 4.0f;
  meadow.draw(BillboardTrial{});
  EXPECT_NEAR(meadow.billboards().radius(), 2.0f * radius, 1e-3f * radius);
  // None at all: the ground alone.
  meadow.view().camera.target.y = 100.0f;
  meadow.draw(BillboardTrial{});
  EXPECT_EQ(meadow.billboards().count(), 0u);
}

}  // namespace
}  // namespace verdure
