#ifndef VERDURE_BASE_PARALLEL_H_
#define VERDURE_BASE_PARALLEL_H_

#include <cstddef>
#include <functional>

namespace verdure {

/// Limits all parallel loops of the process to `count` threads (0 = all cores). Results never
/// depend on it: loops write to places that depend on the index alone, and sums are added up in a
/// fixed order (see parallelChunks).
void setThreadCount(int count);
int threadCount();

/// Calls body(begin, end) over consecutive ranges of at most `grain` indices that cover [0, count),
/// on all threads. The ranges do not depend on the number of threads: range i is
/// [i * grain, min((i + 1) * grain, count)).
void parallelChunks(std::size_t count, std::size_t grain,
                    const std::function<void(std::size_t begin, std::size_t end)>& body);

/// body(i) for each i in [0, count), `grain` at a time.
template <class Body>
void parallelFor(std::size_t count, std::size_t grain, const Body& body) {
  parallelChunks(count, grain, [&body](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

}  // namespace verdure

#endif  // VERDURE_BASE_PARALLEL_H_
