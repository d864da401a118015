#include "sky/fit_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sky/fit_kernel.cpp"
#include <hwy/foreach_target.h>
// Highway's own header must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace verdure {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, kFitLanes>;
using V = hn::Vec<Tag>;
constexpr std::size_t kLanes = hn::MaxLanes(Tag());

/// kVectors vectors of outputs: their sums stay in registers. Each row has sums of its own, so that
/// the processor need not wait for those of the row before.
template <std::size_t kVectors>
void sumBlock(const float* x, std::size_t rows, const float* y, std::size_t columns,
              const float* coefficients, std::size_t stride, float* out) {
  const Tag d;
  V s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0;
  for (std::size_t i = rows; i-- > 0;) {
    V r0 = hn::Zero(d), r1 = r0, r2 = r0, r3 = r0;
    const float* p = coefficients + (i + 1) * columns * stride;
    for (std::size_t j = columns; j-- > 0;) {
      p -= stride;
      const V w = hn::Set(d, y[j]);
      r0 = hn::MulAdd(w, hn::LoadU(d, p), r0);
      if (kVectors == 4) {
        r1 = hn::MulAdd(w, hn::LoadU(d, p + kLanes), r1);
        r2 = hn::MulAdd(w, hn::LoadU(d, p + 2 * kLanes), r2);
        r3 = hn::MulAdd(w, hn::LoadU(d, p + 3 * kLanes), r3);
      }
    }
    const V x_i = hn::Set(d, x[i]);
    s0 = hn::MulAdd(x_i, r0, s0);
    if (kVectors == 4) {
      s1 = hn::MulAdd(x_i, r1, s1);
      s2 = hn::MulAdd(x_i, r2, s2);
      s3 = hn::MulAdd(x_i, r3, s3);
    }
  }
  hn::StoreU(s0, d, out);
  if (kVectors == 4) {
    hn::StoreU(s1, d, out + kLanes);
    hn::StoreU(s2, d, out + 2 * kLanes);
    hn::StoreU(s3, d, out + 3 * kLanes);
  }
}

void SumPolynomials(const float* x, std::size_t rows, const float* y, std::size_t columns,
                    const float* coefficients, std::size_t stride, float* out) {
  std::size_t k = 0;
  for (; k + 4 * kLanes <= stride; k += 4 * kLanes)
    sumBlock<4>(x, rows, y, columns, coefficients + k, stride, out + k);
  for (; k < stride; k += kLanes)
    sumBlock<1>(x, rows, y, columns, coefficients + k, stride, out + k);
}

}  // namespace HWY_NAMESPACE
}  // namespace verdure
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace verdure {

HWY_EXPORT(SumPolynomials);

void sumPolynomials(const float* x, std::size_t rows, const float* y, std::size_t columns,
                    const float* coefficients, std::size_t stride, float* out) {
  HWY_DYNAMIC_DISPATCH(SumPolynomials)(x, rows, y, columns, coefficients, stride, out);
}

}  // namespace verdure
#endif  // HWY_ONCE
