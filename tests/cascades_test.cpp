#include "render/cascades.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "base/random.h"
#include "render/frame.h"
#include "render_fixture.h"
#include "verdure/compare.h"

namespace verdure {
namespace {

using namespace test;

const Bounds kPark{{-200, 0, -200}, {200, 12, 200}};

CascadeRequest parkRequest(int count) {
  return {.camera = {{5, 1.7f, 3}, {5, 1.5f, -7}, 0.6f},
          .width = 640,
          .height = 480,
          .bounds = kPark,
          .to_sun = directionOf(0.9f, 0.6f),
          .size = 1024,
          .count = count};
}

glm::vec3 randomDirection(Random& random) {
  return directionOf(random.vary(3.14f), random.vary(1.2f));
}

/// A point of the picture's pyramid, at a depth below `reach`.
glm::vec3 visiblePoint(const CascadeRequest& request, float reach, Random& random) {
  const CameraRays rays = cameraRays(
      request.camera, static_cast<float>(request.width) / static_cast<float>(request.height));
  const float depth = reach * std::cbrt(random.uniform(0.0f, 1.0f));
  return rays.eye +
         depth * (rays.forward + random.vary(1.0f) * rays.right + random.vary(1.0f) * rays.down);
}

glm::vec3 positionIn(const ShadowFit& fit, const glm::vec3& p) {
  return glm::vec3(fit.shadow_from_world * glm::vec4(p, 1.0f));
}

float shareOf(const Cascade& cascade, const glm::vec3& p, int size) {
  return shared::cascadeShare(glm::vec2(positionIn(cascade, p)), static_cast<float>(size));
}

TEST(Cascades, SplitsAreZhangsPracticalOnes) {
  // 0.9 of 2, 4, 8 and 0.1 of 4.75, 8.5, 12.25.
  const std::vector<float> splits = cascadeSplits(1.0f, 16.0f, 4);
  ASSERT_EQ(splits.size(), 3u);
  EXPECT_FLOAT_EQ(splits[0], 2.275f);
  EXPECT_FLOAT_EQ(splits[1], 4.45f);
  EXPECT_FLOAT_EQ(splits[2], 8.425f);
  EXPECT_TRUE(cascadeSplits(1.0f, 16.0f, 1).empty());
}

TEST(Cascades, TheSphereIsTheSmallestAroundThePyramid) {
  for (const float tan_corner : {0.05f, 0.3f, 0.8f, 1.0f, 1.7f, 6.0f}) {
    const auto around = [tan_corner](float center) {  // the eye, and a corner
      return std::max(center, std::hypot(1.0f - center, tan_corner));
    };
    const PyramidSphere sphere = pyramidSphere(tan_corner);
    EXPECT_NEAR(sphere.radius, around(sphere.center), 1e-5f * sphere.radius);
    for (float center = 0.0f; center < 2.0f; center += 0.01f)
      EXPECT_LE(sphere.radius, around(center) * 1.00001f) << tan_corner << ", " << center;
  }
}

TEST(Cascades, OneIsTheFitOfTheWholeScene) {
  const CascadeRequest request = parkRequest(1);
  const std::vector<Cascade> one = fitCascades(request);
  const ShadowFit whole = fitShadow(request.bounds, request.to_sun, request.size);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].shadow_from_world, whole.shadow_from_world);
  EXPECT_EQ(one[0].texel_m, whole.texel_m);
  EXPECT_EQ(one[0].origin, glm::ivec2(0));
  // The last of several is, too; and small maps have no room for the border of others.
  const std::vector<Cascade> four = fitCascades(parkRequest(4));
  ASSERT_EQ(four.size(), 4u);
  EXPECT_EQ(four.back().shadow_from_world, whole.shadow_from_world);
  CascadeRequest small = parkRequest(4);
  small.size = 32;
  EXPECT_EQ(fitCascades(small).size(), 1u);
}

