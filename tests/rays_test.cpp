// Rays against a scene: compared with loops over all triangles and with closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>

#include "base/parallel.h"
#include "ray_plants.h"
#include "rays/cut_table.h"
#include "rays/ray_scene.h"
#include "scene/scene.h"
#include "shared/sky.h"
#include "test_plants.h"
#include "verdure/error.h"
#include "verdure/plant_io.h"

namespace verdure {
namespace {

using namespace test;

Ray randomRay(Random& random, const Bounds& box) {
  const auto pointIn = [&](float margin) {
    const glm::vec3 share(random.uniform(), random.uniform(), random.uniform());
    return box.min + ((1.0f + 2.0f * margin) * share - margin) * box.size();
  };
  Ray ray;
  ray.origin = pointIn(0.2f);
  ray.direction = glm::normalize(pointIn(0.0f) - ray.origin);
  return ray;
}

TEST(RayScene, HitsWhatALoopOverAllTrianglesHits) {
  const Plant plant = test::ballTree(600);
  const RayScene rays(plant);
  const Bounds box = bounds(plant);
  Random random(3);
  int hits = 0, doubtful = 0, leaf_hits = 0;
  for (int i = 0; i < 4000; ++i) {
    const Ray ray = randomRay(random, box);
    const BruteHit truth = bruteTrace(plant, ray);
    const std::optional<Hit> hit = rays.closestHit(ray);
    EXPECT_EQ(rays.occluded(ray), hit.has_value());
    if (truth.doubt < 2e-4) {
      ++doubtful;
      continue;
    }
    ASSERT_EQ(hit.has_value(), truth.distance < 1e300) << i;
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(hit->distance, truth.distance, 1e-5 * (1.0 + truth.distance));
    EXPECT_EQ(hit->mesh, truth.mesh);
    EXPECT_EQ(hit->triangle, truth.triangle);
    EXPECT_EQ(hit->foliage, plant.meshes[truth.mesh].kind == PartKind::kFoliage);
    leaf_hits += hit->foliage;
    const glm::vec3 on_ray = ray.origin + hit->distance * ray.direction;
    EXPECT_LT(glm::length(on_ray - hit->position), 1e-4f);
    EXPECT_NEAR(glm::length(hit->normal), 1.0f, 1e-5f);
    EXPECT_NEAR(glm::length(hit->vertex_normal), 1.0f, 1e-5f);
  }
  EXPECT_GT(hits, 600);
  EXPECT_GT(leaf_hits, 400);
  EXPECT_LT(doubtful, 200);
}

TEST(RayScene, VisibilityOfManyRaysIsThatOfEach) {
  const Plant plant = test::ballTree(400);
  Scene scene;
  scene.items.emplace_back().plant = &plant;
  const RayScene rays(scene);
  const Bounds box = bounds(plant);
  Random random(9);
  for (const std::size_t count : {1, 7, 8, 9, 64, 301}) {
    std::vector<Ray> queries;
    for (std::size_t i = 0; i < count; ++i) queries.push_back(randomRay(random, box));
    std::vector<std::uint8_t> free(count, 2);
    rays.visibility(queries, free);
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(free[i], rays.occluded(queries[i]) ? 0 : 1);
  }
}

/// A quad with corners at +-1 in x and y, facing +z, uv (0, 0) at (-1, 1).
Plant quadPlant(const Image& image, AlphaMode mode = AlphaMode::kOpaque) {
  Plant plant;
  plant.name = "quad";
  plant.textures = {{"image", image, true, true}};
  Material material;
  material.base_color_texture = 0;
  material.alpha_mode = mode;
  plant.materials = {material};
  Mesh mesh;
  mesh.kind = PartKind::kFoliage;
  test::addQuad(mesh, {0, -1, 0}, {2, 0, 0}, {0, 2, 0});
  plant.meshes = {mesh};
  return plant;
}

TEST(RayScene, ReflectanceIsTheTextureInLinearLight) {
  Image image(2, 1);
  const std::uint8_t texels[] = {255, 128, 0, 255, 0, 128, 255, 255};
  std::copy(std::begin(texels), std::end(texels), image.rgba.begin());
  Plant plant = quadPlant(image);
  plant.materials[0].base_color = {0.5f, 1.0f, 1.0f, 1.0f};
  const RayScene rays(plant);
  const float middle = shared::linearFromSrgb(128.0f / 255.0f);
  const auto at = [&](float x) {
    Ray ray;
    ray.origin = {x, 0.1f, 3.0f};
    ray.direction = {0, 0, -1};
    return rays.closestHit(ray)->reflectance;
  };
  for (const auto& [x, share] : std::vector<std::pair<float, float>>{{-0.9f, 0.0f},
                                                                     {-0.5f, 0.0f},
                                                                     {0.0f, 0.5f},
                                                                     {0.25f, 0.75f},
                                                                     {0.5f, 1.0f},
                                                                     {0.95f, 1.0f}}) {
    EXPECT_NEAR(at(x).r, 0.5f * (1.0f - share), 1e-5f);
    EXPECT_NEAR(at(x).g, middle, 1e-5f);
    EXPECT_NEAR(at(x).b, share, 1e-5f);
  }
}

TEST(RayScene, TransparentTexelsLendNoColour) {
  Image image(2, 1);
  const std::uint8_t texels[] = {255, 0, 255, 0, 0, 255, 0, 255};
  std::copy(std::begin(texels), std::end(texels), image.rgba.begin());
  const Plant plant = quadPlant(image, AlphaMode::kMask);
  const RayScene rays(plant);
  Ray ray;
  ray.origin = {0.01f, 0.0f, 3.0f};
  ray.direction = {0, 0, -1};
  const std::optional<Hit> hit = rays.closestHit(ray);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->reflectance, glm::vec3(0, 1, 0));
  ray.origin.x = -0.01f;  // alpha below a half
  EXPECT_FALSE(rays.closestHit(ray));
  EXPECT_FALSE(rays.occluded(ray));
}

TEST(CutTable, NeverCallsAMixedTriangleUniform) {
  Random random(21);
  for (const bool clamps : {false, true}) {
    Texture texture{"leaf", test::leafImage(32), clamps, clamps};
    const CutTable table(texture, 0.5f);
    int opaque = 0, transparent = 0, certain = 0, mixed = 0;
    for (int i = 0; i < 4000; ++i) {
      std::array<glm::vec2, 3> uvs;
      const glm::vec2 at(random.uniform(-1.2f, 2.2f), random.uniform(-1.2f, 2.2f));
      const float size = std::pow(10.0f, random.uniform(-2.5f, 0.0f));
      for (glm::vec2& uv : uvs) uv = at + glm::vec2(random.vary(size), random.vary(size));
      bool any_opaque = false, any_cut = false;
      for (int s = 0; s < 300; ++s) {
        float a = random.uniform(), b = random.uniform();
        if (a + b > 1.0f) a = 1.0f - a, b = 1.0f - b;
        if (s < 3) a = s == 1, b = s == 2;
        const glm::vec2 uv = uvs[0] * (1.0f - a - b) + uvs[1] * a + uvs[2] * b;
        const double over = alphaOf(texture, glm::dvec2(uv)) - 0.5;
        if (std::abs(over) < 1e-4) continue;
        (over > 0 ? any_opaque : any_cut) = true;
        EXPECT_EQ(table.transparentAt(uv), over < 0);
      }
      const Cut kind = table.classify(uvs);
      if (any_opaque && any_cut) {
        ++mixed;
        ASSERT_EQ(kind, Cut::kMixed) << i;
      } else {
        ++certain;
        if (!any_opaque && !any_cut) continue;
        ASSERT_NE(kind, any_opaque ? Cut::kTransparent : Cut::kOpaque) << i;
      }
      opaque += kind == Cut::kOpaque;
      transparent += kind == Cut::kTransparent;
    }
    EXPECT_GT(mixed, 300);
    // It would be useless if it were never certain.
    EXPECT_GT(opaque + transparent, certain * 6 / 10);
    EXPECT_GT(opaque, 100);
    EXPECT_GT(transparent, 200);
  }
}

TEST(RayScene, ACutQuadIsTheGeometryThatItLeaves) {
  // Alpha steps from 0 to 1 between the centres of two texels, so the cut lies half way: x = 0.
  Image image(64, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 64; ++x) image.at(x, y)[3] = x < 32 ? 0 : 255;
  const Plant plant = quadPlant(image, AlphaMode::kMask);
  const RayScene cut(plant);
  Plant half;
  half.materials.resize(1);
  half.meshes.resize(1);
  test::addQuad(half.meshes[0], {0.5f, -1, 0}, {1, 0, 0}, {0, 2, 0});
  const RayScene geometry(half);
  Random random(5);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Ray ray = randomRay(random, {{-1, -1, -1}, {1, 1, 1}});
    const auto a = cut.trace(ray), b = geometry.trace(ray);
    const float x = ray.origin.x - ray.origin.z / ray.direction.z * ray.direction.x;
    if (std::abs(x) < 0.002f) continue;
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    ++hits;
    EXPECT_FALSE(cut.cutAt(*a));
    RayHit other = *a;  // the quad's left half is cut: one corner of either triangle lies there
    other.barycentric = {0.0f, 0.0f};
    EXPECT_EQ(cut.cutAt(other),
              plant.meshes[0].positions[plant.meshes[0].indices[3 * a->triangle]].x < 0.0f);
    EXPECT_NEAR(a->distance, b->distance, 1e-4f * b->distance + 1e-6f);
  }
  EXPECT_GT(hits, 100);
}

