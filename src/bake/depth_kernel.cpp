#include "bake/depth_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/depth_kernel.cpp"
#include <hwy/foreach_target.h>
// Highway's own header must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace verdure {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, kDepthLanes>;
using V = hn::Vec<Tag>;

void SumDepthTerms(const DepthTerms& terms, const DepthPoints& points, const NearWeight& near,
                   float* out) {
  const Tag d;
  const V zero = hn::Zero(d), tiny = hn::Set(d, 1e-20f), four_pi = hn::Set(d, 12.5663706f);
  const V near_a = hn::Set(d, near.a), near_b = hn::Set(d, near.b);
  const std::size_t n = points.count;
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    const V px = hn::LoadU(d, points.x + i), py = hn::LoadU(d, points.y + i),
            pz = hn::LoadU(d, points.z + i);
    const V nx = hn::LoadU(d, points.nx + i), ny = hn::LoadU(d, points.ny + i),
            nz = hn::LoadU(d, points.nz + i);
    V depth = zero, tx = zero, ty = zero, tz = zero, front = zero;
    for (std::size_t k = 0; k < terms.count; ++k) {
      const V ox = hn::Sub(hn::Set(d, terms.x[k]), px), oy = hn::Sub(hn::Set(d, terms.y[k]), py),
              oz = hn::Sub(hn::Set(d, terms.z[k]), pz);
      const V r2 = hn::MulAdd(ox, ox, hn::MulAdd(oy, oy, hn::MulAdd(oz, oz, tiny)));
      const V r = hn::Sqrt(r2);
      // w and w / r by one division.
      const V blunt = hn::MulAdd(four_pi, r2, hn::Set(d, terms.softening[k]));
      const V over = hn::Mul(hn::Set(d, terms.half_area[k]), hn::Add(near_a, r2));
      const V w_by_r = hn::Div(over, hn::Mul(r, hn::Mul(blunt, hn::Add(near_b, r2))));
      depth = hn::MulAdd(w_by_r, r, depth);
      tx = hn::MulAdd(w_by_r, ox, tx);
      ty = hn::MulAdd(w_by_r, oy, ty);
      tz = hn::MulAdd(w_by_r, oz, tz);
      const V along = hn::MulAdd(nx, ox, hn::MulAdd(ny, oy, hn::Mul(nz, oz)));
      front = hn::MulAdd(w_by_r, hn::Max(along, zero), front);
    }
    hn::StoreU(depth, d, out + i);
    hn::StoreU(tx, d, out + n + i);
    hn::StoreU(ty, d, out + 2 * n + i);
    hn::StoreU(tz, d, out + 3 * n + i);
    hn::StoreU(hn::Mul(front, hn::Set(d, 4.0f)), d, out + 4 * n + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace verdure
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace verdure {

HWY_EXPORT(SumDepthTerms);

void sumDepthTerms(const DepthTerms& terms, const DepthPoints& points, const NearWeight& near,
                   float* out) {
  HWY_DYNAMIC_DISPATCH(SumDepthTerms)(terms, points, near, out);
}

}  // namespace verdure
#endif  // HWY_ONCE