TEST(Cascades, EachHoldsThePictureUpToItsReach) {
  Random random(3);
  int fading = 0, standing = 0;
  for (int trial = 0; trial < 200; ++trial) {
    CascadeRequest request = parkRequest(2 + trial % 3);
    request.camera.eye = {random.vary(250.0f), random.uniform(0.2f, 60.0f), random.vary(250.0f)};
    request.camera.target = request.camera.eye + randomDirection(random);
    request.camera.vertical_fov = random.uniform(0.1f, 2.0f);
    request.to_sun = directionOf(random.vary(3.14f), random.uniform(0.02f, 1.57f));
    request.size = trial % 2 == 0 ? 2048 : 64;
    const std::vector<Cascade> cascades = fitCascades(request);
    for (std::size_t i = 0; i + 1 < cascades.size(); ++i) {
      EXPECT_LT(cascades[i].texel_m, cascades[i + 1].texel_m);
      EXPECT_LT(cascades[i].reach_m, cascades[i + 1].reach_m);
      for (int k = 0; k < 100; ++k)
        EXPECT_EQ(
            shareOf(cascades[i], visiblePoint(request, cascades[i].reach_m, random), request.size),
            1.0f);
      // Whatever stands in a map, however far towards the sun, has a depth there.
      for (int k = 0; k < 100; ++k) {
        const glm::vec3 share(random.uniform(), random.uniform(), random.uniform());
        const glm::vec3 p = kPark.min + share * kPark.size();
        const glm::vec3 at = positionIn(cascades[i], p);
        if (glm::any(glm::lessThan(glm::vec2(at), glm::vec2(0.0f))) ||
            glm::any(glm::greaterThan(glm::vec2(at), glm::vec2(1.0f))))
          continue;
        ++standing;
        EXPECT_GE(at.z, 0.0f);
        EXPECT_LE(at.z, 1.0f);
      }
    }
    // Where a map fades, the next one is whole: two samples are enough.
    for (int k = 0; k < 500 && cascades.size() > 2; ++k) {
      const glm::vec3 p = visiblePoint(request, 2.0f * cascades[1].reach_m, random);
      const float share = shareOf(cascades[0], p, request.size);
      if (share <= 0.0f || share >= 1.0f) continue;
      ++fading;
      EXPECT_EQ(shareOf(cascades[1], p, request.size), 1.0f) << trial;
    }
  }
  EXPECT_GT(fading, 500);
  EXPECT_GT(standing, 3000);
}

TEST(Cascades, DepthsAreFineNearTheEye) {
  // A park is wide and flat: under a high sun the part that a small map holds is not deep.
  CascadeRequest request = parkRequest(4);
  request.to_sun = directionOf(0.5f, 1.0f);
  const std::vector<Cascade> cascades = fitCascades(request);
  ASSERT_EQ(cascades.size(), 4u);
  const auto metres = [](const Cascade& cascade) {
    const glm::mat4& m = cascade.shadow_from_world;
    return 1.0f / glm::length(glm::vec3(m[0].z, m[1].z, m[2].z));
  };
  EXPECT_LT(metres(cascades[0]), 0.2f * metres(cascades[3]));
  // A column of the map's width through all of the park's height, and a step at either end.
  const float side = cascades[0].texel_m * static_cast<float>(request.size);
  const float column = kPark.size().y / std::sin(1.0f) + std::sqrt(2.0f) * side / std::tan(1.0f);
  EXPECT_LE(metres(cascades[0]), column + 0.5f * side + 1e-3f);
}

/// How far a point's place within its texel moves, at most, while the camera moves and turns: for
/// each cascade but the last, in texels.
std::vector<float> largestPhaseShift(const glm::vec3& offset, bool snap) {
  Random random(8);
  std::vector<float> most(3, 0.0f);
  std::vector<Cascade> first;
  CascadeRequest request = parkRequest(4);
  request.snap = snap;
  request.bounds = {kPark.min + offset, kPark.max + offset};
  const glm::vec3 p = offset + glm::vec3(6.1f, 0.3f, -4.2f);
  const auto size = static_cast<float>(request.size);
  for (int frame = 0; frame < 300; ++frame) {
    request.camera.eye =
        offset + glm::vec3(random.vary(8.0f), random.uniform(0.5f, 9.0f), random.vary(8.0f));
    request.camera.target = request.camera.eye + randomDirection(random) * 3.0f;
    const std::vector<Cascade> cascades = fitCascades(request);
    if (frame == 0) first = cascades;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(cascades[i].texel_m, first[i].texel_m);
      const glm::vec2 moved =
          (glm::vec2(positionIn(cascades[i], p)) - glm::vec2(positionIn(first[i], p))) * size;
      const glm::vec2 off = glm::abs(moved - glm::round(moved));
      most[i] = std::max({most[i], off.x, off.y});
      if (!snap) continue;
      // Counted from the world's origin it is the same texel.
      const glm::ivec2 texels =
          glm::ivec2(glm::round(moved)) + cascades[i].origin - first[i].origin;
      EXPECT_EQ(texels.x % shared::kCascadeWrap, 0);
      EXPECT_EQ(texels.y % shared::kCascadeWrap, 0);
    }
  }
  return most;
}

