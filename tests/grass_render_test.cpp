// Traced grass against brute force.
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <string>

#include "base/random.h"
#include "grass_scenes.h"
#include "scene/camera.h"
#include "verdure/compare.h"

namespace verdure {
namespace {

using namespace test;

class GrassRender : public RenderTest {
 protected:
  static HdrImage draw(const Scene& scene, const View& view) {
    renderer().setScene(scene);
    return renderer().render(view).hdr;
  }
  static Agreement compare(const GrassLayer& layer, const View& view,
                           const Terrain* terrain = nullptr) {
    const HdrImage image = draw(grassScene(layer, terrain), view);
    const GrassReference reference(layer, terrain != nullptr ? *terrain : plane(), view);
    return agreementWith(reference, view, image, layer.most_slices,
                         [&](const glm::dvec3& direction) { return reference.trace(direction); });
  }
  static void expectAgreement(const std::string& name, const Agreement& all) {
    EXPECT_GE(all.exact, 0.97) << name << ": " << all;
    EXPECT_GE(all.explained, 0.999) << name << ": " << all;
    EXPECT_LT(all.mean, 0.6) << name << ": " << all;
  }

  static const GrassSet& blocky() {
    static const GrassSet set = blockySet();
    return set;
  }
  static const GrassSet& lawn() {
    static const GrassSet set =
        growGrass(grassSpecies("lawn"), {.texels_per_m = 128.0f, .kinds = 3});
    return set;
  }
  static Camera slanting() {
    return lookingFrom({2.5f, 1.2f, 3.0f}, glm::normalize(glm::vec3(0.4f, -0.6f, -0.8f)));
  }
  static Camera above() { return lookingFrom({2.53f, 1.5f, 3.02f}, {0, -1, 0}); }
};

TEST_F(GrassRender, AgreesWithBruteForce) {
  const GrassLayer plain = plainLayer(blocky());
  const View view = plainView(slanting());
  expectAgreement("slanting", compare(plain, view));
  const Camera low =
      lookingFrom({2.5f, 0.4f, 3.0f}, glm::normalize(glm::vec3(0.4f, -0.2f, -0.8f)), 0.3f);
  expectAgreement("grazing", compare(plain, plainView(low)));
  // Odd sizes: a ray goes straight down, along no slice's direction.
  expectAgreement("above", compare(plain, plainView(above(), 121, 91)));
  const Camera up = lookingFrom({2.5f, 0.1f, 3.0f}, {0.4f, 0.35f, -0.8f}, 0.5f);
  expectAgreement("inside, upwards", compare(plain, plainView(up)));
  const auto changed = [&](const auto& change) {
    GrassLayer layer = plain;
    change(layer);
    return layer;
  };
  expectAgreement("mirrored", compare(changed([](GrassLayer& l) { l.mirrored = true; }), view));
  expectAgreement("even", compare(changed([](GrassLayer& l) { l.scatter = 0.0f; }), view));
  expectAgreement("sparse", compare(changed([](GrassLayer& l) { l.density = 0.5f; }), view));
  expectAgreement("none", compare(changed([](GrassLayer& l) { l.density = 0.0f; }), view));
  const GrassLayer level = changed([](GrassLayer& l) { l.middle = true; });
  expectAgreement("level slice", compare(level, view));
  expectAgreement("level, above", compare(level, plainView(above(), 121, 91)));
}

// Rays that come down on the ground without having been above the shell.
TEST_F(GrassRender, AgreesInsideOfTheShell) {
  const Camera inside = lookingFrom({2.5f, 0.12f, 3.0f}, {0.4f, 0.1f, -0.8f}, 0.9f);
  expectAgreement("inside", compare(plainLayer(blocky()), plainView(inside)));
}

// The middle columns' rays keep to one u or one v.
TEST_F(GrassRender, AgreesAlongAxes) {
  GrassLayer layer = plainLayer(blocky());
  layer.turn = 0.0f;
  const glm::vec3 eye(2.53f, 0.6f, 3.02f);
  expectAgreement("along -z", compare(layer, plainView(lookingFrom(eye, {0, -0.4f, -1}), 121, 91)));
  expectAgreement("along +z", compare(layer, plainView(lookingFrom(eye, {0, -0.4f, 1}), 121, 91)));
  expectAgreement("along +x", compare(layer, plainView(lookingFrom(eye, {1, -0.4f, 0}), 121, 91)));
  expectAgreement("down", compare(layer, plainView(above(), 121, 91)));
}

TEST_F(GrassRender, AgreesFarFromTheOrigin) {
  for (const float away : {4096.0f, 65536.0f}) {
    Camera camera = slanting();
    camera.eye += glm::vec3(away, 0, -away);
    camera.target = camera.eye + glm::vec3(0.5f, -0.75f, -1.0f);
    expectAgreement(std::to_string(away), compare(plainLayer(blocky()), plainView(camera)));
  }
}

TEST_F(GrassRender, AgreesInWind) {
  View view = plainView(slanting());
  view.wind = {.speed = 8.0f, .from = 0.7f, .gusts = 0.5f};
  view.seconds = 12.25;
  expectAgreement("wind", compare(plainLayer(blocky()), view));
}

// The shell of hills is drawn by small triangles: a third to three quarters of these pixels have
// two. Of those that look along the ground, up to 5 % are off by more than that explains, by up to
// 18 levels.
TEST_F(GrassRender, AgreesOnHills) {
  GrassLayer layer = plainLayer(blocky());
  layer.most_slices = 32;
  const Terrain hills = growTerrain({});
  for (const float x : {37.0f, -61.0f}) {
    const glm::vec2 place(x, 3.0f + 0.7f * x);
    const glm::vec3 eye(place.x, hills.heightAt(place) + 1.2f, place.y);
    for (const float down : {0.6f, 0.15f}) {
      const View view = plainView(lookingFrom(eye, {0.4f, -down, -0.8f}), 64, 48);
      const Agreement all = compare(layer, view, &hills);
      EXPECT_GT(all.explained, down > 0.5f ? 0.998 : 0.94) << all;
      EXPECT_LT(all.mean, 8.0) << all;
      EXPECT_LT(all.worst, 30.0) << all;
    }
  }
}

// At most one slice off, where a slice hides at once what is behind. In white grass of eight times
// the size, haze is all that is seen: it tells how far away.
TEST_F(GrassRender, DepthIsThatOfTheSliceThatHides) {
  GrassSet set = blockySet(8.0f);
  const auto whiten = [](GrassMap& map) {
    for (glm::vec4& color : map.color) color = glm::vec4(color.a);
  };
  for (GrassMap& slice : set.slices) whiten(slice);
  whiten(set.opaque);
  whiten(set.ground);
  const GrassLayer layer = plainLayer(set);
  const View view = plainView(lookingFrom({2.5f, 16.0f, 3.0f}, {0.4f, -0.4f, -0.8f}));
  const HdrImage image = draw(grassScene(layer), view);
  const GrassReference reference(layer, plane(), view);
  int opaque = 0, same = 0;
  double mean = 0.0;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const SeenGrass seen = reference.trace(reference.ray(x + 0.5, y + 0.5));
      if (seen.depth_alpha < 0.9999) continue;
      const double clear = double{image.at(x, y).g};
      // The inverse of haze, whose half is 80 m away.
      const double depth = 80.0 * std::sqrt(std::max(1.0 / clear - 1.0, 0.0));
      ++opaque;
      same += std::abs(depth - seen.depth) < double{set.spacing_m.y} ? 1 : 0;
      mean += std::abs(depth - seen.depth);
    }
  EXPECT_GT(opaque, 1500);
  EXPECT_GT(same, 0.97 * opaque);
  EXPECT_LT(mean / opaque, 0.15);
}

/// A black wall across the picture.
glm::mat4 wallAt(float z) {
  return glm::scale(glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, z)), glm::vec3(10.0f));
}

