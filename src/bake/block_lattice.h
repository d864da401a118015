#ifndef VERDURE_BAKE_BLOCK_LATTICE_H_
#define VERDURE_BAKE_BLOCK_LATTICE_H_

#include <memory>
#include <vector>

#include "bake/field.h"
#include "bake/field_kernels.h"

namespace verdure {

/// Values on those blocks of a lattice that matter: marked first, then evaluated in parallel.
class BlockLattice {
 public:
  static constexpr std::int32_t kAbsent = -1;
  static constexpr glm::ivec3 kBlock{kBlockX, kBlockY, kBlockZ};

  explicit BlockLattice(const Lattice& lattice);

  const Lattice& lattice() const { return lattice_; }
  /// Blocks along each axis.
  const glm::ivec3& blocks() const { return blocks_; }

  /// Marks every block with a cell (its points and the next ones) in reach of a generator; on the
  /// others the field is zero.
  void markReach(const GeneratorGrid& grid);
  /// Marks the blocks of all points in [low, high], clipped to the lattice; may be called from
  /// several threads at once.
  void markPoints(const glm::ivec3& low, const glm::ivec3& high);
  /// Gives the marked blocks their slots, in order. Returns their number.
  std::size_t assignSlots();

  /// Evaluates the kernel sum on the marked blocks.
  void evaluate(const DensityField::State& field);

  std::size_t slotCount() const { return active_.size(); }
  /// Position of a slot's block, in blocks.
  const glm::ivec3& blockOf(std::size_t slot) const { return active_[slot]; }
  /// Slot of a block, kAbsent if it is not marked or outside.
  std::int32_t slotOf(const glm::ivec3& block) const;
  const float* values(std::size_t slot) const { return values_.get() + slot * kBlockPoints; }
  /// Least and largest value of a block.
  const glm::vec2& range(std::size_t slot) const { return ranges_[slot]; }
  /// Where a block's first point lies, relative to the generators' origin.
  glm::vec3 blockLow(const GeneratorGrid& grid, const glm::ivec3& block) const;
  float valueOrZero(const glm::ivec3& point) const;
  std::size_t bytes() const;

 private:
  std::size_t linear(const glm::ivec3& block) const {
    return static_cast<std::size_t>(block.x) +
           static_cast<std::size_t>(blocks_.x) *
               (static_cast<std::size_t>(block.y) +
                static_cast<std::size_t>(blocks_.y) * static_cast<std::size_t>(block.z));
  }

  Lattice lattice_;
  glm::ivec3 blocks_{0};
  std::vector<std::uint8_t> marked_;
  std::vector<std::int32_t> slot_;
  std::vector<glm::ivec3> active_;
  std::unique_ptr<float[]> values_;  // not cleared first: every value is written
  std::vector<glm::vec2> ranges_;
};

}  // namespace verdure

#endif  // VERDURE_BAKE_BLOCK_LATTICE_H_