TEST(Cascades, PointsStayInPlaceWithinTheirTexels) {
  for (const float shift : largestPhaseShift(glm::vec3(0.0f), true)) EXPECT_LT(shift, 0.01f);
  // Floats hold 0.1 mm at 2 km; the finest texel is 2 cm.
  for (const float shift : largestPhaseShift({1500, 80, -1300}, true)) EXPECT_LT(shift, 0.1f);
  for (const float shift : largestPhaseShift(glm::vec3(0.0f), false)) EXPECT_GT(shift, 0.4f);
}

TEST(Cascades, AutomaticTakesAsManyAsTheViewNeeds) {
  Random random(5);
  std::array<int, 5> counts{};
  for (int trial = 0; trial < 300; ++trial) {
    CascadeRequest request = parkRequest(0);
    const float distance = 5.0f * std::pow(400.0f, random.uniform(0.0f, 1.0f));
    const glm::vec3 middle(0, 6, 0);
    request.camera.eye = {random.vary(3.0f), 8.0f, 200.0f + distance};
    request.camera.target = middle;
    const std::vector<Cascade> cascades = fitCascades(request);
    ++counts[cascades.size()];
    request.count = 4;
    if (cascades.size() == fitCascades(request).size()) continue;  // as good as it gets
    // No texel is larger than two pixels where the scene is seen; at the picture's corners a pixel
    // is as much smaller than at its middle as depth is than distance.
    const glm::vec3 forward = glm::normalize(request.camera.target - request.camera.eye);
    const float pixel = 2.0f * std::tan(0.3f) / 480.0f;
    for (int k = 0; k < 200; ++k) {
      const glm::vec3 p(random.vary(200.0f), random.uniform(0.0f, 12.0f), random.vary(200.0f));
      const float depth = glm::dot(p - request.camera.eye, forward);
      const glm::vec3 aside = p - request.camera.eye - depth * forward;
      if (depth <= 0.0f || glm::length(aside) > 0.3f * depth) continue;
      const auto used = std::find_if(cascades.begin(), cascades.end() - 1, [&](const auto& c) {
        return shareOf(c, p, request.size) > 0.0f;
      });
      EXPECT_LE(used->texel_m, 2.0f * pixel * depth * 1.06f);
    }
  }
  for (const std::size_t count : {1u, 2u, 3u, 4u}) EXPECT_GT(counts[count], 0) << count;
  EXPECT_EQ(fitCascades(parkRequest(0)).size(), 4u);  // from inside the scene
}

TEST(Cascades, StrangeScenesHaveMaps) {
  CascadeRequest nothing = parkRequest(4), around_the_eye = parkRequest(4), wide = parkRequest(4);
  nothing.bounds = {};
  around_the_eye.bounds = {around_the_eye.camera.eye, around_the_eye.camera.eye};
  wide.camera.vertical_fov = 3.1f;
  EXPECT_EQ(fitCascades(nothing).size(), 1u);
  EXPECT_LT(fitCascades(wide).size(), 4u);  // the others would be larger than the whole scene's
  for (const CascadeRequest& request : {nothing, around_the_eye, wide})
    for (const Cascade& cascade : fitCascades(request)) {
      EXPECT_TRUE(cascade.texel_m > 0.0f && std::isfinite(cascade.texel_m));
      for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
          EXPECT_TRUE(std::isfinite(cascade.shadow_from_world[column][row]));
    }
}

class CascadesRender : public RenderTest {};

glm::mat4 at(float x, float z) {
  return glm::translate(glm::mat4(1.0f), glm::vec3(x, 0, z));
}

