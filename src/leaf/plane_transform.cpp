#include "leaf/plane_transform.h"

#include <kissfft/kiss_fft.h>

#include <algorithm>
#include <memory>

#include "base/parallel.h"

namespace verdure {
namespace {

using Complex = std::complex<float>;
static_assert(sizeof(kiss_fft_cpx) == sizeof(Complex));

using Plan = std::unique_ptr<kiss_fft_state, void (*)(void*)>;

Plan makePlan(int size, bool inverse) {
  return {kiss_fft_alloc(size, inverse ? 1 : 0, nullptr, nullptr), std::free};
}

void transform(const Plan& plan, const Complex* from, Complex* to) {
  kiss_fft(plan.get(), reinterpret_cast<const kiss_fft_cpx*>(from),
           reinterpret_cast<kiss_fft_cpx*>(to));
}

}  // namespace

void transformPlane(std::vector<Complex>& plane, int width, int height, bool inverse) {
  const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  const Plan along = makePlan(width, inverse), across = makePlan(height, inverse);
  parallelChunks(h, 16, [&](std::size_t begin, std::size_t end) {
    std::vector<Complex> row(w);
    for (std::size_t y = begin; y < end; ++y) {
      transform(along, plane.data() + y * w, row.data());
      std::copy(row.begin(), row.end(), plane.begin() + static_cast<std::ptrdiff_t>(y * w));
    }
  });
  // Eight columns at a time: a line of the cache holds eight values.
  parallelChunks(w, 8, [&](std::size_t begin, std::size_t end) {
    std::vector<Complex> columns((end - begin) * h), column(h);
    for (std::size_t y = 0; y < h; ++y)
      for (std::size_t x = begin; x < end; ++x) columns[(x - begin) * h + y] = plane[y * w + x];
    for (std::size_t x = begin; x < end; ++x) {
      transform(across, columns.data() + (x - begin) * h, column.data());
      std::copy(column.begin(), column.end(),
                columns.begin() + static_cast<std::ptrdiff_t>((x - begin) * h));
    }
    for (std::size_t y = 0; y < h; ++y)
      for (std::size_t x = begin; x < end; ++x) plane[y * w + x] = columns[(x - begin) * h + y];
  });
}

int fastSize(int size) {
  for (;; ++size) {
    int rest = size;
    for (const int factor : {2, 3, 5})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return size;
  }
}

}  // namespace verdure
