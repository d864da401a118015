#include <algorithm>
#include <cmath>

#include "motion/motion_tables.h"

namespace verdure {
namespace {

/// How far what a beam carries at a place can move with the axis, m, and turn, radians.
struct Most {
  float way, turn;
};

/// `bent`: amplitude of (4.8), in lengths. Deflection and slope grow along a beam but for a slope
/// that may fall again by its tip, so the steepest place up to there counts.
Most mostAt(const shared::MotionBeam& beam, float place, float bent) {
  const glm::vec2 fit(beam.c2, beam.c4);
  float slope = 0.0f;
  for (int i = 1; i <= 8; ++i)
    slope = std::max(slope, std::abs(shared::beamSlope(fit, place * float(i) / 8.0f)));
  const float aside = bent * shared::beamDeflection(fit, place);
  const float shorter = place - shared::beamFoot(fit, place, bent);
  return {1.02f * beam.length * std::hypot(aside, shorter), 1.01f * std::atan(bent * slope)};
}

void include(const Bounds& box, float margin, Bounds& all, bool& any) {
  const glm::vec3 low = box.min - margin, high = box.max + margin;
  all.min = any ? glm::min(all.min, low) : low;
  all.max = any ? glm::max(all.max, high) : high;
  any = true;
}

}  // namespace

Bounds movedBounds(const PlantMotion& motion, const Wind& wind) {
  checkWind(wind);
  const MotionTables& tables = *motion.tables;
  const float speed = wind.speed * (1.0f + wind.gusts), push = speed * speed;
  std::vector<float> bent;  // in lengths, of each beam at most
  for (std::size_t b = 0; b < tables.beams.size(); ++b) {
    const shared::MotionBeam& beam = tables.beams[b];
    const shared::MotionDrive& drive = tables.drives[b];
    const auto level = static_cast<std::size_t>(motion.tree.branches[b].level);
    const float tip = push * (drive.swing * tables.farthest[level] + drive.mean);
    bent.push_back(tip / std::sqrt(1.0f + tip * tip / (shared::kMostTip * shared::kMostTip)) /
                   (beam.c2 + beam.c4));
  }
  Bounds all;
  bool any = false;
  for (std::size_t b = 0; b < tables.loads.size(); ++b) {
    const MotionTables::Load& load = tables.loads[b];
    if (!load.any) continue;
    float margin = push > 0.0f ? 2.0f * load.leaf_reach : 0.0f;
    const shared::MotionBeam& beam = tables.beams[b];
    for (int step = 0; step < kMotionLevels; ++step) {
      const std::uint32_t carrier =
          step == 0 ? static_cast<std::uint32_t>(b) : beam.carriers[step - 1];
      if (carrier == shared::kHangsOnNothing) break;
      const float place = step == 0 ? 1.0f : beam.places[step - 1];
      const Most most = mostAt(tables.beams[carrier], place, bent[carrier]);
      // A turn moves along a chord.
      margin += most.way + 2.0f * std::sin(0.5f * most.turn) *
                               (load.reach[static_cast<std::size_t>(step)] + margin);
    }
    include(load.box, margin, all, any);
  }
  if (tables.any_still) include(tables.still, 0.0f, all, any);
  return all;
}

}  // namespace verdure