/// Eight trees on the ground, 5 m to 300 m before an eye at the origin.
Scene avenue(const Plant& tree) {
  Scene scene = itemScene(tree, nullptr);
  scene.ground = true;
  scene.items[0].world_from_plant.clear();
  int i = 0;
  for (const float distance : {5.0f, 9.0f, 16.0f, 30.0f, 55.0f, 100.0f, 180.0f, 300.0f})
    scene.items[0].world_from_plant.push_back(
        at((++i % 2 == 0 ? 0.12f : -0.15f) * distance, -distance));
  return scene;
}

View avenueView() {
  View view = smallView(160, 120);
  view.terms = presetTerms("standard");
  view.camera = {{0, 1.7f, 0}, {0, 1.2f, -10}, 0.7f};
  turnSun(view, 1.9f, 0.7f);
  view.shadow_map_size = 512;
  view.shadow_cascades = 4;
  view.exposure.ev = 14.5f;
  view.exposure.white = 3.0f;
  return view;
}

TEST_F(CascadesRender, AnyNumberIsSilentUnderValidation) {
  const Plant tree = ballTree(60, 0.5f);
  renderer().setScene(avenue(tree));
  View view = avenueView();
  for (const int size : {512, 128, 32})
    for (const int cascades : {1, 4, 2, 0, 3}) {
      view.shadow_map_size = size;
      view.shadow_cascades = cascades;
      const int drawn = renderer().render(view).shadow_cascades;
      EXPECT_LE(drawn, size == 32 ? 1 : cascades == 0 ? 4 : cascades);
      if (size == 512) {
        EXPECT_EQ(drawn, cascades == 0 ? 4 : cascades);
      }
    }
  view.terms.shadow = false;
  EXPECT_EQ(renderer().render(view).shadow_cascades, 1);
  view.shadow_cascades = 5;
  EXPECT_THROW(renderer().render(view), Error);
  view.shadow_cascades = -1;
  EXPECT_THROW(renderer().render(view), Error);
}

/// The avenue with a 3 m card at 30 m above the ground, between the sun and the ground at (0, 0,
/// -8).
TEST_F(CascadesRender, CastersOutsideOfASliceShadeIt) {
  const Plant tree = ballTree(60, 0.5f);
  View view = avenueView();
  view.camera.target = {0, 0.2f, -10};
  view.terms.ambient = false;
  const glm::vec3 ground(0, 0, -8);
  const glm::vec3 to_sun = view.daylight.sun.direction;
  const glm::vec3 above = ground + to_sun * (30.0f / to_sun.y);
  EXPECT_GT(glm::length(above - view.camera.eye), 30.0f);
  const Plant card = horizontalCard(above.y, 3.0f);
  Scene scene = avenue(tree);
  scene.items.push_back({&card, nullptr, {at(above.x, above.z)}});
  const glm::ivec2 pixel = pixelOf(view, ground);
  for (const bool shaded : {true, false}) {
    if (!shaded) scene.items.pop_back();
    renderer().setScene(scene);
    const Frame frame = renderer().render(view);
    EXPECT_EQ(frame.shadow_cascades, 4);
    view.terms.shadow = false;
    const float lit = luminanceAt(renderer().render(view).hdr, pixel.x, pixel.y);
    view.terms.shadow = true;
    const float seen = luminanceAt(frame.hdr, pixel.x, pixel.y);
    if (shaded)
      EXPECT_LT(seen, 0.01f * lit);
    else
      EXPECT_NEAR(seen, lit, 0.01f * lit);
  }
}

TEST_F(CascadesRender, ShadowsAreSharpNearTheEye) {
  // The trunk of the nearest tree, 0.3 m wide, casts a shadow that one map of 512 for 300 m cannot
  // show: a band of ground in which most pixels are either lit or not.
  Plant pole = whiteQuad();
  pole.meshes[0] = {};
  addTube(pole.meshes[0], {0, 0, 0}, {0, 3, 0}, 0.1f, 0.1f);
  Scene scene = avenue(pole);
  renderer().setScene(scene);
  View view = avenueView();
  view.terms.ambient = view.terms.textures = false;
  view.daylight.sky = nullptr;
  view.camera.target = {0.5f, 0.5f, -5};
  std::array<float, 2> darkest{};
  for (const int cascades : {1, 4}) {
    view.shadow_cascades = cascades;
    const HdrImage image = renderer().render(view).hdr;
    // On the ground beside the first pole, across its shadow.
    const glm::vec3 foot(-0.75f, 0, -5.0f);
    const glm::vec3 away = -glm::normalize(glm::vec3(directionOf(1.9f, 0.0f)));
    float least = 1e9f, most = 0.0f;
    for (int k = -20; k <= 20; ++k) {
      const glm::vec3 across = glm::cross(away, glm::vec3(0, 1, 0));
      const glm::ivec2 p =
          pixelOf(view, foot + away * 1.0f + across * (0.05f * static_cast<float>(k)));
      if (p.x < 0 || p.y < 0 || p.x >= image.width || p.y >= image.height) continue;
      least = std::min(least, luminanceAt(image, p.x, p.y));
      most = std::max(most, luminanceAt(image, p.x, p.y));
    }
    darkest[cascades == 4 ? 1 : 0] = least / most;
  }
  EXPECT_GT(darkest[0], 0.4f);
  EXPECT_LT(darkest[1], 0.3f);
}