// Walls across the grass: rays end at them, or pixels are hidden by what is nearer.
TEST_F(GrassRender, HidesWhatIsBehindIt) {
  const Plant wall = whiteQuad(glm::vec4(0, 0, 0, 1));
  const View view = plainView(lookingFrom({0.03f, 0.7f, 3.0f}, {0.1f, -0.35f, -1.0f}));
  GrassLayer layer = plainLayer(blocky());
  for (const float z : {1.45f, 1.0f, 0.55f}) {
    const GrassReference reference(layer, plane(), view);
    const auto wallAlong = [&](const glm::dvec3& direction) {
      return (double{z} - reference.eye().z) / direction.z;
    };
    for (const bool ends : {true, false}) {
      layer.ends_at_depth = ends;
      Scene scene = grassScene(layer);
      scene.items.push_back({&wall, nullptr, {wallAt(z)}});
      const Agreement all =
          agreementWith(reference, view, draw(scene, view), 256, [&](const glm::dvec3& direction) {
            const double t = wallAlong(direction);
            if (ends) return reference.trace(direction, t);
            const SeenGrass seen = reference.trace(direction);
            return seen.depth >= 0.0 && seen.depth < t ? seen : SeenGrass{};
          });
      expectAgreement("wall at " + std::to_string(z), all);
    }
  }
}

