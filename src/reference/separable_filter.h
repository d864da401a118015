#ifndef VERDURE_REFERENCE_SEPARABLE_FILTER_H_
#define VERDURE_REFERENCE_SEPARABLE_FILTER_H_

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/parallel.h"

namespace verdure {

/// One channel of an image; rows lie `stride` values apart, what is between is never read into a
/// pixel.
template <class T>
struct Channel {
  static constexpr int kLanes = 32;

  int width = 0, height = 0;
  std::size_t stride = 0;
  std::vector<T> values;

  Channel() = default;
  Channel(int w, int h)
      : width(w),
        height(h),
        stride((static_cast<std::size_t>(w) + kLanes - 1) / kLanes * kLanes),
        values(stride * static_cast<std::size_t>(h)) {}
  T* row(int y) { return values.data() + static_cast<std::size_t>(y) * stride; }
  const T* row(int y) const { return values.data() + static_cast<std::size_t>(y) * stride; }
};

/// Correlates with `across` (along rows), then with `down`; both of odd length, centred. Beyond the
/// border the border's pixel repeats. Sums run in the kernel's order, so that the result is that of
/// the plain loop.
template <class T>
Channel<T> filtered(const Channel<T>& in, const std::vector<T>& across,
                    const std::vector<T>& down) {
  constexpr int kLanes = Channel<T>::kLanes;
  // sum over k of kernel[k] * sources[k][x], for 32 x at a time: these stay in registers.
  const auto correlate = [&in](const std::vector<const T*>& sources, const std::vector<T>& kernel,
                               T* out) {
    for (int x = 0; x < in.width; x += kLanes) {
      T sums[kLanes] = {};
      for (std::size_t k = 0; k < kernel.size(); ++k) {
        const T weight = kernel[k];
        const T* source = sources[k] + x;
        for (int i = 0; i < kLanes; ++i) sums[i] += weight * source[i];
      }
      std::copy_n(sums, kLanes, out + x);
    }
  };
  Channel<T> middle(in.width, in.height), out(in.width, in.height);
  const auto rows = static_cast<std::size_t>(in.height);
  parallelChunks(rows, 16, [&](std::size_t begin, std::size_t end) {
    const auto reach = static_cast<int>(across.size() / 2);
    std::vector<T> padded(in.stride + across.size());
    std::vector<const T*> sources(across.size());
    for (std::size_t k = 0; k < across.size(); ++k) sources[k] = padded.data() + k;
    for (std::size_t y = begin; y < end; ++y) {
      const T* row = in.row(static_cast<int>(y));
      std::fill_n(padded.begin(), reach, row[0]);
      std::copy_n(row, in.width, padded.begin() + reach);
      std::fill(padded.begin() + reach + in.width, padded.end(), row[in.width - 1]);
      correlate(sources, across, middle.row(static_cast<int>(y)));
    }
  });
  parallelChunks(rows, 16, [&](std::size_t begin, std::size_t end) {
    const auto reach = static_cast<int>(down.size() / 2);
    std::vector<const T*> sources(down.size());
    for (std::size_t y = begin; y < end; ++y) {
      for (int k = -reach; k <= reach; ++k)
        sources[static_cast<std::size_t>(k + reach)] =
            middle.row(std::clamp(static_cast<int>(y) + k, 0, in.height - 1));
      correlate(sources, down, out.row(static_cast<int>(y)));
    }
  });
  return out;
}

}  // namespace verdure

#endif  // VERDURE_REFERENCE_SEPARABLE_FILTER_H_
