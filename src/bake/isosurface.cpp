#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "bake/block_lattice.h"
#include "bake/marching_cubes.h"
#include "base/check.h"
#include "base/parallel.h"
#include "verdure/error.h"

namespace verdure {
namespace {

constexpr glm::ivec3 kBlock = BlockLattice::kBlock;
constexpr glm::ivec3 kPadded = kBlock + 1;
constexpr int kPaddedPoints = kPadded.x * kPadded.y * kPadded.z;

// The coarse lattice pays when the radius still spans this many of its cells: with fewer, the
// curvature bound rules out too little (bench/field_bench.cpp).
constexpr float kFineCellsPerRadius = 5.0f;

int paddedIndex(int x, int y, int z) {
  return x + kPadded.x * (y + kPadded.y * z);
}

/// A block's values and those of the first points of the next blocks, i.e. the corners of its
/// cells; `absent[i]` for points of blocks that were not evaluated.
struct PaddedBlock {
  std::array<float, kPaddedPoints> value{};
  std::array<bool, kPaddedPoints> absent{};
  bool any_absent = false;

  PaddedBlock(const BlockLattice& lattice, const glm::ivec3& block) {
    for (int n = 0; n < 8; ++n) {
      const glm::ivec3 side(n & 1, n >> 1 & 1, n >> 2);
      const std::int32_t slot = lattice.slotOf(block + side);
      const bool missing = slot == BlockLattice::kAbsent;
      any_absent = any_absent || missing;
      const float* from = missing ? nullptr : lattice.values(static_cast<std::size_t>(slot));
      const glm::ivec3 count = kBlock * (1 - side) + side;
      for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
          for (int x = 0; x < count.x; ++x) {
            const auto to = static_cast<std::size_t>(
                paddedIndex(x + side.x * kBlockX, y + side.y * kBlockY, z + side.z * kBlockZ));
            absent[to] = missing;
            value[to] = missing ? 0.0f : from[x + kBlockX * (y + kBlockY * z)];
          }
    }
  }
};

// Offsets of a cell's corners in a padded block.
constexpr std::array<int, 8> kCorner = [] {
  std::array<int, 8> offsets{};
  for (int c = 0; c < 8; ++c)
    offsets[static_cast<std::size_t>(c)] =
        (c & 1) + kPadded.x * ((c >> 1 & 1) + kPadded.y * (c >> 2));
  return offsets;
}();

/// Marks the blocks of the fine lattice that the surface may touch: every other cell is proved to
/// lie inside or outside as a whole, because the field differs from the trilinear interpolation of
/// the coarse cell's corners by at most 3/8 h^2 sup |Hessian|.
void markNearSurface(const DensityField::State& field, const BlockLattice& coarse, int step,
                     float tau, BlockLattice& fine) {
  const float h = coarse.lattice().spacing;
  const glm::vec3 span = glm::vec3(kBlock) * h;
  const float reach = glm::length(field.grid.extent()) + field.grid.maxRadius();
  parallelChunks(coarse.slotCount(), 32, [&](std::size_t begin, std::size_t end) {
    GeneratorList generators;
    std::array<float, kBlockPoints> curvature{};
    for (std::size_t slot = begin; slot < end; ++slot) {
      const glm::ivec3 block = coarse.blockOf(slot);
      const PaddedBlock padded(coarse, block);
      const glm::vec3 low = coarse.blockLow(field.grid, block);
      field.grid.gather(low, low + span, generators);
      if (generators.count == 0) continue;
      // A first bound without the kernels, |Hessian|_2 <= 8 / r^2, settles most outer blocks.
      float highest = 0.0f;
      for (const float v : padded.value) highest = std::max(highest, v);
      const float rough = 3.0f * h * h * field.weight * static_cast<float>(generators.count) /
                          (field.grid.minRadius() * field.grid.minRadius());
      if (highest + rough <= 0.999f * tau) continue;
      curvatureOnBlock(generators, low, h, curvature.data());
      // Rounding: of sums of positive float terms, and of positions far from the origin, which move
      // a kernel by at most 1.54 of its height a radius.
      const float slack = 1e-5f + 6e-8f * (static_cast<float>(generators.count) +
                                           4.0f * reach / field.grid.minRadius());
      for (int z = 0; z < kBlockZ; ++z)
        for (int y = 0; y < kBlockY; ++y)
          for (int x = 0; x < kBlockX; ++x) {
            const int at = paddedIndex(x, y, z);
            float least = padded.value[static_cast<std::size_t>(at)], most = least;
            for (const int offset : kCorner) {
              const float v = padded.value[static_cast<std::size_t>(at + offset)];
              least = std::min(least, v);
              most = std::max(most, v);
            }
            const auto own = static_cast<std::size_t>(x + kBlockX * (y + kBlockY * z));
            const float bound =
                0.375f * h * h * field.weight * curvature[own] + slack * (most + tau);
            if (most + bound <= tau || least - bound > tau) continue;
            const glm::ivec3 from = step * (block * kBlock + glm::ivec3(x, y, z));
            fine.markPoints(from, from + step);
          }
    }
  });
}

constexpr std::array<std::uint8_t, 8> kBitCount = {0, 1, 1, 2, 1, 2, 2, 3};

/// Which lattice edges of a block's own points carry a vertex, and where its vertices begin.
struct BlockEdges {
  std::array<std::uint8_t, kBlockPoints> axes{};     // bit a: the edge towards +a crosses
  std::array<std::uint8_t, kBlockPoints> cell{};     // the case of the cell above the point
  std::array<std::uint16_t, kBlockPoints> offset{};  // vertices of earlier points of the block
};

class Extractor {
 public:
  Extractor(const DensityField::State& field, const BlockLattice& lattice, float tau)
      : field_(field), lattice_(lattice), tau_(tau) {}

