#ifndef VERDURE_RENDER_PACKED_MOTION_H_
#define VERDURE_RENDER_PACKED_MOTION_H_

#include <memory>
#include <vector>

#include "motion/motion_tables.h"

namespace verdure {

/// An item of a scene that moves in wind: where its beams, leaves and places begin among the
/// scene's, and where the results of its motion do.
struct PackedMotion {
  std::shared_ptr<const MotionTables> tables;
  std::uint32_t first_beam = 0, first_leaf = 0, first_instance = 0;
  std::uint32_t instances = 0;
  /// Places whose motion is computed; where there are more, the k-th moves as the (k % places)-th.
  std::uint32_t places = 0;
  std::uint32_t amplitude_base = 0, turn_base = 0;
};

/// All that moves in a scene; empty where nothing does.
struct PackedMotions {
  std::vector<PackedMotion> items;
  std::vector<shared::MotionBeam> beams;
  std::vector<shared::MotionDrive> drives;
  std::vector<shared::MotionLeaf> leaves;
  std::vector<glm::uvec2> hangs;            ///< of each vertex of the scene
  std::uint32_t amplitudes = 0, turns = 0;  ///< how many results there are

  /// `words`: of 4 bytes that all results may take. Returns which results instance k of the item
  /// reads, see instance.glsl.
  std::vector<glm::uvec4> add(const PlantMotion& motion, std::uint32_t first_instance,
                              std::uint32_t instances, std::size_t words);
  /// The next vertices of the scene: a mesh of an item that moves, the last one added, or `count`
  /// that stand still.
  void addVertices(const std::vector<glm::uvec2>& mesh);
  void addStill(std::size_t count);
};

}  // namespace verdure

#endif  // VERDURE_RENDER_PACKED_MOTION_H_