glm::mat4 place(const glm::vec3& at, float angle, const glm::vec3& scale) {
  return glm::scale(glm::rotate(glm::translate(glm::mat4(1.0f), at), angle, glm::vec3(0, 1, 0)),
                    scale);
}

TEST(RayScene, InstancesEqualFlattenedGeometry) {
  const Plant plant = test::ballTree(150);
  Scene instanced;
  instanced.ground = false;
  instanced.items.emplace_back().plant = &plant;
  instanced.items[0].world_from_plant = {place({0, 0, 0}, 0.3f, glm::vec3(1.0f)),
                                         place({3, 0, 1}, 1.7f, glm::vec3(0.6f)),
                                         place({-2, 1, 2}, 4.0f, glm::vec3(-1.0f, 1.2f, 1.0f))};
  std::vector<Plant> copies(3, plant);
  Scene flattened;
  flattened.ground = false;
  for (std::size_t i = 0; i < 3; ++i) {
    flattened.items.emplace_back().plant = &copies[i];
    flattened.items[i].world_from_plant = {instanced.items[0].world_from_plant[i]};
  }
  const RayScene a(instanced), b(flattened);
  Random random(17);
  int hits = 0, different = 0;
  for (int i = 0; i < 20000; ++i) {
    const Ray ray = randomRay(random, {{-3, 0, -2}, {4, 5, 4}});
    const std::optional<Hit> p = a.closestHit(ray), q = b.closestHit(ray);
    if (p.has_value() != q.has_value() || (p && p->triangle != q->triangle)) {
      ++different;  // edges
      continue;
    }
    if (!p) continue;
    ++hits;
    EXPECT_EQ(p->instance, q->item);
    EXPECT_EQ(p->mesh, q->mesh);
    EXPECT_NEAR(p->distance, q->distance, 1e-4f);
    EXPECT_LT(glm::length(p->normal - q->normal), 1e-3f);
    for (const Hit& hit : {*p, *q}) {
      const float cosine = glm::dot(hit.normal, glm::normalize(ray.direction));
      EXPECT_TRUE(hit.front == (cosine < 0.0f) || std::abs(cosine) < 1e-4f);
    }
    EXPECT_LT(glm::length(p->vertex_normal - q->vertex_normal), 1e-3f);
    EXPECT_LT(glm::length(p->reflectance - q->reflectance), 2e-2f);
  }
  EXPECT_GT(hits, 3000);
  EXPECT_LT(different, 20);
  EXPECT_LT(a.memoryBytes(), b.memoryBytes());
}

