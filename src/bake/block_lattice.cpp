#include "bake/block_lattice.h"

#include <algorithm>
#include <atomic>

#include "base/parallel.h"

namespace verdure {

BlockLattice::BlockLattice(const Lattice& lattice)
    : lattice_(lattice), blocks_((lattice.points + kBlock - 1) / kBlock) {
  marked_.assign(static_cast<std::size_t>(blocks_.x) * static_cast<std::size_t>(blocks_.y) *
                     static_cast<std::size_t>(blocks_.z),
                 0);
}

void BlockLattice::markReach(const GeneratorGrid& grid) {
  const glm::vec3 shift = grid.origin() - lattice_.origin;
  grid.forEachOccupiedCell([&](const glm::vec3& low, const glm::vec3& high) {
    // A block's cells end at the next block's first point: that one is marked by its own box, and
    // one more step below makes up for rounding.
    const glm::vec3 from = (low + shift - grid.maxRadius()) / lattice_.spacing - 1.0f;
    const glm::vec3 to = (high + shift + grid.maxRadius()) / lattice_.spacing + 1.0f;
    markPoints(glm::ivec3(glm::floor(from)), glm::ivec3(glm::ceil(to)));
  });
  assignSlots();
}

void BlockLattice::markPoints(const glm::ivec3& low, const glm::ivec3& high) {
  const glm::ivec3 from = glm::max(low, 0) / kBlock;
  const glm::ivec3 to = glm::min(glm::max(high, 0) / kBlock, blocks_ - 1);
  for (int z = from.z; z <= to.z; ++z)
    for (int y = from.y; y <= to.y; ++y)
      for (int x = from.x; x <= to.x; ++x)
        std::atomic_ref<std::uint8_t>(marked_[linear({x, y, z})])
            .store(1, std::memory_order_relaxed);
}

std::size_t BlockLattice::assignSlots() {
  slot_.assign(marked_.size(), kAbsent);
  active_.clear();
  std::size_t i = 0;
  for (int z = 0; z < blocks_.z; ++z)
    for (int y = 0; y < blocks_.y; ++y)
      for (int x = 0; x < blocks_.x; ++x, ++i)
        if (marked_[i] != 0) {
          slot_[i] = static_cast<std::int32_t>(active_.size());
          active_.push_back({x, y, z});
        }
  return active_.size();
}

void BlockLattice::evaluate(const DensityField::State& field) {
  values_ = std::make_unique_for_overwrite<float[]>(active_.size() * kBlockPoints);
  ranges_.resize(active_.size());
  const glm::vec3 span = glm::vec3(kBlock - 1) * lattice_.spacing;
  parallelChunks(active_.size(), 64, [&](std::size_t begin, std::size_t end) {
    GeneratorList generators;
    for (std::size_t slot = begin; slot < end; ++slot) {
      const glm::vec3 low = blockLow(field.grid, active_[slot]);
      field.grid.gather(low, low + span, generators);
      ranges_[slot] = sumOnBlock(field.norm, field.weight, generators, low, lattice_.spacing,
                                 values_.get() + slot * kBlockPoints);
    }
  });
}

std::int32_t BlockLattice::slotOf(const glm::ivec3& block) const {
  if (block.x < 0 || block.y < 0 || block.z < 0 || block.x >= blocks_.x || block.y >= blocks_.y ||
      block.z >= blocks_.z)
    return kAbsent;
  return slot_[linear(block)];
}

glm::vec3 BlockLattice::blockLow(const GeneratorGrid& grid, const glm::ivec3& block) const {
  return lattice_.origin - grid.origin() + lattice_.spacing * glm::vec3(block * kBlock);
}

float BlockLattice::valueOrZero(const glm::ivec3& point) const {
  const std::int32_t slot = slotOf(point / kBlock);
  if (slot == kAbsent) return 0.0f;
  const glm::ivec3 in = point % kBlock;
  return values(static_cast<std::size_t>(slot))[in.x + kBlockX * (in.y + kBlockY * in.z)];
}

std::size_t BlockLattice::bytes() const {
  return marked_.size() + slot_.size() * sizeof(slot_[0]) + active_.size() * sizeof(active_[0]) +
         active_.size() * (kBlockPoints * sizeof(float) + sizeof(ranges_[0]));
}

}  // namespace verdure