TEST_F(GrassRender, TrunkIsHiddenAtItsFootOnly) {
  const Plant trunk = standingTube(0.12f, 0.0f, 1.5f);
  const View view = plainView(lookingFrom({0, 1.0f, 3.0f}, {0, -0.25f, -1.0f}));
  GrassLayer layer = plainLayer(blocky());
  const HdrImage without = draw(grassScene(layer), view);
  for (const bool ends : {true, false}) {
    layer.ends_at_depth = ends;
    Scene scene = grassScene(layer);
    scene.items.push_back({&trunk, nullptr});
    const HdrImage with = draw(scene, view);
    const auto hidden = [&](float height) {
      int same = 0, all = 0;
      for (float x = -0.1f; x < 0.1f; x += 0.005f, ++all) {
        const glm::ivec2 p = pixelOf(view, {x, height, std::sqrt(0.0144f - x * x)});
        const glm::dvec3 other = levelsOf(glm::dvec3(without.at(p.x, p.y)));
        same += largestOf(levelsOf(glm::dvec3(with.at(p.x, p.y))) - other) < 1.0 ? 1 : 0;
      }
      return static_cast<float>(same) / static_cast<float>(all);
    };
    EXPECT_GT(hidden(0.02f), 0.8f) << ends;
    EXPECT_EQ(hidden(0.4f), 0.0f) << ends;
  }
}

// The ground's points, found along each ray, were where the last camera saw them.
TEST_F(GrassRender, MotionVectorsFollowATerrain) {
  const Terrain hills = growTerrain(
      {.seed = 3, .size_m = glm::vec2(40.0f), .relief_m = 5.0f, .hill_m = 15.0f, .samples = 65});
  View view = plainView(lookingFrom({1.0f, 3.0f, 9.0f}, {0.1f, -0.3f, -1.0f}, 0.8f));
  const Camera was = lookingFrom({1.3f, 2.9f, 9.4f}, {0.05f, -0.3f, -1.0f}, 0.8f);
  view.last = {was, view.wind, view.seconds};
  Scene scene;
  scene.terrain = &hills;
  Renderer renderer({"", true});
  renderer.setScene(scene);
  const Frame frame = renderer.render(view);
  const glm::vec2 size(view.width, view.height);
  const CameraRays rays = cameraRays(view.camera, size.x / size.y);
  int checked = 0;
  float longest = 0.0f;
  for (int y = view.height / 3; y < view.height; y += 7)
    for (int x = 3; x < view.width; x += 8) {
      const glm::vec2 at = glm::vec2(x, y) + 0.5f, place = at / size * 2.0f - 1.0f;
      const glm::vec3 ray =
          glm::normalize(rays.forward + place.x * rays.right + place.y * rays.down);
      float t = 0.0f;
      glm::vec3 p = rays.eye;
      while (t < 15.0f && p.y > hills.heightAt({p.x, p.z})) p = rays.eye + ray * (t += 0.005f);
      if (t >= 15.0f) continue;
      const glm::vec4 clip = clipFromWorld(was, size.x / size.y) * glm::vec4(p, 1.0f);
      const glm::vec2 way = at - (glm::vec2(clip) / clip.w * 0.5f + 0.5f) * size;
      const glm::vec2 got = frame.motion[static_cast<std::size_t>(y * view.width + x)];
      EXPECT_NEAR(got.x, way.x, 0.1f) << x << " " << y;
      EXPECT_NEAR(got.y, way.y, 0.1f) << x << " " << y;
      longest = std::max(longest, glm::length(way));
      ++checked;
    }
  EXPECT_GT(checked, 100);
  EXPECT_GT(longest, 5.0f);
  EXPECT_EQ(renderer.validationMessages(), 0);
}