TEST(RayScene, TheNormalIsTheOutsideOfMirroredWood) {
  Plant plant;
  plant.materials.resize(1);
  plant.meshes.resize(1);
  test::addTube(plant.meshes[0], {0, 0, 0}, {0, 2, 0}, 0.5f, 0.5f, 64);
  for (const float x_scale : {1.0f, -1.0f}) {
    Scene scene;
    scene.items.emplace_back().plant = &plant;
    scene.items[0].world_from_plant = {place({1, 0, 0}, 0.0f, {x_scale, 1, 2})};
    scene.ground = false;
    const RayScene rays(scene);
    Random random(2);
    for (int i = 0; i < 200; ++i) {
      Ray ray;
      ray.origin = {random.uniform(-3.0f, -2.0f), 1.0f, random.vary(0.5f)};
      ray.direction = {1, 0, 0};
      const std::optional<Hit> hit = rays.closestHit(ray);
      ASSERT_TRUE(hit);
      EXPECT_LT(hit->normal.x, 0.0f);
      EXPECT_TRUE(hit->front);
      EXPECT_LT(hit->vertex_normal.x, 0.0f);
      EXPECT_LT(hit->distance, 4.0f);
    }
  }
}

TEST(RayScene, TheGroundIsSeenFromAboveOnly) {
  const Plant plant = test::ballTree(1);
  Scene scene;
  scene.items.emplace_back().plant = &plant;
  scene.ground = true;
  scene.ground_height = -0.5f;
  const RayScene rays(scene);
  Ray down;
  down.origin = {20, 1, 0};
  down.direction = {0, -0.5f, 0};
  const std::optional<Hit> hit = rays.closestHit(down);
  ASSERT_TRUE(hit);
  EXPECT_TRUE(hit->ground());
  EXPECT_FLOAT_EQ(hit->distance, 3.0f);
  EXPECT_EQ(hit->position, glm::vec3(20, -0.5f, 0));
  EXPECT_EQ(hit->normal, glm::vec3(0, 1, 0));
  EXPECT_EQ(hit->reflectance, shared::groundMeanColor());
  EXPECT_TRUE(rays.occluded(down));
  Ray up = down;
  up.origin.y = -2.0f;
  up.direction.y = 1.0f;
  EXPECT_FALSE(rays.closestHit(up));
  EXPECT_FALSE(rays.occluded(up));
  down.t_max = 2.0f;
  EXPECT_FALSE(rays.occluded(down));
  down.origin = {0.1f, 10, 0};  // the trunk's top is open: past its inside to the ground
  down.t_max = 1e9f;
  scene.ground = false;
  EXPECT_FALSE(RayScene(scene).occluded(up));
}