  Surface run(SurfaceStatistics& statistics) {
    const std::size_t count = lattice_.slotCount();
    edges_.resize(count);
    first_vertex_.assign(count + 1, 0);
    first_triangle_.assign(count + 1, 0);
    parallelFor(count, 64, [&](std::size_t slot) { classify(slot); });
    for (std::size_t slot = 0; slot < count; ++slot) {
      first_vertex_[slot + 1] += first_vertex_[slot];
      first_triangle_[slot + 1] += first_triangle_[slot];
    }
    statistics.bytes +=
        count * (sizeof(BlockEdges) + sizeof(first_vertex_[0]) + sizeof(first_triangle_[0]));
    surface_.positions.resize(first_vertex_[count]);
    surface_.normals.resize(first_vertex_[count]);
    surface_.indices.resize(3 * first_triangle_[count]);
    std::vector<std::size_t> degenerate(count, 0);
    parallelChunks(count, 64, [&](std::size_t begin, std::size_t end) {
      Scratch scratch;
      for (std::size_t slot = begin; slot < end; ++slot) {
        if (first_vertex_[slot] == first_vertex_[slot + 1] &&
            first_triangle_[slot] == first_triangle_[slot + 1])
          continue;
        const PaddedBlock padded(lattice_, lattice_.blockOf(slot));
        degenerate[slot] = emitVertices(slot, padded, scratch);
        emitTriangles(slot);
      }
    });
    for (const std::size_t d : degenerate) statistics.degenerate_gradients += d;
    return std::move(surface_);
  }

 private:
  struct Scratch {
    GeneratorList generators;
    std::vector<float> lanes;     // seven arrays: x, y, z, sum, gradient
    std::vector<glm::vec3> away;  // along the lattice edge, from inside to outside
  };

  // A cell with an absent corner was proved to hold no surface.
  static bool complete(const PaddedBlock& padded, int at) {
    if (!padded.any_absent) return true;
    for (const int offset : kCorner)
      if (padded.absent[static_cast<std::size_t>(at + offset)]) return false;
    return true;
  }

  // Whether the cells of a block can hold surface at all, from the ranges of its eight blocks.
  bool mayCross(const glm::ivec3& block) const {
    float least = std::numeric_limits<float>::max(), most = 0.0f;
    for (int n = 0; n < 8; ++n) {
      const std::int32_t slot = lattice_.slotOf(block + glm::ivec3(n & 1, n >> 1 & 1, n >> 2));
      if (slot == BlockLattice::kAbsent) continue;
      const glm::vec2 range = lattice_.range(static_cast<std::size_t>(slot));
      least = std::min(least, range.x);
      most = std::max(most, range.y);
    }
    return least <= tau_ && most > tau_;
  }

