#include "render/packed_motion.h"

#include <algorithm>

namespace verdure {

std::vector<glm::uvec4> PackedMotions::add(const PlantMotion& motion, std::uint32_t first_instance,
                                           std::uint32_t instances, std::size_t words) {
  const MotionTables& tables = *motion.tables;
  PackedMotion item{motion.tables};
  item.first_beam = static_cast<std::uint32_t>(beams.size());
  item.first_leaf = static_cast<std::uint32_t>(leaves.size());
  item.first_instance = first_instance;
  item.instances = instances;
  const auto offset = [](std::uint32_t& index, std::uint32_t by) {
    if (index != shared::kHangsOnNothing) index += by;
  };
  for (shared::MotionBeam beam : tables.beams) {
    for (int i = 0; i < 4; ++i) offset(beam.carriers[i], item.first_beam);
    beams.push_back(beam);
  }
  drives.insert(drives.end(), tables.drives.begin(), tables.drives.end());
  for (shared::MotionLeaf leaf : tables.leaves) {
    offset(leaf.beam, item.first_beam);
    leaves.push_back(leaf);
  }
  const auto beam_count = static_cast<std::uint32_t>(tables.beams.size());
  const auto leaf_count = static_cast<std::uint32_t>(tables.leaves.size());
  const std::size_t each = std::max<std::size_t>(2 * std::size_t{beam_count} + leaf_count, 1);
  item.places = static_cast<std::uint32_t>(
      std::clamp<std::size_t>(words / each, 1, std::min(std::max(instances, 1u), 65535u)));
  item.amplitude_base = amplitudes;
  item.turn_base = turns;
  amplitudes += item.places * beam_count;
  turns += item.places * leaf_count;
  std::vector<glm::uvec4> seats;
  for (std::uint32_t k = 0; k < instances; ++k) {
    const std::uint32_t place = k % item.places;
    const glm::uvec2 phase = motionPhase(place);
    // Indices count from the scene's first beam; unsigned numbers wrap.
    seats.emplace_back(item.amplitude_base + place * beam_count - item.first_beam,
                       item.turn_base + place * leaf_count - item.first_leaf, phase.x, phase.y);
  }
  items.push_back(std::move(item));
  return seats;
}

void PackedMotions::addVertices(const std::vector<glm::uvec2>& mesh) {
  const PackedMotion& item = items.back();
  for (glm::uvec2 hang : mesh) {
    if (hang.x != shared::kHangsOnNothing)
      hang.x += (hang.x & shared::kHangsOnLeaf) != 0 ? item.first_leaf : item.first_beam;
    hangs.push_back(hang);
  }
}

void PackedMotions::addStill(std::size_t count) {
  hangs.resize(hangs.size() + count, glm::uvec2(shared::kHangsOnNothing));
}

}  // namespace verdure