TEST(RayScene, NoRayLeaksOutOfAClosedBallNorHitsWhereItStarts) {
  for (const float away : {0.0f, 5000.0f}) {
    const glm::vec3 center(away, 0.3f * away, -away);
    Plant plant;
    plant.materials.resize(1);
    plant.meshes = {ball(center, 2.0f, 24)};
    Scene scene;
    scene.items.emplace_back().plant = &plant;
    scene.ground = false;
    for (const bool instanced : {false, true}) {
      if (instanced) {
        glm::mat4 turned = place({0.7f, -40.0f, 3.0f}, 0.7f, glm::vec3(0.5f));
        scene.items[0].world_from_plant = {glm::mat4(1.0f), turned};
      }
      const RayScene rays(scene);
      Random random(8);
      Ray ray;
      ray.origin = center;
      ray.direction = {0.3f, 0.5f, 0.1f};
      int inside = 0;
      for (int i = 0; i < 20000; ++i) {
        const std::optional<Hit> hit = rays.closestHit(ray);
        ASSERT_TRUE(hit) << "leaks after " << i;
        ASSERT_LT(std::abs(glm::length(hit->position - center) - 2.0f), 0.05f + 1e-5f * away);
        // Bounce inwards, also at grazing angles.
        ray.origin = rays.originOff(hit->position, -hit->normal);
        do ray.direction = randomDirection(random);
        while (glm::dot(ray.direction, hit->normal) >= 0.0f);
        if (i % 3 == 0)
          ray.direction =
              glm::normalize(glm::cross(hit->normal, ray.direction) - 1e-3f * hit->normal);
        inside += hit->distance > 1e-4f + 1e-6f * away;
      }
      EXPECT_GT(inside, 19900) << away;
    }
  }
}

