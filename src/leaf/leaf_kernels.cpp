#include "leaf/leaf_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "leaf/leaf_kernels.cpp"
#include <hwy/foreach_target.h>
// Highway's own header must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace verdure {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Never more than a quarter of the padding: the convolutions hold four vectors at a time.
using Tag = hn::CappedTag<float, kPlaneLanes / 4>;
using V = hn::Vec<Tag>;

void AddDirections(std::span<const LitDirection> directions, const LitTexels& texels,
                   std::size_t begin, std::size_t count, float* const sums[3]) {
  const Tag d;
  const V zero = hn::Zero(d);
  for (std::size_t t = begin; t < begin + count; t += hn::Lanes(d)) {
    const V x = hn::LoadU(d, texels.x + t), y = hn::LoadU(d, texels.y + t);
    const V z = hn::LoadU(d, texels.z + t);
    const V first = hn::LoadU(d, texels.first + t);
    const V rise = hn::Sub(hn::LoadU(d, texels.second + t), first);
    V sum0 = zero, sum1 = zero, sum2 = zero;
    for (const LitDirection& w : directions) {
      const V horizon = hn::MulAdd(rise, hn::Set(d, w.share), first);
      const V facing = hn::MulAdd(x, hn::Set(d, w.x),
                                  hn::MulAdd(y, hn::Set(d, w.y), hn::Mul(z, hn::Set(d, w.z))));
      const V light =
          hn::IfThenElseZero(hn::Le(horizon, hn::Set(d, w.slope)), hn::Max(facing, zero));
      sum0 = hn::MulAdd(light, hn::Set(d, w.weights[0]), sum0);
      sum1 = hn::MulAdd(light, hn::Set(d, w.weights[1]), sum1);
      sum2 = hn::MulAdd(light, hn::Set(d, w.weights[2]), sum2);
    }
    const V entering = hn::LoadU(d, texels.entering + t);
    hn::StoreU(hn::MulAdd(sum0, entering, hn::LoadU(d, sums[0] + t)), d, sums[0] + t);
    hn::StoreU(hn::MulAdd(sum1, entering, hn::LoadU(d, sums[1] + t)), d, sums[1] + t);
    hn::StoreU(hn::MulAdd(sum2, entering, hn::LoadU(d, sums[2] + t)), d, sums[2] + t);
  }
}

void ConvolveRow(const float* from, float* to, std::size_t count, std::span<const float> taps) {
  const Tag d;
  const std::size_t n = hn::Lanes(d);
  for (std::size_t x = 0; x < count; x += 4 * n) {
    const float* at = from + x;
    const V middle = hn::Set(d, taps[0]);
    V a = hn::Mul(hn::LoadU(d, at), middle), b = hn::Mul(hn::LoadU(d, at + n), middle);
    V c = hn::Mul(hn::LoadU(d, at + 2 * n), middle), e = hn::Mul(hn::LoadU(d, at + 3 * n), middle);
    for (std::size_t k = 1; k < taps.size(); ++k) {
      const V tap = hn::Set(d, taps[k]);
      const float *left = at - k, *right = at + k;
      a = hn::MulAdd(hn::Add(hn::LoadU(d, left), hn::LoadU(d, right)), tap, a);
      b = hn::MulAdd(hn::Add(hn::LoadU(d, left + n), hn::LoadU(d, right + n)), tap, b);
      c = hn::MulAdd(hn::Add(hn::LoadU(d, left + 2 * n), hn::LoadU(d, right + 2 * n)), tap, c);
      e = hn::MulAdd(hn::Add(hn::LoadU(d, left + 3 * n), hn::LoadU(d, right + 3 * n)), tap, e);
    }
    hn::StoreU(a, d, to + x);
    hn::StoreU(b, d, to + x + n);
    hn::StoreU(c, d, to + x + 2 * n);
    hn::StoreU(e, d, to + x + 3 * n);
  }
}

void AddColumns(const float* const* rows, float* to, std::size_t count,
                std::span<const float> taps) {
  const Tag d;
  const std::size_t n = hn::Lanes(d), reach = taps.size() - 1;
  for (std::size_t x = 0; x < count; x += 4 * n) {
    const float* at = rows[reach] + x;
    const V middle = hn::Set(d, taps[0]);
    V a = hn::MulAdd(hn::LoadU(d, at), middle, hn::LoadU(d, to + x));
    V b = hn::MulAdd(hn::LoadU(d, at + n), middle, hn::LoadU(d, to + x + n));
    V c = hn::MulAdd(hn::LoadU(d, at + 2 * n), middle, hn::LoadU(d, to + x + 2 * n));
    V e = hn::MulAdd(hn::LoadU(d, at + 3 * n), middle, hn::LoadU(d, to + x + 3 * n));
    for (std::size_t k = 1; k <= reach; ++k) {
      const V tap = hn::Set(d, taps[k]);
      const float *up = rows[reach - k] + x, *down = rows[reach + k] + x;
      a = hn::MulAdd(hn::Add(hn::LoadU(d, up), hn::LoadU(d, down)), tap, a);
      b = hn::MulAdd(hn::Add(hn::LoadU(d, up + n), hn::LoadU(d, down + n)), tap, b);
      c = hn::MulAdd(hn::Add(hn::LoadU(d, up + 2 * n), hn::LoadU(d, down + 2 * n)), tap, c);
      e = hn::MulAdd(hn::Add(hn::LoadU(d, up + 3 * n), hn::LoadU(d, down + 3 * n)), tap, e);
    }
    hn::StoreU(a, d, to + x);
    hn::StoreU(b, d, to + x + n);
    hn::StoreU(c, d, to + x + 2 * n);
    hn::StoreU(e, d, to + x + 3 * n);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace verdure
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace verdure {

HWY_EXPORT(AddDirections);
HWY_EXPORT(ConvolveRow);
HWY_EXPORT(AddColumns);

void addDirections(std::span<const LitDirection> directions, const LitTexels& texels,
                   std::size_t begin, std::size_t count, float* const sums[3]) {
  HWY_DYNAMIC_DISPATCH(AddDirections)(directions, texels, begin, count, sums);
}

void convolveRow(const float* from, float* to, std::size_t count, std::span<const float> taps) {
  HWY_DYNAMIC_DISPATCH(ConvolveRow)(from, to, count, taps);
}

void addColumns(const float* const* rows, float* to, std::size_t count,
                std::span<const float> taps) {
  HWY_DYNAMIC_DISPATCH(AddColumns)(rows, to, count, taps);
}

}  // namespace verdure
#endif  // HWY_ONCE
