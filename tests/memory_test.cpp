// How much memory a bake takes, by counting what the process allocates.
#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "crowns.h"
#include "verdure/density.h"

namespace {

std::atomic<std::size_t> held = 0, peak = 0;

void* counted(void* p) {
  if (p == nullptr) throw std::bad_alloc();
  const std::size_t now = held += malloc_usable_size(p);
  std::size_t most = peak;
  while (now > most && !peak.compare_exchange_weak(most, now)) {
  }
  return p;
}

void release(void* p) {
  if (p == nullptr) return;
  held -= malloc_usable_size(p);
  std::free(p);
}

}  // namespace

void* operator new(std::size_t size) {
  return counted(std::malloc(size));
}
void* operator new[](std::size_t size) {
  return counted(std::malloc(size));
}
void* operator new(std::size_t size, std::align_val_t align) {
  const auto a = static_cast<std::size_t>(align);
  return counted(std::aligned_alloc(a, (size + a - 1) / a * a));
}
void operator delete(void* p) noexcept {
  release(p);
}
void operator delete[](void* p) noexcept {
  release(p);
}
void operator delete(void* p, std::size_t) noexcept {
  release(p);
}
void operator delete[](void* p, std::size_t) noexcept {
  release(p);
}
void operator delete(void* p, std::align_val_t) noexcept {
  release(p);
}
void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  release(p);
}

namespace verdure {
namespace {

TEST(Memory, BakePeaksBelowThreeTimesThePlantAndTheGrid) {
  const Plant plant = makeBallCrown(100000, 0.02f);
  DensityOptions options;
  options.rho = 0.1f;
  const std::size_t before = held;
  peak = before;
  const DensityReport report = bakeDensity(plant, options).report;
  const std::size_t taken = peak - before, size = memoryBytes(plant);
  EXPECT_GT(taken, size / 4);  // the counters count
  EXPECT_LT(size + taken, 3 * size + report.grid_bytes)
      << "plant " << size << ", bake " << taken << ", grid " << report.grid_bytes;
  RecordProperty("plant_bytes", std::to_string(size));
  RecordProperty("peak_bytes", std::to_string(taken));
  std::printf("plant %zu bytes, bake at most %zu more, of which the grid %zu\n", size, taken,
              report.grid_bytes);
}

}  // namespace
}  // namespace verdure
