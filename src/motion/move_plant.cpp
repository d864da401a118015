#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/packing.hpp>

#include "base/check.h"
#include "base/parallel.h"
#include "motion/motion_tables.h"
#include "motion/motion_texture.h"
#include "verdure/error.h"

namespace verdure {
namespace {

/// Periods of the waves of gusts, s, with no common multiple below an hour.
constexpr std::array<double, 4> kGustPeriods{61.0, 31.3, 17.9, 9.7};
/// What the wind of leaves drifts aside, by its way: a plane that moves along an axis alone would
/// repeat.
constexpr glm::dvec3 kDrift{0.031, 0.117, 0.053};

double fractionOf(double x) {
  return x - std::floor(x);
}

/// Wind in the plant's coordinates, and its speed there.
struct LocalWind {
  glm::vec3 toward;
  float speed;
};
LocalWind localWind(const shared::MotionMoment& moment, const glm::mat4& world_from_plant) {
  const glm::vec3 toward = glm::transpose(glm::mat3(world_from_plant)) * glm::vec3(moment.toward);
  const float length = glm::length(toward);
  return {length > 0.0f ? toward / length : glm::vec3(0.0f),
          shared::gustySpeed(moment, glm::vec3(world_from_plant[3]))};
}

}  // namespace

void checkWind(const Wind& wind) {
  if (!(wind.speed >= 0.0f && wind.speed <= 60.0f))
    throw Error("wind", fmt::format("a speed of {} m/s", wind.speed), "choose 0 to 60");
  if (!std::isfinite(wind.from))
    throw Error("wind", fmt::format("a direction of {}", wind.from), "give a finite one");
  if (!(wind.gusts >= 0.0f && wind.gusts <= 1.0f))
    throw Error("wind", fmt::format("gusts of {}", wind.gusts), "choose 0 to 1");
}

shared::MotionMoment momentOf(const Wind& wind, double seconds, float extent) {
  checkWind(wind);
  const MotionTime time = motionTime(seconds);
  shared::MotionMoment moment{};
  const glm::dvec3 toward(-std::sin(double{wind.from}), 0.0, -std::cos(double{wind.from}));
  moment.toward = glm::vec4(toward, wind.speed);
  for (int i = 0; i < 4; ++i) {
    const double frequency = 1.0 / kGustPeriods[static_cast<std::size_t>(i)];
    moment.gust_phase[i] = static_cast<float>(fractionOf(seconds * frequency + 0.37 * i));
    moment.gust_wave[i] = static_cast<float>(frequency / std::max(double{wind.speed}, 1.0));
  }
  const glm::dvec3 way = wind.way.value_or(toward * (double{wind.speed} * seconds));
  const double along = wind.way ? glm::length(way) : double{wind.speed} * seconds;
  const glm::dvec3 at = (way + kDrift * along) / double{extent};
  const auto scrolled = [](double x) { return static_cast<float>(fractionOf(x)); };
  moment.scroll = {scrolled(at.x), scrolled(at.y), scrolled(at.y), scrolled(at.z)};
  moment.drift = {scrolled(at.x), scrolled(at.z), wind.gusts, time.fraction};
  const glm::dvec3 shares(1.0 - std::abs(toward.z), 1.0 - std::abs(toward.x), 1.0);
  moment.planes = glm::vec4(glm::normalize(shares), 1.0 / double{extent});
  return moment;
}

glm::vec2 readMotion(const std::uint32_t* texels, const glm::uvec2& size, const glm::vec2& uv) {
  const shared::MotionTexels at = shared::motionTexels(uv, size);
  const auto read = [&](std::uint32_t x, std::uint32_t y) {
    return glm::unpackHalf2x16(texels[std::size_t{y} * size.x + x]);
  };
  const glm::vec2 a = read(at.low.x, at.low.y), b = read(at.high.x, at.low.y),
                  c = read(at.low.x, at.high.y), d = read(at.high.x, at.high.y);
  return {shared::motionValue({a.x, b.x, c.x, d.x}, at.share),
          shared::motionValue({a.y, b.y, c.y, d.y}, at.share)};
}

std::vector<glm::vec2> branchAmplitudes(const PlantMotion& motion, const Wind& wind, double seconds,
                                        const MotionPlace& place) {
  const MotionTables& tables = *motion.tables;
  const shared::MotionMoment moment = momentOf(wind, seconds, tables.wind_extent);
  const MotionTime time = motionTime(seconds);
  const LocalWind local = localWind(moment, place.world_from_plant);
  const glm::uvec2 phase = shared::motionPhase(place.instance);
  std::vector<glm::vec2> amplitudes(tables.beams.size());
  parallelFor(amplitudes.size(), 1 << 12, [&](std::size_t b) {
    const shared::MotionDrive& drive = tables.drives[b];
    const glm::vec2 noise =
        readMotion(&tables.texels[drive.texels], {drive.size & 0xffffu, drive.size >> 16},
                   shared::branchUv(drive, phase, time.whole, time.fraction));
    amplitudes[b] =
        shared::branchAmplitudes(tables.beams[b], drive, local.toward, local.speed, noise);
  });
  return amplitudes;
}

std::vector<glm::vec2> leafTurns(const PlantMotion& motion, const Wind& wind, double seconds,
                                 const MotionPlace& place) {
  const MotionTables& tables = *motion.tables;
  const shared::MotionMoment moment = momentOf(wind, seconds, tables.wind_extent);
  const LocalWind local = localWind(moment, place.world_from_plant);
  std::vector<glm::vec2> turns(tables.leaves.size());
  parallelFor(turns.size(), 1 << 12, [&](std::size_t i) {
    const shared::MotionLeaf& leaf = tables.leaves[i];
    const glm::vec3 stalk(place.world_from_plant * glm::vec4(leaf.stalk, 1.0f));
    glm::vec2 noise(0.0f);
    for (int plane = 0; plane < 3; ++plane)
      noise += moment.planes[plane] * readMotion(tables.wind.texels.data(), tables.wind.size,
                                                 shared::windUv(moment, stalk, plane));
    turns[i] = shared::leafTurns(leaf, local.toward, local.speed, noise);
  });
  return turns;
}

void movePlant(const PlantMotion& motion, const Wind& wind, double seconds,
               const MotionPlace& place, Plant& plant, CrownLight* light) {
  const std::vector<glm::vec2> amplitudes = branchAmplitudes(motion, wind, seconds, place);
  const std::vector<glm::vec2> turns = leafTurns(motion, wind, seconds, place);
  VERDURE_CHECK_EQ(plant.meshes.size(), motion.tree.meshes.size());
  for (std::size_t m = 0; m < plant.meshes.size(); ++m) {
    Mesh& mesh = plant.meshes[m];
    const std::vector<VertexMotion>& hung = motion.tree.meshes[m];
    VERDURE_CHECK_EQ(mesh.positions.size(), hung.size());
    parallelFor(hung.size(), 1 << 11, [&](std::size_t v) {
      if (hung[v].leaf == kNone) return;
      const auto turned = [&](const glm::vec3& normal) {
        return shared::turnedLeaf(motion.tables->leaves[hung[v].leaf], turns[hung[v].leaf],
                                  {mesh.positions[v], normal});
      };
      if (light != nullptr) {
        glm::vec3& normal = light->meshes[m].normals[v];
        normal = turned(normal).normal;
      }
      const shared::MovedVertex moved = turned(mesh.normals[v]);
      mesh.positions[v] = moved.position;
      mesh.normals[v] = moved.normal;
    });
  }
  bendPlant(
      motion.tree, [&amplitudes](std::uint32_t b) { return amplitudes[b]; }, plant, light);
}

}  // namespace verdure