TEST(RayScene, ThreadsChangeNothing) {
  Plant plant = test::ballTree(2000);
  plant.meshes.push_back(plant.meshes.back());  // every leaf twice: ties everywhere
  plant.meshes.back().material = 0;
  const Bounds box = bounds(plant);
  const auto traceAll = [&] {
    const RayScene rays(plant);
    std::vector<std::uint32_t> ids(60000);
    parallelFor(ids.size(), 256, [&](std::size_t i) {
      const RayThread mode;
      Random random(i);
      const auto hit = rays.trace(randomRay(random, box));
      ids[i] = hit ? hit->mesh * 1000003u + hit->triangle : 0xffffffffu;
    });
    return ids;
  };
  setThreadCount(1);
  const auto one = traceAll();
  setThreadCount(2);
  const auto two = traceAll();
  setThreadCount(0);
  EXPECT_TRUE(one == two);
}

std::string errorOf(const Scene& scene, const RaySceneOptions& options = {}) {
  try {
    RayScene rays(scene, options);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(RayScene, SaysWhatIsWrong) {
  Plant plant = test::ballTree(3000);
  Scene scene;
  scene.items.emplace_back();
  EXPECT_NE(errorOf(scene).find("no plant"), std::string::npos);
  scene.items[0].plant = &plant;
  RaySceneOptions options;
  options.max_memory_bytes = 100 << 10;
  EXPECT_NE(errorOf(scene, options).find("MiB allowed"), std::string::npos);
  plant.meshes[0].indices[4] = 1u << 30;
  EXPECT_NE(errorOf(scene).find("past its last vertex"), std::string::npos);
}

TEST(RayScene, ItsMemoryIsBelowTheEstimate) {
  for (const int leaves : {100, 20000}) {
    const Plant plant = test::ballTree(leaves);
    Scene scene;
    scene.items.emplace_back().plant = &plant;
    scene.items[0].world_from_plant.resize(static_cast<std::size_t>(leaves), glm::mat4(1.0f));
    const std::size_t held = RayScene(scene).memoryBytes();
    RaySceneOptions options;
    options.max_memory_bytes = held;
    EXPECT_NE(errorOf(scene, options), "");
  }
}

TEST(RayScene, AnEmptySceneIsOpen) {
  Scene scene;
  scene.ground = false;
  const RayScene rays(scene);
  EXPECT_FALSE(rays.occluded({}));
  EXPECT_FALSE(rays.trace({}));
}

TEST(RayScene, ForeignPlantsAreHit) {
  const char* folder = std::getenv("VERDURE_PLANT_DIR");
  if (folder == nullptr) GTEST_SKIP() << "VERDURE_PLANT_DIR is not set";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension();
    if (extension != ".glb" && extension != ".gltf") continue;
    SCOPED_TRACE(entry.path());
    const Plant plant = loadPlant(entry.path());
    const RayScene rays(plant);
    const Bounds box = bounds(plant);
    Random random(4);
    int hits = 0;
    for (int i = 0; i < 4000; ++i) {
      const Ray ray = randomRay(random, box);
      const std::optional<Hit> hit = rays.closestHit(ray);
      ASSERT_EQ(hit.has_value(), rays.occluded(ray));
      if (!hit) continue;
      ++hits;
      ASSERT_TRUE(glm::all(glm::greaterThanEqual(hit->reflectance, glm::vec3(0.0f))));
      ASSERT_TRUE(glm::all(glm::lessThanEqual(hit->reflectance, glm::vec3(1.0f))));
      ASSERT_NEAR(glm::length(hit->normal), 1.0f, 1e-4f);
      ASSERT_LT(glm::length(hit->position - ray.origin - ray.direction * hit->distance),
                1e-4f * glm::length(box.size()));
    }
    EXPECT_GT(hits, 10);
  }
}

}  // namespace
}  // namespace verdure