  void classify(std::size_t slot) {
    if (!mayCross(lattice_.blockOf(slot))) return;
    const PaddedBlock padded(lattice_, lattice_.blockOf(slot));
    std::array<std::uint8_t, kPaddedPoints> inside{};
    for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = padded.value[i] > tau_ ? 1 : 0;
    BlockEdges& edges = edges_[slot];
    std::uint32_t vertices = 0, triangles = 0;
    std::size_t own = 0;
    for (int z = 0; z < kBlockZ; ++z)
      for (int y = 0; y < kBlockY; ++y)
        for (int x = 0; x < kBlockX; ++x, ++own) {
          const int at = paddedIndex(x, y, z);
          unsigned bits = 0;
          for (unsigned c = 0; c < 8; ++c)
            bits |= static_cast<unsigned>(inside[static_cast<std::size_t>(at + kCorner[c])]) << c;
          edges.offset[own] = static_cast<std::uint16_t>(vertices);
          if (bits == 0 || bits == 255) continue;
          // Edges towards +x, +y, +z cross where corners 1, 2, 4 differ from corner 0.
          unsigned axes = bits & 1 ? ~bits : bits;
          axes = (axes >> 1 & 1) | (axes >> 1 & 2) | (axes >> 2 & 4);
          if (padded.any_absent)
            for (unsigned a = 0; a < 3; ++a)
              if (padded.absent[static_cast<std::size_t>(at + kCorner[std::size_t{1} << a])])
                axes &= ~(1u << a);
          edges.axes[own] = static_cast<std::uint8_t>(axes);
          vertices += kBitCount[axes];
          if (complete(padded, at)) {
            edges.cell[own] = static_cast<std::uint8_t>(bits);
            triangles += cellCases()[bits].triangle_count;
          }
        }
    first_vertex_[slot + 1] = vertices;
    first_triangle_[slot + 1] = triangles;
  }

  std::size_t emitVertices(std::size_t slot, const PaddedBlock& padded, Scratch& scratch) {
    const std::size_t begin = first_vertex_[slot], count = first_vertex_[slot + 1] - begin;
    if (count == 0) return 0;
    const std::size_t lanes = (count + kPointLanes - 1) / kPointLanes * kPointLanes;
    scratch.lanes.resize(7 * lanes);
    scratch.away.resize(count);
    float* const px = scratch.lanes.data();
    const float h = lattice_.lattice().spacing;
    const glm::vec3 block_low = lattice_.blockLow(field_.grid, lattice_.blockOf(slot));
    glm::vec3 low(1e30f), high(-1e30f);
    std::size_t n = 0, own = 0;
    for (int z = 0; z < kBlockZ; ++z)
      for (int y = 0; y < kBlockY; ++y)
        for (int x = 0; x < kBlockX; ++x, ++own) {
          if (edges_[slot].axes[own] == 0) continue;
          for (int a = 0; a < 3; ++a) {
            if ((edges_[slot].axes[own] >> a & 1) == 0) continue;
            const int at = paddedIndex(x, y, z);
            const float v0 = padded.value[static_cast<std::size_t>(at)];
            const float v1 =
                padded.value[static_cast<std::size_t>(at + kCorner[std::size_t{1} << a])];
            glm::vec3 along(0.0f);
            along[a] = 1.0f;
            const glm::vec3 p =
                block_low + h * (glm::vec3(x, y, z) + (tau_ - v0) / (v1 - v0) * along);
            low = glm::min(low, p);
            high = glm::max(high, p);
            px[n] = p.x;
            px[lanes + n] = p.y;
            px[2 * lanes + n] = p.z;
            scratch.away[n] = v0 > v1 ? along : -along;
            ++n;
          }
        }
    VERDURE_CHECK_EQ(n, count);
    for (; n < lanes; ++n)
      for (std::size_t a = 0; a < 3; ++a) px[a * lanes + n] = px[a * lanes + count - 1];
    field_.grid.gather(low, high, scratch.generators);
    float* const out = px + 3 * lanes;
    gradientAtPoints(field_.norm, scratch.generators, {px, px + lanes, px + 2 * lanes, lanes}, out,
                     out + lanes, out + 2 * lanes, out + 3 * lanes);
    std::size_t degenerate = 0;
    for (std::size_t i = 0; i < count; ++i) {
      surface_.positions[begin + i] =
          glm::vec3(px[i], px[lanes + i], px[2 * lanes + i]) + field_.grid.origin();
      const glm::vec3 gradient(out[lanes + i], out[2 * lanes + i], out[3 * lanes + i]);
      const float steepness = glm::length(gradient) * h;
      if (steepness > 1e-6f) {
        surface_.normals[begin + i] = -glm::normalize(gradient);
      } else {
        surface_.normals[begin + i] = scratch.away[i];
        ++degenerate;
      }
    }
    return degenerate;
  }