TEST_F(GrassRender, HorizonShowsBlades) {
  Terrain ridge{129, 129, glm::vec2(-32.0f), glm::vec2(0.5f), {}};
  for (int z = 0; z < ridge.height; ++z)
    for (int x = 0; x < ridge.width; ++x) {
      const float off = (static_cast<float>(z) * 0.5f - 32.0f) / 8.0f;
      ridge.heights.push_back(4.0f * std::exp(-off * off));
    }
  const View view = plainView(lookingFrom({0, 3.0f, 9.0f}, {0, 0.13f, -1.0f}, 0.25f));
  GrassLayer layer = plainLayer(lawn());
  const HdrImage image = draw(grassScene(layer, &ridge), view);
  const GrassReference reference(layer, ridge, view, 40.0);
  int zone = 0, covered = 0, partly = 0, beyond = 0;
  double mean = 0.0;
  int ground = 0;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x)
      if (reference.leastHeight(reference.ray(x + 0.5, y + 0.5)) < 0.0) {
        mean += double{luminanceAt(image, x, y)};
        ++ground;
      }
  mean /= ground;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const double least = reference.leastHeight(reference.ray(x + 0.5, y + 0.5));
      const double seen = double{luminanceAt(image, x, y)};
      if (least > 1.2 * double{lawn().height_m}) {
        beyond += seen > 0.0 ? 1 : 0;
      } else if (least > 0.01) {
        ++zone;
        covered += seen > 0.5 * mean ? 1 : 0;
        partly += seen > 0.05 * mean && seen <= 0.5 * mean ? 1 : 0;
      }
    }
  EXPECT_GT(ground, 3000);
  EXPECT_GT(covered + partly, zone / 5);
  EXPECT_GT(partly, 20);
  EXPECT_EQ(beyond, 0);
}

/// The default day, on hills, default settings.
View dayView(const Terrain& hills, const glm::vec2& place, float height, const glm::vec3& toward,
             int width = 120, int height_px = 90) {
  View view = smallView(width, height_px);
  view.terms = presetTerms("standard");
  view.exposure.ev = 14.5f;
  view.exposure.white = 3.0f;
  view.camera = lookingFrom({place.x, hills.heightAt(place) + height, place.y}, toward, 0.7f);
  return view;
}

TEST_F(GrassRender, NoDirectionIsDark) {
  const Terrain hills = growTerrain({});
  GrassLayer layer;
  layer.set = &lawn();
  layer.blades = false;  // grass that is traced
  renderer().setScene(grassScene(layer, &hills));
  Random random(5);
  for (int i = 0; i < 16; ++i) {
    const float azimuth = random.uniform(0.0f, 6.28f), elevation = random.uniform(-1.57f, 0.6f);
    const float height = 2.0f * lawn().height_m * std::exp(random.uniform(0.0f, 4.0f));
    const glm::vec2 place(random.vary(60.0f), random.vary(60.0f));
    const View view = dayView(hills, place, height, directionOf(azimuth, elevation), 64, 48);
    const HdrImage image = renderer().render(view).hdr;
    int bad = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const glm::vec3 c = image.at(x, y);
        for (int k = 0; k < 3; ++k) bad += std::isfinite(c[k]) && c[k] > 1e-4f ? 0 : 1;
      }
    EXPECT_EQ(bad, 0) << azimuth << " " << elevation << " " << height;
  }
}

