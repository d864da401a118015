#include "render/packed_motion.h"

#include <algorithm>

namespace verdure {

namespace {

/// How alike two places are turned: 3 for the same, mirroring included.
float alike(const PackedMotions::Rows& a, const PackedMotions::Rows& b) {
  float sum = 0.0f;
  for (int c = 0; c < 3; ++c) {
    const glm::vec3 u(a[0][c], a[1][c], a[2][c]), v(b[0][c], b[1][c], b[2][c]);
    sum += glm::dot(u, v) / std::max(glm::length(u) * glm::length(v), 1e-30f);
  }
  return sum;
}

/// The one of the first `count` seats that is turned most like the k-th; of equals another for
/// each.
std::uint32_t donorOf(std::uint32_t k, std::uint32_t count,
                      std::span<const PackedMotions::Rows> seats) {
  if (k < count) return k;
  std::uint32_t best = k % count;
  float most = alike(seats[k], seats[best]);
  for (std::uint32_t i = 1; i < count; ++i) {
    const std::uint32_t other = (k + i) % count;
    const float value = alike(seats[k], seats[other]);
    if (value <= most + 1e-3f) continue;
    most = value;
    best = other;
  }
  return best;
}

}  // namespace

PackedMotion PackedMotions::append(const PlantMotion& motion) {
  const MotionTables& tables = *motion.tables;
  PackedMotion item{motion.tables};
  item.first_beam = static_cast<std::uint32_t>(beams.size());
  item.first_leaf = static_cast<std::uint32_t>(leaves.size());
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
  item.amplitude_base = amplitudes;
  item.turn_base = turns;
  return item;
}

const PackedMotion& PackedMotions::addForest(const PlantMotion& motion, std::uint32_t kind,
                                             std::uint32_t first_seat, std::uint32_t seats) {
  PackedMotion item = append(motion);
  item.first_instance = first_seat;
  item.places = seats;
  item.forest_kind = kind;
  amplitudes += seats * static_cast<std::uint32_t>(motion.tables->beams.size());
  turns += seats * static_cast<std::uint32_t>(motion.tables->leaves.size());
  items.push_back(std::move(item));
  return items.back();
}

std::size_t PackedMotions::motionWords(const PlantMotion& motion) {
  return std::max<std::size_t>(2 * motion.tables->beams.size() + motion.tables->leaves.size(), 1);
}

std::vector<glm::uvec4> PackedMotions::add(const PlantMotion& motion, std::uint32_t first_instance,
                                           std::span<const Rows> seats_of_item, std::size_t words) {
  const auto instances = static_cast<std::uint32_t>(seats_of_item.size());
  const MotionTables& tables = *motion.tables;
  PackedMotion item = append(motion);
  item.first_instance = first_instance;
  item.instances = instances;
  const auto beam_count = static_cast<std::uint32_t>(tables.beams.size());
  const auto leaf_count = static_cast<std::uint32_t>(tables.leaves.size());
  const std::size_t each = motionWords(motion);
  item.places = static_cast<std::uint32_t>(
      std::clamp<std::size_t>((words - std::min(words, 2 * std::size_t{amplitudes} + turns)) / each,
                              1, std::min(std::max(instances, 1u), 65535u)));
  if (instances == 0) item.places = 0;
  amplitudes += item.places * beam_count;
  turns += item.places * leaf_count;
  std::vector<glm::uvec4> seats;
  for (std::uint32_t k = 0; k < instances; ++k) {
    const std::uint32_t place = donorOf(k, item.places, seats_of_item);
    // Indices count from the scene's first beam; unsigned numbers wrap.
    seats.emplace_back(item.amplitude_base + place * beam_count - item.first_beam,
                       item.turn_base + place * leaf_count - item.first_leaf,
                       first_instance + place, 0u);
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

void PackedMotions::finish() {
  if (items.empty()) hangs = {};
}

void PackedMotions::addStill(std::size_t count) {
  hangs.resize(hangs.size() + count, glm::uvec2(shared::kHangsOnNothing));
}

}  // namespace verdure