  void emitTriangles(std::size_t slot) {
    std::size_t at_index = 3 * std::size_t{first_triangle_[slot]};
    std::array<std::int32_t, 8> slots{};
    for (int n = 0; n < 8; ++n)
      slots[static_cast<std::size_t>(n)] =
          lattice_.slotOf(lattice_.blockOf(slot) + glm::ivec3(n & 1, n >> 1 & 1, n >> 2));
    std::size_t own = 0;
    for (int z = 0; z < kBlockZ; ++z)
      for (int y = 0; y < kBlockY; ++y)
        for (int x = 0; x < kBlockX; ++x, ++own) {
          const CellCase& cell = cellCases()[edges_[slot].cell[own]];
          for (std::size_t i = 0; i < 3u * cell.triangle_count; ++i)
            surface_.indices[at_index++] = vertexOf(slots, {x, y, z}, cell.edges[i]);
        }
    VERDURE_CHECK_EQ(at_index, 3 * std::size_t{first_triangle_[slot + 1]});
  }

  /// `slots`: of the block and its next neighbours, by bits x, y, z.
  std::uint32_t vertexOf(const std::array<std::int32_t, 8>& slots, const glm::ivec3& cell,
                         int edge) const {
    const int corner = edgeCorner(edge);
    const glm::ivec3 point = cell + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::ivec3 side = point / kBlock;
    const auto slot =
        static_cast<std::size_t>(slots[static_cast<std::size_t>(side.x + 2 * side.y + 4 * side.z)]);
    const glm::ivec3 in = point - side * kBlock;
    const auto own = static_cast<std::size_t>(in.x + kBlockX * (in.y + kBlockY * in.z));
    const unsigned earlier = edges_[slot].axes[own] & ((1u << (edge / 4)) - 1u);
    return first_vertex_[slot] + edges_[slot].offset[own] + kBitCount[earlier];
  }

  const DensityField::State& field_;
  const BlockLattice& lattice_;
  float tau_;
  std::vector<BlockEdges> edges_;
  std::vector<std::uint32_t> first_vertex_, first_triangle_;
  Surface surface_;
};

void checkMemory(std::size_t bytes, std::size_t max_bytes) {
  if (bytes <= max_bytes) return;
  throw Error("density field",
              "the grid would need " + std::to_string(bytes >> 20) + " MiB, " +
                  std::to_string(max_bytes >> 20) + " MiB are allowed",
              "use a coarser --grid or raise --max-memory");
}

std::size_t indexBytes(const Lattice& lattice) {
  const glm::dvec3 blocks = glm::ceil(glm::dvec3(lattice.points) / glm::dvec3(kBlock));
  const double bytes = 5.0 * blocks.x * blocks.y * blocks.z;
  return bytes < 1e18 ? static_cast<std::size_t>(bytes) : std::size_t{1} << 62;
}

}  // namespace

Surface DensityField::surface(const Lattice& lattice, float tau, std::size_t max_bytes,
                              SurfaceStatistics* statistics) const {
  SurfaceStatistics local;
  SurfaceStatistics& stats = statistics != nullptr ? *statistics : local;
  stats = {};
  stats.grid_points = lattice.points;
  checkMemory(indexBytes(lattice), max_bytes);
  BlockLattice fine(lattice);

  int step = 1;
  if (state_->norm.kind == Norm::Kind::kL2)
    while (step < 16 &&
           maxRadius() >= kFineCellsPerRadius * lattice.spacing * 2.0f * static_cast<float>(step))
      step *= 2;
  stats.coarse_step = step;
  if (step == 1) {
    fine.markReach(state_->grid);
  } else {
    BlockLattice coarse({lattice.origin, lattice.spacing * static_cast<float>(step),
                         (lattice.points + step - 2) / step + 1});
    coarse.markReach(state_->grid);
    checkMemory(coarse.bytes() + indexBytes(lattice), max_bytes);
    coarse.evaluate(*state_);
    stats.coarse_points_evaluated = coarse.slotCount() * kBlockPoints;
    markNearSurface(*state_, coarse, step, tau, fine);
    fine.assignSlots();
    stats.bytes = coarse.bytes();
  }
  checkMemory(stats.bytes + fine.bytes(), max_bytes);
  fine.evaluate(*state_);
  stats.grid_points_evaluated = fine.slotCount() * kBlockPoints;
  stats.bytes += fine.bytes();
  return Extractor(*state_, fine, tau).run(stats);
}

}  // namespace verdure