TEST_F(GrassRender, SlowPathsDoNotFlicker) {
  const Terrain hills = growTerrain({});
  GrassLayer layer;
  layer.set = &lawn();
  renderer().setScene(grassScene(layer, &hills));
  constexpr int kFrames = 8;
  Image first, last;
  double sum = 0.0, most = 0.0;
  for (int i = 0; i < kFrames; ++i) {
    const auto f = static_cast<float>(i);
    const float turn = 0.0034907f * f;  // 0.2 degrees
    View view =
        dayView(hills, {20.0f, 10.0f - 0.02f * f}, 1.7f, {std::sin(turn), -0.25f, -std::cos(turn)});
    view.hdr = false;
    Image image = renderer().render(view).image;
    if (i > 0) {
      const double change = meanFlip(last, image);
      sum += change;
      most = std::max(most, change);
    } else {
      first = image;
    }
    last = std::move(image);
  }
  View other = dayView(hills, {-30.0f, 25.0f}, 1.7f, {1.0f, -0.25f, 0.3f});
  other.hdr = false;
  const double whole = meanFlip(first, renderer().render(other).image);
  EXPECT_LT(sum / (kFrames - 1), 0.04);
  EXPECT_LT(most, 0.05);
  EXPECT_GT(whole, 0.3);
}

// Far away, slices are taken together: on the mean about the colour of all of them one by one, the
// less so the more the rays graze.
TEST_F(GrassRender, MediumKeepsTheMeanColor) {
  GrassLayer layer = plainLayer(lawn());
  layer.most_slices = 256;
  const struct {
    float down;
    double off;
  } slopes[] = {{0.03f, 0.17}, {0.06f, 0.08}, {0.12f, 0.025}};
  for (const auto& [down, off] : slopes) {
    const View view = plainView(lookingFrom({0.3f, 1.7f, 0.2f}, {0.4f, -down, -0.9f}, 0.04f));
    glm::dvec3 means[2] = {glm::dvec3(0.0), glm::dvec3(0.0)};
    for (const bool medium : {false, true}) {
      layer.medium = medium;
      const HdrImage image = draw(grassScene(layer), view);
      for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x)
          means[medium ? 1 : 0] += glm::dvec3(image.at(x, y)) / double(view.width * view.height);
    }
    const glm::dvec3 ratio = means[1] / means[0];
    EXPECT_LT(largestOf(ratio - 1.0), off);
  }
}

TEST_F(GrassRender, WindDependsOnTimeAlone) {
  GrassLayer layer;
  layer.set = &blocky();
  const Scene scene = grassScene(layer);
  View view = plainView(slanting());
  view.hdr = false;
  renderer().setScene(scene);
  const Image rest = renderer().render(view).image;
  view.seconds = 321.0;
  EXPECT_EQ(renderer().render(view).image.rgba, rest.rgba);
  view.wind = {.speed = 8.0f, .from = 0.7f, .gusts = 0.5f};
  const Image windy = renderer().render(view).image;
  EXPECT_GT(meanFlip(rest, windy), 0.02);
  view.seconds = 4.0;
  EXPECT_NE(renderer().render(view).image.rgba, windy.rgba);
  view.seconds = 321.0;
  EXPECT_EQ(renderer().render(view).image.rgba, windy.rgba);
}

