// What hills hide.
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "scene/terrain_horizon.h"
#include "shared/horizon.h"
#include "verdure/terrain.h"

namespace verdure {
namespace {

bool isHidden(const std::vector<float>& horizon, const glm::vec3& from_eye, float radius) {
  const shared::HorizonLookup lookup = shared::horizonLookup(from_eye, radius);
  if (lookup.count == 0 || lookup.count > 64) return false;
  for (std::uint32_t i = 0; i < lookup.count; ++i) {
    const std::uint32_t turn = (lookup.first + i) % shared::kHorizonTurns;
    if (horizon[turn * shared::kHorizonRings + lookup.ring] <= lookup.tangent) return false;
  }
  return true;
}

/// Whether the ground comes between two points, by small steps.
bool groundBetween(const Terrain& terrain, const glm::vec3& from, const glm::vec3& to) {
  const int steps = static_cast<int>(glm::length(to - from) / 0.25f);
  for (int i = 1; i < steps; ++i) {
    const glm::vec3 p = glm::mix(from, to, static_cast<float>(i) / static_cast<float>(steps));
    if (terrain.heightAt({p.x, p.z}) > p.y) return true;
  }
  return false;
}

TEST(Horizon, HidesOnlyWhatTheGroundDoes) {
  const Terrain terrain = growTerrain({.seed = 3, .size_m = glm::vec2(800.0f), .relief_m = 60.0f});
  Random random(1);
  int hidden = 0, behind = 0;
  for (int e = 0; e < 4; ++e) {
    glm::vec3 eye(random.uniform(-300.0f, 300.0f), 0.0f, random.uniform(-300.0f, 300.0f));
    eye.y = terrain.heightAt({eye.x, eye.z}) + random.uniform(1.7f, 6.0f);
    const std::vector<float> horizon = terrainHorizon(terrain, eye);
    for (int i = 0; i < 500; ++i) {
      glm::vec3 middle(random.uniform(-400.0f, 400.0f), 0.0f, random.uniform(-400.0f, 400.0f));
      const float radius = random.uniform(1.0f, 8.0f);
      middle.y = terrain.heightAt({middle.x, middle.z}) + radius;
      // Points all over the sphere.
      bool all_behind = true;
      for (int k = 0; k < 60 && all_behind; ++k) {
        const float y = 1.0f - (static_cast<float>(k) + 0.5f) / 30.0f;
        const float turn = 2.39996323f * static_cast<float>(k), r = std::sqrt(1.0f - y * y);
        all_behind = groundBetween(
            terrain, eye, middle + radius * glm::vec3(r * std::cos(turn), y, r * std::sin(turn)));
      }
      const bool said = isHidden(horizon, middle - eye, radius);
      EXPECT_TRUE(!said || all_behind) << middle.x << ", " << middle.z;
      hidden += said ? 1 : 0;
      behind += all_behind ? 1 : 0;
    }
  }
  // And most of that.
  EXPECT_GT(behind, 200);
  EXPECT_GT(hidden, behind / 2);
}

TEST(Horizon, NothingIsHiddenOnAPlain) {
  Terrain plain{2, 2, glm::vec2(-500.0f), glm::vec2(1000.0f), std::vector<float>(4, 0.0f)};
  const std::vector<float> horizon = terrainHorizon(plain, {0.0f, 2.0f, 0.0f});
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const float radius = random.uniform(0.5f, 5.0f);
    EXPECT_FALSE(isHidden(
        horizon, {random.uniform(-400.0f, 400.0f), radius - 2.0f, random.uniform(-400.0f, 400.0f)},
        radius));
  }
}

}  // namespace
}  // namespace verdure
