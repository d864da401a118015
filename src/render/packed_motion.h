#ifndef VERDURE_RENDER_PACKED_MOTION_H_
#define VERDURE_RENDER_PACKED_MOTION_H_

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "motion/motion_tables.h"

namespace verdure {

/// An item of a scene that moves in wind: where its beams, leaves and places begin among the
/// scene's, and where the results of its motion do.
struct PackedMotion {
  std::shared_ptr<const MotionTables> tables;
  std::uint32_t first_beam = 0, first_leaf = 0, first_instance = 0;
  std::uint32_t instances = 0;  ///< where it stands
  /// Places whose motion is computed: the first of them. Any others move as one of these does that
  /// stands turned alike, see PackedMotions::add().
  std::uint32_t places = 0;
  std::uint32_t amplitude_base = 0, turn_base = 0;
  /// A forest's kind, whose places the GPU chooses: its number.
  std::optional<std::uint32_t> forest_kind = {};
};

/// All that moves in a scene; finish() leaves nothing where nothing does.
struct PackedMotions {
  std::vector<PackedMotion> items;
  std::vector<shared::MotionBeam> beams;
  std::vector<shared::MotionDrive> drives;
  std::vector<shared::MotionLeaf> leaves;
  std::vector<glm::uvec2> hangs;            ///< of each vertex of the scene
  std::uint32_t amplitudes = 0, turns = 0;  ///< how many results there are

  /// Words of 4 bytes that the results of one place take.
  static std::size_t motionWords(const PlantMotion& motion);
  /// Rows of world_from_plant.
  using Rows = std::array<glm::vec4, 3>;
  /// An item that stands at `seats`, the scene's from `first_instance` on. `words`: of 4 bytes that
  /// the results of the whole scene may take. Returns which results each of its places reads, see
  /// instance.glsl.
  std::vector<glm::uvec4> add(const PlantMotion& motion, std::uint32_t first_instance,
                              std::span<const Rows> seats, std::size_t words);
  /// A forest's kind, of which at most `seats` trees move, from `first_seat` on of those that the
  /// GPU chooses.
  const PackedMotion& addForest(const PlantMotion& motion, std::uint32_t kind,
                                std::uint32_t first_seat, std::uint32_t seats);
  /// The next vertices of the scene: a mesh of an item that moves, the last one added, or `count`
  /// that stand still.
  void addVertices(const std::vector<glm::uvec2>& mesh);
  void addStill(std::size_t count);
  /// Behind the last item.
  void finish();

 private:
  PackedMotion append(const PlantMotion& motion);
};

}  // namespace verdure

#endif  // VERDURE_RENDER_PACKED_MOTION_H_