// From above, the level slice goes downwind.
TEST_F(GrassRender, CanopyGoesDownwind) {
  GrassSet set = blocky();
  set.middle = blocks(128, 128, 4, -1.0, 23);
  GrassLayer layer = plainLayer(set);
  layer.middle = true;
  View view = plainView(lookingFrom({2.53f, 0.8f, 3.02f}, {0, -1, 0}), 121, 121);
  const HdrImage rest = draw(grassScene(layer), view);
  for (const float from : {0.7f, 2.6f, -1.9f}) {
    view.wind = {.speed = 8.0f, .from = from, .gusts = 0.0f};
    const HdrImage windy = renderer().render(view).hdr;
    double best = 1e9;
    glm::ivec2 shift(0);
    for (int dy = -12; dy <= 12; ++dy)
      for (int dx = -12; dx <= 12; ++dx) {
        double sum = 0.0;
        for (int y = 20; y < 101; y += 2)
          for (int x = 20; x < 101; x += 2)
            sum += std::abs(double{luminanceAt(windy, x + dx, y + dy) - luminanceAt(rest, x, y)});
        if (sum < best) {
          best = sum;
          shift = {dx, dy};
        }
      }
    // The picture's right is +x, its lower side +z.
    const glm::vec3 toward = -directionOf(from, 0.0f);
    const glm::vec2 went = shift;
    EXPECT_GT(glm::length(went), 2.0f);
    EXPECT_GT(glm::dot(went, glm::vec2(toward.x, toward.z)), 0.8f * glm::length(went));
  }
}

TEST_F(GrassRender, IsSilentUnderValidation) {
  const Terrain hills = growTerrain({.samples = 65});
  const Plant post = standingTube(0.1f, 0.0f, 2.0f);
  GrassLayer layer, other;
  layer.set = &lawn();
  other.set = &blocky();
  other.density = 0.3f;
  for (const bool terrain : {true, false})
    for (const bool ends : {true, false})
      for (std::size_t layers = terrain ? 0 : 1; layers <= 2; ++layers) {
        layer.ends_at_depth = other.ends_at_depth = ends;
        Scene scene;
        scene.terrain = terrain ? &hills : nullptr;
        if (layers > 0) scene.grass.push_back(layer);
        if (layers > 1) scene.grass.push_back(other);
        scene.items.push_back({&post, nullptr});
        renderer().setScene(scene);
        View view = dayView(hills, {1.0f, 4.0f}, 1.0f, {-0.2f, -0.2f, -1.0f}, 48, 36);
        renderer().render(view);
        view.width = 40;  // another size, the same scene
        if (layers == 2) view.terms = presetTerms("best");
        renderer().render(view);
      }
}

TEST_F(GrassRender, BadInputIsAnError) {
  GrassLayer layer;
  EXPECT_THROW(renderer().setScene(grassScene(layer)), Error);
  layer.set = &blocky();
  const auto bad = [&](const auto& change) {
    GrassLayer wrong = layer;
    change(wrong);
    EXPECT_THROW(renderer().setScene(grassScene(wrong)), Error);
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  bad([](GrassLayer& l) { l.density = 1.1f; });
  bad([](GrassLayer& l) { l.density = -0.1f; });
  bad([&](GrassLayer& l) { l.density = nan; });
  bad([&](GrassLayer& l) { l.turn = nan; });
  bad([](GrassLayer& l) { l.most_slices = 0; });
  bad([](GrassLayer& l) { l.most_slices = 257; });
  bad([](GrassLayer& l) { l.scatter = 0.95f; });
  bad([](GrassLayer& l) { l.scatter = -0.1f; });
  bad([](GrassLayer& l) { l.variation = 1.5f; });
  const CoverMap cover{1, 1, glm::vec2(0.0f), glm::vec2(1.0f), {2.0f}};
  bad([&](GrassLayer& l) { l.cover = &cover; });
  GrassSet broken = blocky();
  broken.spacing_m.x = 0.0f;
  bad([&](GrassLayer& l) { l.set = &broken; });
  Scene floating = grassScene(layer);
  floating.ground = false;
  EXPECT_THROW(renderer().setScene(floating), Error);
  Terrain flat = plane();
  flat.heights[1] = nan;
  EXPECT_THROW(renderer().setScene(grassScene(layer, &flat)), Error);
  renderer().setScene(grassScene(layer));
}

}  // namespace
}  // namespace verdure