TEST_F(CascadesRender, FarFromTheOriginLooksTheSame) {
  Plant tree = ballTree(60, 0.5f);
  renderer().setScene(avenue(tree));
  const View view = avenueView();
  const Image here = renderer().render(view).image;
  tree.origin = {400000.0, 120.0, -5400000.0};
  renderer().setScene(avenue(tree));
  EXPECT_EQ(renderer().render(view).image.rgba, here.rgba);
}

/// Draws the avenue for a camera that moves slowly and turns.
class Walk {
 public:
  Walk() : device_("", true), drawer_(device_) {
    const Plant tree = ballTree(80, 0.5f);
    const Scene scene = avenue(tree);
    scene_.emplace(device_, packScene(scene), drawer_.sceneLayouts());
  }
  ~Walk() { EXPECT_EQ(device_.validationMessages(), 0); }

  /// Mean FLIP between neighbouring frames. With `only_cascades`, the picture's own camera stays
  /// and the cascades alone follow the path.
  double meanChange(float step_m, float turn, bool snap, bool only_cascades, bool shadow = true) {
    constexpr int kFrames = 12;
    View view = avenueView();
    view.hdr = false;
    view.terms.textures = false;
    view.terms.shadow = shadow;
    Image last;
    double sum = 0.0;
    for (int frame = 0; frame < kFrames; ++frame) {
      const auto f = static_cast<float>(frame);
      Camera camera = avenueView().camera;
      camera.eye += glm::vec3(0.6f, 0.1f, -0.7f) * (step_m * f);
      camera.target =
          camera.eye + glm::vec3(std::sin(turn * f), -0.05f, -std::cos(turn * f)) * 10.0f;
      drawer_.tryCascades({.camera = camera, .snap = snap});
      if (!only_cascades) view.camera = camera;
      Image image = drawer_.draw(*scene_, view).image;
      if (frame > 0) sum += meanFlip(last, image);
      last = std::move(image);
    }
    return sum / (kFrames - 1);
  }

 private:
  gpu::Device device_;
  FrameDrawer drawer_;
  std::optional<GpuScene> scene_;
};

TEST(CascadesWalk, ShadowsDoNotFlicker) {
  Walk walk;
  // Where the picture's camera stays, nothing changes, although the cascades move and turn: with
  // steps far below a texel, as well as over many. Unsnapped ones show what would.
  const struct {
    float step_m, turn;
    double unsnapped;
  } paths[] = {{1e-4f, 1e-5f, 2e-4}, {1e-3f, 1e-4f, 1e-3}, {0.03f, 3e-3f, 4e-3}};
  for (const auto& path : paths) {
    EXPECT_LT(walk.meanChange(path.step_m, path.turn, true, true), 1e-5) << path.step_m;
    EXPECT_GT(walk.meanChange(path.step_m, path.turn, false, true), path.unsnapped) << path.step_m;
  }
  // Where it walks and turns, most of what changes is what would without shadows.
  const double without = walk.meanChange(0.005f, 5e-4f, true, false, false);
  const double snapped = walk.meanChange(0.005f, 5e-4f, true, false);
  EXPECT_LT(snapped, 0.04);
  EXPECT_LT(snapped, 1.1 * without);
  EXPECT_GT(walk.meanChange(0.005f, 5e-4f, false, false), snapped);
}

}  // namespace
}  // namespace verdure
